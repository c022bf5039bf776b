/// @file
/// Neighbours counted five ways: by brute force, and over the grid in four steps that each do one thing
/// better.
#pragma once
#include <cuda_runtime.h>

#include "05_spatial_grid/counting_sort.cuh"
#include "05_spatial_grid/lanes.cuh"

namespace grid {

/// Strictly closer than the radius; a NaN distance is not.
inline __host__ __device__ bool is_near(glm::vec3 a, glm::vec3 b, float radius_squared_m2) {
    const glm::vec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z < radius_squared_m2;
}

/// CPU reference: every pair, the particle itself not counted.
inline std::vector<std::uint32_t> count_neighbours_cpu(const std::vector<float4>& position, float radius_m) {
    std::vector<std::uint32_t> count(position.size(), 0);
    for (std::size_t i = 0; i < position.size(); ++i)
        for (std::size_t j = 0; j < position.size(); ++j)
            count[i] += j != i && is_near(xyz(position[i]), xyz(position[j]), radius_m * radius_m);
    return count;
}

//! [brute_force]
/// One thread per particle: looks at all n. The particle finds itself too, hence the -1 (a NaN position does
/// not).
inline __global__ void neighbours_brute_force_kernel(std::uint32_t* count, const float4* position,
                                                     float radius_m, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = xyz(position[i]);
    const float radius_squared = radius_m * radius_m;
    std::uint32_t near = 0;
#pragma omp simd reduction(+ : near)
    for (std::uint32_t j = 0; j < n; ++j) near += is_near(x, xyz(position[j]), radius_squared);
    count[i] = is_finite(x) ? near - 1 : 0;
}
//! [brute_force]

//! [scattered]
/// One thread per particle: looks at the 27 cells around it. Each candidate costs two reads: its number, then
/// its position, which lies anywhere in memory.
inline __global__ void neighbours_scattered_kernel(std::uint32_t* count, const float4* position,
                                                   const std::uint32_t* order, CellRanges ranges,
                                                   CellGrid grid, float radius_m, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = xyz(position[i]);
    std::uint32_t near = 0;
    if (is_finite(x)) {
        for_each_row(grid, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            for (std::uint32_t cell = first_cell; cell <= last_cell; ++cell)
                for (std::uint32_t k = ranges.cell_first[cell]; k < ranges.cell_last[cell]; ++k)
                    near += is_near(x, xyz(position[order[k]]), radius_m * radius_m);
        });
        --near;  // itself
    }
    count[i] = near;
}
//! [scattered]

//! [coherent]
/// Only the difference: positions were gathered into cell order, so a row of three cells is one stretch of
/// memory, read from end to end. Counts come out in cell order too.
/// The loop counts from 0 along a pointer: an index that began elsewhere could wrap around at 2^32 for all a
/// compiler knows, and would keep it from loading the stretch as vectors.
/// @pre ranges come from CountingSort: empty cells keep the stretch unbroken.
inline __global__ void neighbours_coherent_kernel(std::uint32_t* sorted_count, const float4* sorted_position,
                                                  CellRanges ranges, CellGrid grid, float radius_m,
                                                  std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place >= n) return;
    const glm::vec3 x = xyz(sorted_position[place]);
    const float radius_squared = radius_m * radius_m;
    std::uint32_t near = 0;
    if (is_finite(x)) {
        for_each_row(grid, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const float4* row = sorted_position + ranges.cell_first[first_cell];
            const std::uint32_t candidates = ranges.cell_last[last_cell] - ranges.cell_first[first_cell];
            std::uint32_t near_in_row = 0;
#pragma omp simd reduction(+ : near_in_row)
            for (std::uint32_t k = 0; k < candidates; ++k)
                near_in_row += is_near(x, xyz(row[k]), radius_squared);
            near += near_in_row;
        });
        --near;
    }
    sorted_count[place] = near;
}
//! [coherent]

//! [in_lanes]
/// Only the difference: positions as columns, read in whole vectors, and one sum for each lane.
/// @pre as above; the columns have kLanes elements more than there are particles
inline __global__ void neighbours_in_lanes_kernel(std::uint32_t* sorted_count, Columns<const float> sorted,
                                                  CellRanges ranges, CellGrid grid, float radius_m,
                                                  std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place >= n) return;
    const glm::vec3 x = sorted[place];
    const float radius_squared = radius_m * radius_m;
    LaneSum<int> near;
    if (is_finite(x))
        for_each_row(grid, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::uint32_t first = ranges.cell_first[first_cell];
            const std::uint32_t candidates = ranges.cell_last[last_cell] - first;
            for_each_in_lanes(first, candidates, [&](int lane, std::ptrdiff_t k, bool mine) {
                const glm::vec3 other(sorted.x[k], sorted.y[k], sorted.z[k]);
                near.lane[lane] += is_near(x, other, radius_squared) & mine;
            });
        });
    sorted_count[place] = is_finite(x) ? near.total() - 1 : 0;
}
//! [in_lanes]

}  // namespace grid
