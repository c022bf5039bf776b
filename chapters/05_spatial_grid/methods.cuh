/// @file
/// The five ways to find neighbours, on one cloud of particles: made ready to be run, compared and timed.
#pragma once
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "05_spatial_grid/neighbours.cuh"
#include "05_spatial_grid/sorted_grid.cuh"

namespace grid {

/// Particles on the device and the grid around them; results come into `count`.
struct Cloud {
    std::uint32_t n;
    float radius_m;
    course::DeviceBuffer<float4> position, sorted_position;
    ColumnBuffer sorted_columns;
    course::DeviceBuffer<std::uint32_t> count;
    CellGrid cells;

    Cloud(const std::vector<float4>& points, float radius)
        : n(std::uint32_t(points.size())),
          radius_m(radius),
          position(points),
          sorted_position(n),
          sorted_columns(n),
          count(n) {
        const Bounds box = find_bounds(position.data(), n);
        cells = make_grid(box.low_m, box.high_m, radius_m, max_cells_for(n));
    }
};

struct Method {
    std::string name;
    std::function<void()> build, query;
    /// Neighbours of each particle, by its number, after a query.
    std::function<std::vector<std::uint32_t>()> counts;
};

/// Beyond this many pairs brute force answers for some of the particles only: each costs the same, so nothing
/// is lost but time.
constexpr std::uint64_t kMostPairs = 1ull << 30;

/// Particles that brute force is asked for: whole blocks, at least one.
inline std::uint32_t asked_of_brute_force(std::uint32_t n) {
    const std::uint64_t threads = CountingSort::kThreads;
    const std::uint64_t most_blocks = std::max<std::uint64_t>(1, kMostPairs / std::max(n, 1u) / threads);
    return std::uint32_t(std::min<std::uint64_t>(n, most_blocks * threads));
}

/// Brute force first. @param cloud outlives them; n is at least 1
inline std::vector<Method> methods(Cloud& cloud) {
    const std::uint32_t n = cloud.n, threads = CountingSort::kThreads, blocks = blocks_for(n, threads);
    const auto sorted = std::make_shared<SortedGrid>(n, cloud.cells.cell_count());
    const auto counted = std::make_shared<CountingSort>(n, cloud.cells.cell_count());
    const auto counts = [&cloud] { return cloud.count.download(); };
    const auto scattered = [&cloud, blocks](const auto& sort) {
        neighbours_scattered_kernel<<<blocks, threads>>>(cloud.count.data(), cloud.position.data(),
                                                         sort.order(), sort.ranges(), cloud.cells,
                                                         cloud.radius_m, cloud.n);
        CUDA_CHECK(cudaGetLastError());
    };
    const auto counts_by_number = [&cloud, counted] {
        const std::vector<std::uint32_t> in_cell_order = cloud.count.download();
        std::vector<std::uint32_t> order(cloud.n), by_number(cloud.n);
        CUDA_CHECK(
            cudaMemcpy(order.data(), counted->order(), cloud.n * sizeof order[0], cudaMemcpyDeviceToHost));
        for (std::uint32_t place = 0; place < cloud.n; ++place)
            by_number[order[place]] = in_cell_order[place];
        return by_number;
    };
    return {
        {"brute force", [] {},
         [&cloud] {
             const std::uint32_t asked = asked_of_brute_force(cloud.n);
             neighbours_brute_force_kernel<<<blocks_for(asked, threads), threads>>>(
                 cloud.count.data(), cloud.position.data(), cloud.radius_m, cloud.n);
             CUDA_CHECK(cudaGetLastError());
         },
         [&cloud] {
             std::vector<std::uint32_t> first = cloud.count.download();
             first.resize(asked_of_brute_force(cloud.n));
             return first;
         }},
        {"sorted grid", [&cloud, sorted] { sorted->build(cloud.position.data(), cloud.cells, cloud.n); },
         [=] { scattered(*sorted); }, counts},
        {"counting sort", [&cloud, counted] { counted->build(cloud.position.data(), cloud.cells, cloud.n); },
         [=] { scattered(*counted); }, counts},
        {"reordered",
         [&cloud, counted, blocks] {
             counted->build(cloud.position.data(), cloud.cells, cloud.n);
             gather_kernel<<<blocks, threads>>>(cloud.sorted_position.data(), cloud.position.data(),
                                                counted->order(), cloud.n);
             CUDA_CHECK(cudaGetLastError());
         },
         [&cloud, counted, blocks] {
             neighbours_coherent_kernel<<<blocks, threads>>>(cloud.count.data(), cloud.sorted_position.data(),
                                                             counted->ranges(), cloud.cells, cloud.radius_m,
                                                             cloud.n);
             CUDA_CHECK(cudaGetLastError());
         },
         counts_by_number},
        {"whole vectors",
         [&cloud, counted, blocks] {
             counted->build(cloud.position.data(), cloud.cells, cloud.n);
             gather_columns_kernel<<<blocks, threads>>>(cloud.sorted_columns.columns(), cloud.position.data(),
                                                        counted->order(), cloud.n);
             CUDA_CHECK(cudaGetLastError());
         },
         [&cloud, counted, blocks] {
             neighbours_in_lanes_kernel<<<blocks, threads>>>(
                 cloud.count.data(), std::as_const(cloud.sorted_columns).columns(), counted->ranges(),
                 cloud.cells, cloud.radius_m, cloud.n);
             CUDA_CHECK(cudaGetLastError());
         },
         counts_by_number}};
}

/// Particles, of those that both were asked for, whose number of neighbours differs.
inline std::uint32_t different_counts(const std::vector<std::uint32_t>& a,
                                      const std::vector<std::uint32_t>& b) {
    std::uint32_t different = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) different += a[i] != b[i];
    return different;
}

/// @throws std::runtime_error naming the first particle whose number of neighbours differs from brute force's
inline void check_same(const std::vector<std::uint32_t>& counts,
                       const std::vector<std::uint32_t>& by_brute_force, const std::string& method) {
    for (std::size_t i = 0; i < std::min(counts.size(), by_brute_force.size()); ++i)
        if (counts[i] != by_brute_force[i])
            throw std::runtime_error(method + " finds " + std::to_string(counts[i]) +
                                     " neighbours of particle " + std::to_string(i) + ", brute force " +
                                     std::to_string(by_brute_force[i]));
}

}  // namespace grid
