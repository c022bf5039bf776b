/// @file
/// What this chapter measures: time of each version against the number of elements, time of a histogram
/// against crowding, and what rounding leaves of a sum against the time it takes.
#pragma once
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "04_parallel_patterns/summation.h"
#include "04_parallel_patterns/versions.cuh"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace patterns {

/// @throws std::runtime_error if the version's result is not the CPU's
inline void require_right(const Version& version, const Run& run) {
    const std::string complaint = run.complaint();
    if (!complaint.empty())
        throw std::runtime_error(version.pattern + ", " + version.name + ": " + complaint);
}

/// Seconds of one call of `work`, by the host's clock: from the first launch until the device is done. Short
/// work is done several times in a row.
template <class Work>
course::Timing time_on_device(const course::Study& study, double n, Work&& work) {
    const int batch = int(std::max(1.0, (1 << 16) / std::max(n, 1.0)));
    return course::time_work(study.quick ? 5 : 9,
                             [&] {
                                 for (int k = 0; k < batch; ++k) work();
                                 CUDA_CHECK(cudaDeviceSynchronize());
                             })
        .per(batch);
}

/// One row: the version's time on this input, once its result is known to be right.
inline void add_version(course::Study& study, const Version& version, const Input& input, double value) {
    const Run run = version.prepare(input);
    run.work();
    require_right(version, run);
    const double n = input.n();
    study.add({version.name, value, n, 0, time_on_device(study, n, run.work)});
}

/// Elements that a study goes through: each size 16 times the one before.
inline std::vector<std::uint32_t> study_sizes(const course::Study& study) {
    std::vector<std::uint32_t> sizes{1u << 8, 1u << 12, 1u << 16};
    if (!study.quick) sizes.push_back(1u << 20);
    if (study.backend == "cuda") sizes.push_back(1u << 24);
    return sizes;
}

inline void study_versions(course::Study& study, const std::vector<Version>& versions) {
    course::on_device(study);
    const std::vector<std::uint32_t> sizes = study_sizes(study);
    study.expect(int(sizes.size() * versions.size()));
    for (const std::uint32_t n : sizes) {
        const Input input = random_input(n, 1);
        for (const Version& version : versions) add_version(study, version, input, n);
    }
}
inline void study_reduce(course::Study& study) {
    study_versions(study, reduce_versions());
}
inline void study_scan(course::Study& study) {
    study_versions(study, scan_versions());
}
inline void study_compact(course::Study& study) {
    study_versions(study, compact_versions());
}
inline void study_bounds(course::Study& study) {
    study_versions(study, bounds_versions());
}

/// Time of a histogram when more and more elements want the same bin.
inline void study_histogram(course::Study& study) {
    course::on_device(study);
    const std::vector<Version> versions = histogram_versions();
    const std::vector<double> shares{1.0 / 256, 1.0 / 16, 1.0 / 4, 1};
    study.expect(int(shares.size() * versions.size()));
    for (const double share : shares) {
        Input input = random_input(study.quick ? 1u << 16 : 1u << 20, 1);
        for (std::uint32_t i = 0; i < input.n(); ++i)
            if (double(i % 256) < share * 256) input.bins[i] = 7;
        for (const Version& version : versions) add_version(study, version, input, share);
    }
}

//! [summation_study]
/// Numbers between 0 and 1 whose sum is known exactly: they are multiples of 2^-24, and a double has room for
/// the sum of 2^29 of them.
inline std::vector<float> random_floats(std::uint32_t n, std::uint64_t seed) {
    std::vector<float> values;
    values.reserve(n);
    const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
    for (std::uint32_t i = 0; i < n; ++i)
        values.push_back(float(r123::Philox4x32()({{i, 1, 0, 0}}, key)[0] >> 8) / (1 << 24));
    return values;
}

/// One way to add floats, on the host or on the device.
struct Summation {
    std::string name;
    bool on_device;
    std::function<float()> sum;
};

/// All ways, made ready for these numbers, which must outlive them.
inline std::vector<Summation> summations(const std::vector<float>& values) {
    const float* data = values.data();
    const std::size_t n = values.size();
    const auto scratch = std::make_shared<std::vector<float>>((n + 1) / 2);
    const auto device = std::make_shared<course::DeviceBuffer<float>>(values);
    const auto on_device = [&](ReduceMethod method) {
        const auto reduction = std::make_shared<Reduction<float>>(method, std::uint32_t(n));
        return [=] {
            (*reduction)(device->data(), std::uint32_t(n));
            return reduction->download();
        };
    };
    return {{"naive", false, [=] { return sum_naive(data, n); }},
            {"pairwise", false, [=] { return sum_pairwise(data, n); }},
            {"Kahan", false, [=] { return sum_kahan(data, n); }},
            {"tree", false, [=] { return sum_tree(data, n, scratch->data()); }},
            {"in double", false, [=] { return float(sum_double(data, n)); }},
            {"atomics on the device", true, on_device(ReduceMethod::atomic)},
            {"tree on the device", true, on_device(ReduceMethod::warp)}};
}

/// Error: largest of four sets of numbers, so that a lucky one does not count. The ways of the device are
/// timed on a GPU only.
inline void study_summation(course::Study& study) {
    const bool on_gpu = course::is_gpu();
    if (on_gpu) course::on_device(study);  // else all that is timed runs on the processor
    std::vector<std::uint32_t> sizes{1000, 10000, 100000, 1000000};
    if (!study.quick) sizes.push_back(10000000);
    study.expect(int(sizes.size()) * (on_gpu ? 7 : 5));
    for (const std::uint32_t n : sizes) {
        std::vector<double> error(7, 0.0);
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const std::vector<float> values = random_floats(n, seed);
            const double exact = sum_double(values.data(), n);
            const std::vector<Summation> ways = summations(values);
            for (std::size_t k = 0; k < ways.size(); ++k) {
                error[k] = std::max(error[k], std::abs(ways[k].sum() - exact) / exact);
                if (seed < 4 || (ways[k].on_device && !on_gpu)) continue;
                volatile float sink;  // so that the compiler cannot leave the sum out
                study.add({ways[k].name, double(n), double(n), error[k],
                           time_on_device(study, n, [&] { sink = ways[k].sum(); })});
            }
        }
    }
}
//! [summation_study]

}  // namespace patterns
