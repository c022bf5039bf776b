// Chapter 04: what the formulas of costs.h say is what happens, access by access. This program is built so
// that the simulator counts (COUNT_ACCESSES); with a GPU or a sanitizer there is nothing to count by, and the
// cases are skipped.
#include "04_parallel_patterns/versions.cuh"
#include "tests/support/course_test.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

void require_counting() {
#ifndef CUDASIM_COUNT_ACCESSES
    course::skip("accesses are counted on the simulator only, and not under a sanitizer");
#endif
}

#ifdef CUDASIM_COUNT_ACCESSES
/// What the kernels of `work` did.
template <class Work>
patterns::Cost counted(Work&& work) {
    const cudasim::Recording log;
    work();
    const cudasim::Counts c = log.counts();
    return {log.launches().size(), c.global_loads,  c.global_stores,  c.global_bytes, c.global_atomics,
            c.shared_loads,        c.shared_stores, c.shared_atomics, c.barriers,     c.warp_operations};
}

void check_cost(const patterns::Cost& got, const patterns::Cost& formula) {
    CHECK(got.launches == formula.launches);
    CHECK(got.loads == formula.loads);
    CHECK(got.stores == formula.stores);
    CHECK(got.bytes == formula.bytes);
    CHECK(got.atomics == formula.atomics);
    CHECK(got.shared_loads == formula.shared_loads);
    CHECK(got.shared_stores == formula.shared_stores);
    CHECK(got.shared_atomics == formula.shared_atomics);
    CHECK(got.barriers == formula.barriers);
    CHECK(got.warp_operations == formula.warp_operations);
}

void check_versions(const std::vector<patterns::Version>& versions) {
    // One worker: a CAS loop asks again when another thread was faster, and then there is no formula.
    const cudasim::WorkerScope one_worker(1);
    for (const std::uint32_t n : {0u, 1u, 2u, 255u, 256u, 257u, 5000u, 70001u}) {
        const patterns::Input input = patterns::random_input(n, 3);
        for (const patterns::Version& version : versions) {
            if (version.is_library()) continue;
            INFO(version.pattern << ", " << version.name << ", n = " << n);
            const patterns::Run run = version.prepare(input);
            check_cost(counted(run.work), version.cost(input));
            CHECK(run.complaint() == "");
        }
    }
}
#endif

}  // namespace

TEST_CASE("reduction: the formulas are exact") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    check_versions(patterns::reduce_versions());
    // By hand: 1000 elements in 4 blocks, then 4 sums in one. Two shuffles of 5 steps by 8 warps and by the
    // first, in 5 blocks.
    const patterns::Cost warp = patterns::cost_of_reduce_tree(1000, patterns::add_warp_trees);
    CHECK(warp.loads == 1000 + 4);
    CHECK(warp.stores == 4 + 1);
    CHECK(warp.warp_operations == 5 * (8 * 5 + 5));
    CHECK(warp.barriers == 5);
#endif
}

TEST_CASE("reduction: with fewer blocks the same sum, and less for the trees to do") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    const std::uint32_t n = 5000;
    const course::DeviceBuffer<std::uint32_t> ones(std::vector<std::uint32_t>(n, 1));
    patterns::TreeReduction<patterns::Sum<std::uint32_t>> tree(n, 3);
    CHECK(tree.bytes() == (3 + 1) * sizeof(std::uint32_t));
    const patterns::Cost cost = counted([&] { tree(ones.data(), n); });
    CHECK(tree.download() == n);
    CHECK(cost.launches == 2);
    CHECK(cost.loads == n + 3);  // the second launch adds up three blocks
    CHECK(cost.barriers == (3 + 1) * patterns::kTreeSteps);
    tree(ones.data(), 0);
    CHECK(tree.download() == 0);
#endif
}

TEST_CASE("scan: the formulas are exact") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    check_versions(patterns::scan_versions());
#endif
}

TEST_CASE("histogram: the formulas are exact") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    check_versions(patterns::histogram_versions());
#endif
}

TEST_CASE("compaction: the formulas are exact") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    check_versions(patterns::compact_versions());
#endif
}

TEST_CASE("bounds: the formulas are exact") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    check_versions(patterns::bounds_versions());
#endif
}

TEST_CASE("bounds: each particle asks six times, on any number of workers") {
    require_counting();
#ifdef CUDASIM_COUNT_ACCESSES
    const patterns::Input input = patterns::random_input(60000, 3);
    const patterns::Run run = patterns::bounds_versions().front().prepare(input);
    const patterns::Cost formula = patterns::bounds_versions().front().cost(input);
    const patterns::Cost got = counted(run.work);  // on as many workers as there are
    CHECK(got.loads == formula.loads);
    // Blocks come in another order too, so another number of improvements; but each particle asks six times.
    CHECK(got.atomics >= 6 * input.n());
    CHECK(run.complaint() == "");
#endif
}
