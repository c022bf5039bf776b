/// @file
/// All versions of all patterns in one list: what each costs by formula, how to run it, and whether it is
/// right. The program, its studies and its tests walk through this list.
#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "04_parallel_patterns/compact.cuh"
#include "04_parallel_patterns/costs.h"
#include "04_parallel_patterns/input.h"
#include "04_parallel_patterns/library.cuh"
#include "04_parallel_patterns/reduce.cuh"

namespace patterns {

/// A version with its input on the device.
struct Run {
    std::function<void()> restore;  ///< what `work` changes in place; not part of the work
    std::function<void()> work;
    std::function<std::string()>
        complaint;  ///< empty if the last result is the CPU reference's, else what is wrong
};

struct Version {
    std::string pattern, name;
    std::function<Cost(const Input&)> cost;    ///< empty for the library: what it does is its own affair
    std::function<Run(const Input&)> prepare;  ///< the input must outlive the run

    bool is_library() const { return !cost; }
};

inline std::string complaint_about(const std::vector<std::uint32_t>& got,
                                   const std::vector<std::uint32_t>& expected) {
    if (got.size() != expected.size())
        return std::to_string(got.size()) + " elements instead of " + std::to_string(expected.size());
    for (std::size_t i = 0; i < got.size(); ++i)
        if (got[i] != expected[i])
            return "element " + std::to_string(i) + " is " + std::to_string(got[i]) + " instead of " +
                   std::to_string(expected[i]);
    return "";
}

using Numbers = course::DeviceBuffer<std::uint32_t>;

inline std::vector<Version> reduce_versions() {
    const auto ours = [](const char* name, ReduceMethod method, std::function<Cost(const Input&)> cost) {
        return Version{
            "reduction", name, std::move(cost), [=](const Input& input) {
                const auto values = std::make_shared<Numbers>(input.numbers);
                const auto sum = std::make_shared<Reduction<std::uint32_t>>(method, input.n());
                return Run{
                    [] {}, [=, n = input.n()] { (*sum)(values->data(), n); },
                    [=, &input] { return complaint_about({sum->download()}, {reduce_cpu(input.numbers)}); }};
            }};
    };
    const Version thrust{
        "reduction", "Thrust", nullptr, [](const Input& input) {
            const auto values = std::make_shared<Numbers>(input.numbers);
            const auto sum = std::make_shared<std::uint32_t>(0);
            return Run{[] {}, [=, n = input.n()] { *sum = reduce_thrust(values->data(), n); },
                       [=, &input] { return complaint_about({*sum}, {reduce_cpu(input.numbers)}); }};
        }};
    return {ours("atomic", ReduceMethod::atomic, [](const Input& i) { return cost_of_reduce_atomic(i.n()); }),
            ours("shared", ReduceMethod::shared,
                 [](const Input& i) { return cost_of_reduce_tree(i.n(), add_shared_trees); }),
            ours("warp", ReduceMethod::warp,
                 [](const Input& i) { return cost_of_reduce_tree(i.n(), add_warp_trees); }),
            thrust};
}

/// @param make_scan  from the number of elements to something that scans them in place
template <class MakeScan>
Version scan_version(const char* name, std::function<Cost(const Input&)> cost, MakeScan make_scan) {
    return {"scan", name, std::move(cost), [=](const Input& input) {
                const auto values = std::make_shared<Numbers>(input.numbers);
                const auto scan = make_scan(input.n());
                return Run{[=, &input] { values->upload(input.numbers); },
                           [=, n = input.n()] { (*scan)(values->data(), n); },
                           [=, &input] {
                               std::vector<std::uint32_t> expected = input.numbers;
                               exclusive_scan_cpu(expected);
                               return complaint_about(values->download(), expected);
                           }};
            }};
}

inline std::vector<Version> scan_versions() {
    const auto by = [](ScanMethod method) {
        return [=](std::uint32_t n) { return std::make_shared<ExclusiveScan>(n, method); };
    };
    struct Thrust {
        void operator()(std::uint32_t* values, std::uint32_t n) const { scan_thrust(values, n); }
    };
    return {scan_version(
                "doubling", [](const Input& i) { return cost_of_scan_doubling(i.n()); },
                [](std::uint32_t n) { return std::make_shared<DoublingScan>(n); }),
            scan_version(
                "shared", [](const Input& i) { return cost_of_scan_shared(i.n()); }, by(ScanMethod::shared)),
            scan_version(
                "warp", [](const Input& i) { return cost_of_scan_warp(i.n()); }, by(ScanMethod::warp)),
            scan_version(
                "chunks", [](const Input& i) { return cost_of_scan_chunks(i.n(), kScanChunk); },
                by(ScanMethod::chunks)),
            scan_version("Thrust", nullptr, [](std::uint32_t) { return std::make_shared<Thrust>(); })};
}

inline std::vector<Version> histogram_versions() {
    const auto version = [](const char* name, std::function<Cost(const Input&)> cost,
                            const auto& count_into) {
        return Version{
            "histogram", name, std::move(cost), [=](const Input& input) {
                const auto bins = std::make_shared<Numbers>(input.bins);
                const auto counts = std::make_shared<Numbers>(kBins);
                const auto scratch = std::make_shared<Numbers>(input.n());
                return Run{
                    [] {},
                    [=, n = input.n()] { count_into(counts->data(), scratch->data(), bins->data(), n); },
                    [=, &input] { return complaint_about(counts->download(), histogram_cpu(input.bins)); }};
            }};
    };
    const auto ours = [&](const char* name, HistogramMethod method, std::function<Cost(const Input&)> cost) {
        return version(name, std::move(cost),
                       [=](std::uint32_t* counts, std::uint32_t*, const std::uint32_t* bin, std::uint32_t n) {
                           histogram(method, counts, bin, n);
                       });
    };
    return {ours("atomic", HistogramMethod::atomic,
                 [](const Input& i) { return cost_of_histogram_atomic(i.n()); }),
            ours("shared", HistogramMethod::shared,
                 [](const Input& i) { return cost_of_histogram_shared(i.n(), 1, kBins); }),
            ours("warp", HistogramMethod::warp,
                 [](const Input& i) { return cost_of_histogram_shared(i.n(), kWarps, kBins); }),
            version("Thrust", nullptr, histogram_thrust)};
}

inline std::uint32_t kept_of(const Input& input) {
    return input.n() - std::uint32_t(std::count(input.numbers.begin(), input.numbers.end(), 0u));
}

inline std::vector<Version> compact_versions() {
    const auto ours = [](const char* name, CompactMethod method, std::function<Cost(const Input&)> cost) {
        return Version{"compaction", name, std::move(cost), [=](const Input& input) {
                           const auto values = std::make_shared<Numbers>(input.numbers);
                           const auto compaction = std::make_shared<Compaction>(method, input.n());
                           return Run{[] {}, [=, n = input.n()] { (*compaction)(values->data(), n); },
                                      [=, &input] {
                                          std::vector<std::uint32_t> got = compaction->download(),
                                                                     expected = compact_cpu(input.numbers);
                                          if (method != CompactMethod::scan) {  // only the set is certain
                                              std::sort(got.begin(), got.end());
                                              std::sort(expected.begin(), expected.end());
                                          }
                                          return complaint_about(got, expected);
                                      }};
                       }};
    };
    const Version thrust{
        "compaction", "Thrust", nullptr, [](const Input& input) {
            const auto values = std::make_shared<Numbers>(input.numbers);
            const auto kept = std::make_shared<Numbers>(input.n());
            const auto count = std::make_shared<std::uint32_t>(0);
            return Run{[] {},
                       [=, n = input.n()] { *count = compact_thrust(kept->data(), values->data(), n); },
                       [=, &input] {
                           std::vector<std::uint32_t> got = kept->download();
                           got.resize(*count);
                           return complaint_about(got, compact_cpu(input.numbers));
                       }};
        }};
    return {ours("atomic", CompactMethod::atomic,
                 [](const Input& i) { return cost_of_compact_atomic(i.n(), kept_of(i)); }),
            ours("shared", CompactMethod::shared,
                 [](const Input& i) { return cost_of_compact_shared(i.n(), kept_of(i)); }),
            ours("warp", CompactMethod::warp,
                 [](const Input& i) { return cost_of_compact_warp(i.n(), kept_of(i)); }),
            ours("by scan", CompactMethod::scan,
                 [](const Input& i) { return cost_of_compact_scan(i.n(), kept_of(i), kScanChunk); }),
            thrust};
}

inline std::string complaint_about(const Bounds& got, const Bounds& expected) {
    return got.low_m == expected.low_m && got.high_m == expected.high_m ? "" : "another box than the CPU's";
}

/// How often a particle moves one of the six extremes, if they come in their order. All must be finite.
inline std::uint64_t improvements_of(const std::vector<float4>& positions) {
    std::uint64_t improvements = 0;
    Extremes seen;
    for (const float4& p : positions)
        for (int axis = 0; axis < 3; ++axis)
            for (const auto& [k, value] : {std::pair{axis, xyz(p)[axis]}, {3 + axis, -xyz(p)[axis]}})
                if (value < seen.minimum[k]) {
                    seen.minimum[k] = value;
                    ++improvements;
                }
    return improvements;
}

inline std::vector<Version> bounds_versions() {
    using Positions = course::DeviceBuffer<float4>;
    const auto ours = [](const char* name, BoundsMethod method, std::function<Cost(const Input&)> cost) {
        return Version{
            "bounds", name, std::move(cost), [=](const Input& input) {
                const auto positions = std::make_shared<Positions>(input.positions);
                const auto finder = std::make_shared<BoundsFinder>(method);
                return Run{
                    [] {}, [=, n = input.n()] { finder->launch(positions->data(), n); },
                    [=, &input] { return complaint_about(finder->download(), bounds_cpu(input.positions)); }};
            }};
    };
    const Version thrust{"bounds", "Thrust", nullptr, [](const Input& input) {
                             const auto positions = std::make_shared<Positions>(input.positions);
                             const auto box = std::make_shared<Bounds>();
                             return Run{
                                 [] {}, [=, n = input.n()] { *box = bounds_thrust(positions->data(), n); },
                                 [=, &input] { return complaint_about(*box, bounds_cpu(input.positions)); }};
                         }};
    return {ours("CAS loop", BoundsMethod::cas,
                 [](const Input& i) { return cost_of_bounds_cas(i.n(), improvements_of(i.positions)); }),
            ours("ordered bits", BoundsMethod::ordered,
                 [](const Input& i) { return cost_of_bounds_ordered(i.n()); }),
            ours("walk", BoundsMethod::walk,
                 [](const Input& i) { return cost_of_bounds_walk(i.n(), kWalkBlocks * kWalkThreads); }),
            ours("shared", BoundsMethod::shared,
                 [](const Input& i) { return cost_of_bounds_tree(i.n(), add_shared_trees); }),
            ours("warp", BoundsMethod::warp,
                 [](const Input& i) { return cost_of_bounds_tree(i.n(), add_warp_trees); }),
            thrust};
}

inline std::vector<Version> all_versions() {
    std::vector<Version> all;
    for (std::vector<Version> (*versions)() :
         {reduce_versions, scan_versions, histogram_versions, compact_versions, bounds_versions})
        for (Version& version : versions()) all.push_back(std::move(version));
    return all;
}

}  // namespace patterns
