/// @file
/// Where the grid breaks: the same number of particles, ever more crowded.
#pragma once
#include <string>
#include <vector>

#include "05_spatial_grid/bounds.cuh"
#include "05_spatial_grid/cloud.h"
#include "05_spatial_grid/neighbours.cuh"
#include "common/gpu_timer.h"

namespace grid {

struct Crowd {
    std::string name;
    std::vector<float4> position;
};

/// Clouds of n points: even, drawn towards a corner (each coordinate u becomes u^2 and u^4), and all within
/// half a radius, so that one cell holds them.
inline std::vector<Crowd> crowds(std::uint32_t n, std::uint64_t seed, float radius_m) {
    const std::vector<float4> even = random_cloud(n, seed);
    Crowd second{"u^2", even}, fourth{"u^4", even}, one_cell{"one cell", even};
    for (float4& p : second.position) p = make_float4(p.x * p.x, p.y * p.y, p.z * p.z, 0);
    fourth.position = second.position;
    for (float4& p : fourth.position) p = make_float4(p.x * p.x, p.y * p.y, p.z * p.z, 0);
    for (float4& p : one_cell.position) {
        const float scale = 0.5f * radius_m;
        p = make_float4(scale * p.x, scale * p.y, scale * p.z, 0);
    }
    return {{"even", even}, second, fourth, one_cell};
}

struct CrowdTimes {
    std::uint32_t cells = 0, fullest = 0;  ///< cells of the grid; particles in the fullest of them
    double neighbours_each = 0, candidates_each = 0;
    float build_ms = 0, query_ms = 0;
};

/// The reordered search on this crowd.
inline CrowdTimes measure_crowd(const std::vector<float4>& cloud, float radius_m, int repeats) {
    const std::uint32_t n = std::uint32_t(cloud.size());
    const std::uint32_t threads = CountingSort::kThreads, blocks = blocks_for(n, threads);
    const course::DeviceBuffer<float4> position(cloud);
    course::DeviceBuffer<float4> sorted_position(n);
    course::DeviceBuffer<std::uint32_t> count(n);
    const Bounds box = find_bounds(position.data(), n);
    const CellGrid cells = make_grid(box.low_m, box.high_m, radius_m, max_cells_for(n));
    CountingSort sort(n, cells.cell_count());
    CrowdTimes result;
    result.cells = cells.cell_count();
    result.build_ms = course::median_milliseconds(repeats, [&] {
        sort.build(position.data(), cells, n);
        gather_kernel<<<blocks, threads>>>(sorted_position.data(), position.data(), sort.order(), n);
        CUDA_CHECK(cudaGetLastError());
    });
    result.query_ms = course::median_milliseconds(repeats, [&] {
        neighbours_coherent_kernel<<<blocks, threads>>>(count.data(), sorted_position.data(), sort.ranges(),
                                                        cells, radius_m, n);
        CUDA_CHECK(cudaGetLastError());
    });

    std::vector<std::uint32_t> first(cells.cell_count() + 1);
    CUDA_CHECK(cudaMemcpy(first.data(), sort.ranges().cell_first, first.size() * sizeof first[0],
                          cudaMemcpyDeviceToHost));
    for (std::uint32_t c = 0; c < cells.cell_count(); ++c)
        result.fullest = std::max(result.fullest, first[c + 1] - first[c]);
    for (const float4& p : cloud)
        for_each_row(cells, xyz(p), [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            result.candidates_each += double(first[last_cell + 1] - first[first_cell]) / n;
        });
    for (std::uint32_t c : count.download()) result.neighbours_each += double(c) / n;
    return result;
}

}  // namespace grid
