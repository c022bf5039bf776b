/// @file
/// The four methods on one cloud of particles: timed, and checked against each other.
#pragma once
#include <numeric>
#include <stdexcept>
#include <string>

#include "05_spatial_grid/bounds.cuh"
#include "05_spatial_grid/cloud.h"
#include "05_spatial_grid/neighbours.cuh"
#include "05_spatial_grid/sorted_grid.cuh"
#include "common/gpu_timer.h"

namespace grid {

struct Times {
    float build_ms = 0, query_ms = 0;
};

struct Measurement {
    std::uint32_t n = 0;
    double neighbours_each = 0;  ///< mean
    std::uint32_t asked = 0;     ///< particles brute force was asked for; its time is scaled to n
    float bounds_ms = 0;
    Times brute_force, sorted_grid, counting_sort, reordered;
};

/// Beyond this many pairs brute force answers for some of the particles only, and its time is scaled: each
/// particle costs the same, so nothing is lost but time.
constexpr std::uint64_t kMostPairs = 1ull << 30;

/// @throws std::runtime_error naming the first particle whose number of neighbours differs
inline void check_same(const std::vector<std::uint32_t>& counts, const std::vector<std::uint32_t>& reference,
                       std::uint32_t first_n, const std::string& method) {
    for (std::uint32_t i = 0; i < first_n; ++i)
        if (counts[i] != reference[i])
            throw std::runtime_error(method + " finds " + std::to_string(counts[i]) +
                                     " neighbours of particle " + std::to_string(i) + ", the counting sort " +
                                     std::to_string(reference[i]));
}

/// Medians of `repeats` runs of each method on the same cloud.
inline Measurement measure(std::uint32_t n, std::uint64_t seed, int repeats) {
    const float radius_m = radius_for_30(n);
    course::DeviceBuffer<float4> position(random_cloud(n, seed)), sorted_position(n);
    course::DeviceBuffer<std::uint32_t> count(n);
    const std::uint32_t threads = CountingSort::kThreads, blocks = blocks_for(n, threads);
    Measurement m;
    m.n = n;

    Bounds box;
    m.bounds_ms = course::median_milliseconds(repeats, [&] { box = find_bounds(position.data(), n); });
    const CellGrid cells = make_grid(box.low_m, box.high_m, radius_m, max_cells_for(n));

    const auto time_build = [&](auto& sort) {
        return course::median_milliseconds(repeats, [&] { sort.build(position.data(), cells, n); });
    };
    const auto time_scattered_query = [&](const auto& sort) {
        return course::median_milliseconds(repeats, [&] {
            neighbours_scattered_kernel<<<blocks, threads>>>(count.data(), position.data(), sort.order(),
                                                             sort.ranges(), cells, radius_m, n);
            CUDA_CHECK(cudaGetLastError());
        });
    };

    CountingSort by_counting(n, cells.cell_count());
    m.counting_sort = {time_build(by_counting), time_scattered_query(by_counting)};
    const std::vector<std::uint32_t> reference = count.download();
    m.neighbours_each = std::accumulate(reference.begin(), reference.end(), 0.0) / n;

    SortedGrid by_sorting(n, cells.cell_count());
    m.sorted_grid = {time_build(by_sorting), time_scattered_query(by_sorting)};
    check_same(count.download(), reference, n, "the sorted grid");

    m.reordered.build_ms = course::median_milliseconds(repeats, [&] {
        by_counting.build(position.data(), cells, n);
        gather_kernel<<<blocks, threads>>>(sorted_position.data(), position.data(), by_counting.order(), n);
        CUDA_CHECK(cudaGetLastError());
    });
    m.reordered.query_ms = course::median_milliseconds(repeats, [&] {
        neighbours_coherent_kernel<<<blocks, threads>>>(count.data(), sorted_position.data(),
                                                        by_counting.ranges(), cells, radius_m, n);
        CUDA_CHECK(cudaGetLastError());
    });
    const std::vector<std::uint32_t> in_cell_order = count.download();
    std::vector<std::uint32_t> order(n), counts(n);
    CUDA_CHECK(cudaMemcpy(order.data(), by_counting.order(), n * sizeof order[0], cudaMemcpyDeviceToHost));
    for (std::uint32_t place = 0; place < n; ++place) counts[order[place]] = in_cell_order[place];
    check_same(counts, reference, n, "the reordered search");

    // Fewer blocks ask for fewer particles; each still looks at all n.
    const std::uint64_t most_blocks = std::max<std::uint64_t>(1, kMostPairs / n / threads);
    const std::uint32_t asked_blocks = std::uint32_t(std::min<std::uint64_t>(blocks, most_blocks));
    m.asked = std::min(n, asked_blocks * threads);
    m.brute_force.query_ms = course::median_milliseconds(repeats, [&] {
        neighbours_brute_force_kernel<<<asked_blocks, threads>>>(count.data(), position.data(), radius_m, n);
        CUDA_CHECK(cudaGetLastError());
    });
    m.brute_force.query_ms *= float(n) / float(m.asked);
    check_same(count.download(), reference, m.asked, "brute force");
    return m;
}

}  // namespace grid
