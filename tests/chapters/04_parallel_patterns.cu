// Chapter 04: every version of every pattern gives what the CPU gives, in every awkward case. What they cost
// is held against the simulator's counts in 04_parallel_patterns_counts.cu.
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <sstream>

#include "04_parallel_patterns/studies.cuh"
#include "04_parallel_patterns/summation.h"
#include "04_parallel_patterns/versions.cuh"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

using patterns::Input;

#if defined(__SANITIZE_THREAD__)
constexpr std::uint32_t kLongest = 5000;  // threads at barriers take minutes under ThreadSanitizer
#else
constexpr std::uint32_t kLongest = (1u << 20) + 3;
#endif

/// Every version on this input, several times: what one run leaves behind must not disturb the next.
void check_all(const Input& input, const std::vector<patterns::Version>& versions = patterns::all_versions(),
               int runs = 2) {
    for (const patterns::Version& version : versions) {
        INFO(version.pattern << ", " << version.name << ", n = " << input.n());
        const patterns::Run run = version.prepare(input);
        for (int repeat = 0; repeat < runs; ++repeat) {
            run.restore();
            run.work();
            CHECK(run.complaint() == "");
        }
    }
}

/// n times the same element.
Input equal_input(std::uint32_t n, std::uint32_t number, std::uint32_t bin, float4 position) {
    return {std::vector<std::uint32_t>(n, number), std::vector<std::uint32_t>(n, bin),
            std::vector<float4>(n, position)};
}

constexpr patterns::BoundsMethod kBoundsMethods[] = {
    patterns::BoundsMethod::cas, patterns::BoundsMethod::ordered, patterns::BoundsMethod::walk,
    patterns::BoundsMethod::shared, patterns::BoundsMethod::warp};

patterns::Bounds bounds_of(const std::vector<float4>& positions, patterns::BoundsMethod method) {
    const course::DeviceBuffer<float4> on_device(positions);
    return patterns::find_bounds(on_device.data(), std::uint32_t(positions.size()), method);
}

/// All methods and the library, against the CPU reference.
void check_bounds(const std::vector<float4>& positions) {
    const patterns::Bounds expected = patterns::bounds_cpu(positions);
    const course::DeviceBuffer<float4> on_device(positions);
    std::vector<patterns::Bounds> boxes{
        patterns::bounds_thrust(on_device.data(), std::uint32_t(positions.size()))};
    for (const patterns::BoundsMethod method : kBoundsMethods) boxes.push_back(bounds_of(positions, method));
    for (const patterns::Bounds& box : boxes) {
        CHECK(box.low_m == expected.low_m);
        CHECK(box.high_m == expected.high_m);
    }
}

}  // namespace

TEST_CASE("every version is right at sizes around warps, blocks and levels") {
    // 64 and 4096: a chunk and a chunk of chunks; 65536: a block of blocks.
    for (const std::uint32_t n :
         {0u, 1u, 2u, 31u, 32u, 33u, 63u, 64u, 65u, 255u, 256u, 257u, 4095u, 4097u, 65535u, 65537u})
        if (n <= kLongest) check_all(patterns::random_input(n, n + 1));
}

TEST_CASE("every version is right for 2^20 + 3 elements") {
    check_all(patterns::random_input(kLongest, 5), patterns::all_versions(), 1);
}

TEST_CASE("all elements equal: all kept or none, all in one bin, all at one place") {
    for (const std::uint32_t n : {1u, 300u, std::min(20001u, kLongest)}) {
        check_all(equal_input(n, 0, 0, make_float4(0, 0, 0, 0)));
        check_all(equal_input(n, 7, patterns::kBins - 1, make_float4(-3, 2e-38f, 1e30f, 0)));
    }
}

TEST_CASE("sums that overflow 32 bits wrap around, as the CPU's do") {
    const Input input = equal_input(5000, 0xffffffffu, 1, make_float4(0, 0, 0, 0));
    check_all(input, patterns::reduce_versions());
    check_all(input, patterns::scan_versions());
}

TEST_CASE("the kernels need no luck: results do not depend on the order of threads") {
    course::require_simulator();
#ifdef __CUDASIM__
    const Input input = patterns::random_input(3000, 2);
    for (const patterns::Version& version : patterns::all_versions()) {
        // Who draws a place first decides where an element goes: that is what these three are shown for.
        const bool luck = version.pattern == "compaction" && version.name != "by scan";
        if (version.is_library()) continue;
        INFO(version.pattern << ", " << version.name);
        const patterns::Run run = version.prepare(input);
        CHECK(cudasim::find_races(run.work).empty() != luck);
    }
    for (const auto kind : {cudasim::Order::kReverse, cudasim::Order::kShuffled}) {
        const cudasim::OrderScope order({kind, 3});
        check_all(input);
    }
#endif
}

TEST_CASE("compaction by scan keeps the order") {
    const Input input = patterns::random_input(40000, 9);
    const course::DeviceBuffer<std::uint32_t> values(input.numbers);
    patterns::Compaction compact(patterns::CompactMethod::scan, input.n());
    compact(values.data(), input.n());
    course::check_equal(compact.download(), patterns::compact_cpu(input.numbers), "kept", "place");
}

TEST_CASE("scan: as many levels as launched") {
    using patterns::ScanMethod;
    CHECK(patterns::ExclusiveScan::levels(0) == 0);
    CHECK(patterns::ExclusiveScan::levels(1) == 0);
    CHECK(patterns::ExclusiveScan::levels(2) == 1);
    CHECK(patterns::ExclusiveScan::levels(64) == 1);
    CHECK(patterns::ExclusiveScan::levels(65) == 2);
    CHECK(patterns::ExclusiveScan::levels(65536, ScanMethod::warp) == 2);
    CHECK(patterns::ExclusiveScan::levels(65537, ScanMethod::warp) == 3);
    CHECK(patterns::DoublingScan::doublings(1) == 0);
    CHECK(patterns::DoublingScan::doublings(1025) == 11);
}

TEST_CASE("bounds: negative, tiny, huge, minus zero") {
    check_bounds({});
    check_bounds({make_float4(-1, -2, -3, 0)});
    check_bounds({make_float4(-1, -2, -3, 0), make_float4(-4, -1e-30f, 5, 0)});
    check_bounds({make_float4(-0.0f, 0.0f, -0.0f, 0), make_float4(0.0f, -0.0f, -0.0f, 0)});
    check_bounds({make_float4(FLT_MAX, -FLT_MAX, FLT_MIN, 0), make_float4(-FLT_MAX, FLT_MAX, -FLT_MIN, 0)});
    std::mt19937 random(4);
    std::uniform_real_distribution<float> exponent(-120, 120);
    std::vector<float4> wide;
    for (int i = 0; i < 5000; ++i)
        wide.push_back(make_float4(std::exp2(exponent(random)), -std::exp2(exponent(random)),
                                   (i % 2 ? -1.0f : 1.0f) * std::exp2(exponent(random)), 0));
    check_bounds(wide);
}

TEST_CASE("bounds: NaN and infinity do not count") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const std::vector<float4> broken{make_float4(nan, 0, 0, 0), make_float4(0, inf, 0, 0),
                                     make_float4(0, 0, -inf, 0), make_float4(nan, nan, nan, nan)};
    check_bounds(broken);  // nobody left: an empty box
    CHECK(bounds_of(broken, patterns::BoundsMethod::warp).low_m.x > 0);
    std::vector<float4> mixed = patterns::random_input(700, 6).positions;
    mixed.insert(mixed.begin() + 300, broken.begin(), broken.end());
    check_bounds(mixed);
}

TEST_CASE("ordered bits have the order of the floats and come back unchanged") {
    const float values[] = {-INFINITY, -FLT_MAX, -1.5f,   -1.0f, -FLT_MIN, -1e-45f, -0.0f,
                            0.0f,      1e-45f,   FLT_MIN, 1.0f,  1.5f,     FLT_MAX, INFINITY};
    for (std::size_t i = 0; i < std::size(values); ++i) {
        CHECK(patterns::from_ordered_bits(patterns::ordered_bits(values[i])) == values[i]);
        CHECK(std::signbit(patterns::from_ordered_bits(patterns::ordered_bits(values[i]))) ==
              std::signbit(values[i]));
        if (i > 0) CHECK(patterns::ordered_bits(values[i - 1]) < patterns::ordered_bits(values[i]));
    }
}

TEST_CASE("ten million times 0.1f: the known wrong answer, and the right ones") {
    constexpr std::uint32_t n = 10000000;
    const std::vector<float> tenths(n, 0.1f);
    CHECK(patterns::sum_naive(tenths.data(), n) == 1087937.0f);
    CHECK(patterns::sum_double(tenths.data(), n) == double(n) * double(0.1f));  // exact: 48 bits
    // Exact is 1000000.0149; floats stand 1/16 apart there, so the nearest is 1000000.
    CHECK(patterns::sum_kahan(tenths.data(), n) == 1000000.0f);
    // Rounding errors of a relative 2^-24 at each of 24 levels, and at each of 64 additions of a short piece.
    const double exact = double(n) * double(0.1f), unit = std::exp2(-24);
    CHECK(std::abs(patterns::sum_pairwise(tenths.data(), n) - exact) <= (24 + 64) * unit * exact);
    std::vector<float> scratch((n + 1) / 2);
    CHECK(std::abs(patterns::sum_tree(tenths.data(), n, scratch.data()) - exact) <= 24 * unit * exact);
}

TEST_CASE("sums of floats: no error for whole numbers, whatever the length") {
    for (const std::size_t n : {0u, 1u, 2u, 3u, 63u, 64u, 65u, 127u, 1000u, 4097u}) {
        std::vector<float> values(n), scratch((n + 1) / 2);
        double exact = 0;
        for (std::size_t i = 0; i < n; ++i) exact += values[i] = float(int(i % 37) - 11);
        CHECK(patterns::sum_naive(values.data(), n) == exact);  // below 2^24, nothing is rounded
        CHECK(patterns::sum_pairwise(values.data(), n) == exact);
        CHECK(patterns::sum_kahan(values.data(), n) == exact);
        CHECK(patterns::sum_tree(values.data(), n, scratch.data()) == exact);
        for (const patterns::ReduceMethod method :
             {patterns::ReduceMethod::atomic, patterns::ReduceMethod::shared, patterns::ReduceMethod::warp}) {
            const course::DeviceBuffer<float> on_device(values);
            patterns::Reduction<float> sum(method, std::uint32_t(n));
            sum(on_device.data(), std::uint32_t(n));
            CHECK(sum.download() == exact);
        }
    }
}

TEST_CASE("sums of floats: errors stay below their theory's bounds") {
    // Bounds on the relative error of a sum of n positive floats, in units of 2^-24 and to first order: n
    // naive; log2(n/64) and 64 for pairwise; log2(n) for the tree; 2 for Kahan.
    const double unit = std::exp2(-24);
    for (const std::uint32_t n : {1000u, 100000u, 1000000u}) {
        const std::vector<float> values = patterns::random_floats(n, 8);
        const double exact = patterns::sum_double(values.data(), n), levels = std::ceil(std::log2(n));
        std::vector<float> scratch((n + 1) / 2);
        const auto error = [&](float sum) { return std::abs(sum - exact) / exact; };
        CHECK(error(patterns::sum_naive(values.data(), n)) <= n * unit);
        CHECK(error(patterns::sum_pairwise(values.data(), n)) <= (levels + 64) * unit);
        CHECK(error(patterns::sum_tree(values.data(), n, scratch.data())) <= levels * unit);
        CHECK(error(patterns::sum_kahan(values.data(), n)) <= 2 * unit);
    }
    // Naive is that bad: among a million numbers it loses more than Kahan could at worst.
    const std::vector<float> values = patterns::random_floats(1000000, 8);
    const double exact = patterns::sum_double(values.data(), values.size());
    CHECK(std::abs(patterns::sum_naive(values.data(), values.size()) - exact) / exact > 2 * unit);
}

TEST_CASE("NaN and infinity reach the sum") {
    std::vector<float> values(1000, 1.0f);
    const auto device_sum = [&](patterns::ReduceMethod method) {
        const course::DeviceBuffer<float> on_device(values);
        patterns::Reduction<float> sum(method, std::uint32_t(values.size()));
        sum(on_device.data(), std::uint32_t(values.size()));
        return sum.download();
    };
    for (const patterns::ReduceMethod method :
         {patterns::ReduceMethod::atomic, patterns::ReduceMethod::shared, patterns::ReduceMethod::warp}) {
        values[777] = INFINITY;
        CHECK(device_sum(method) == INFINITY);
        values[300] = NAN;
        CHECK(std::isnan(device_sum(method)));
        values[777] = values[300] = 1;
    }
}

TEST_CASE("a sum on the device repeats bit for bit, in any order of threads") {
    const std::vector<float> values = patterns::random_floats(std::min(70001u, kLongest), 3);
    const course::DeviceBuffer<float> on_device(values);
    patterns::Reduction<float> sum(patterns::ReduceMethod::warp, std::uint32_t(values.size()));
    const auto run = [&] {
        sum(on_device.data(), std::uint32_t(values.size()));
        return sum.download();
    };
    const float first = run();
    for (int repeat = 0; repeat < 5; ++repeat) CHECK(run() == first);
#ifdef __CUDASIM__
    const cudasim::OrderScope shuffled({cudasim::Order::kShuffled, 11});
    CHECK(run() == first);
#endif
}

TEST_CASE("a wrong version stops the program with its name") {
    const Input input = patterns::random_input(10, 1);
    const patterns::Version wrong{
        "reduction", "hasty", nullptr, [](const Input&) {
            return patterns::Run{[] {}, [] {}, [] { return patterns::complaint_about({1, 2}, {1, 3}); }};
        }};
    CHECK_THROWS_WITH_AS(patterns::require_right(wrong, wrong.prepare(input)),
                         "reduction, hasty: element 1 is 2 instead of 3", std::runtime_error);
    CHECK(patterns::complaint_about({1}, {1, 3}) == "1 elements instead of 2");
    CHECK(patterns::complaint_about({1, 3}, {1, 3}) == "");
}

TEST_CASE("the program: bad input ends with exit code 2 and a sentence; extremes work") {
    const course::TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "out";
    const auto run = [&](const std::string& arguments) {
        return course::run_program("ch04_parallel_patterns", arguments + " --out " + out.string());
    };
    const struct {
        const char *arguments, *sentence;
    } bad[] = {{"--particles 0", "--particles must be"},
               {"--particles 16777217", "must be from 1 to 16777216"},
               {"--window", "--window: this chapter draws pictures only"},
               {"--study nothing", "nothing"}};
    for (const auto& c : bad) {
        const course::ProgramRun ended = run(c.arguments);
        CHECK_MESSAGE(ended.exit_code == 2, c.arguments);
        CHECK_MESSAGE(ended.output.find(c.sentence) != std::string::npos, ended.output);
    }
    std::filesystem::remove_all(out);
    const course::ProgramRun explained = run("--explain --particles 1000");
    CHECK_MESSAGE(explained.exit_code == 0, explained.output);
    CHECK(explained.output.find("bounds, ordered bits: 1 kernel, 1 loads, 0 stores, 6 atomics") !=
          std::string::npos);
    CHECK_FALSE(std::filesystem::exists(out));  // explaining makes nothing
    for (const char* arguments :
         {"--particles 1 --width 16 --height 16", "--particles 2", "--particles 3001"}) {
        const course::ProgramRun ended = run(arguments);
        CHECK_MESSAGE(ended.exit_code == 0, ended.output);
        CHECK(ended.output.find("1087937") != std::string::npos);
        for (const char* file : {"steps.png", "traffic.png", "result.json"})
            CHECK_MESSAGE(std::filesystem::file_size(out / file) > 0, file);
    }
}

TEST_CASE("every study runs, and writes its rows") {
#if defined(__SANITIZE_THREAD__)
    course::skip("studies measure times: they take minutes under ThreadSanitizer");
#endif
    const course::TemporaryFolder folder;
    std::istringstream list(course::run_program("ch04_parallel_patterns", "--list-studies").output);
    int studies = 0;
    for (std::string kind, study, rest; list >> kind >> study && std::getline(list, rest); ++studies) {
        study.pop_back();  // the colon
        const course::ProgramRun ended = course::run_program(
            "ch04_parallel_patterns", "--quick --study " + study + " --out " + folder.path().string());
        CHECK_MESSAGE(ended.exit_code == 0, ended.output);
        for (const char* extension : {".csv", ".json"})
            CHECK(std::filesystem::exists(folder.path() / ("study_" + study + extension)));
    }
    // On the simulator the measure of a pattern is its counts, not times.
    CHECK(studies == (course::device_name().find("simulator") == std::string::npos ? 6 : 1));
}
