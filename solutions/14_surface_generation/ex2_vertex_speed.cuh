// Exercise 14.2: how fast is the water at the surface?
//
// A vertex of the mesh is no particle: it has a place and a normal, and nothing else. Foam, for instance,
// wants the water's speed there. Ask the particles near it: the mean of their speeds, the nearer ones
// counting more.
#pragma once
#include "05_spatial_grid/counting_sort.cuh"
#include "common/todo.h"

namespace surface {

// One thread per vertex: the mean speed (m/s) of the particles nearer than reach_m, each with the weight
// (1 - r^2 / reach^2)^3; 0 where there is none.
// position, velocity: sorted by cell; cells are at least reach_m wide. Particles at NaN are in the limbo,
// where no search ever looks.
__global__ void vertex_speed_kernel(float* speed, const float4* vertex, std::uint32_t vertex_count,
                                    const float4* position, const float4* velocity, grid::CellRanges ranges,
                                    grid::CellGrid cells, float reach_m) {
    const std::uint32_t v = blockIdx.x * blockDim.x + threadIdx.x;
    if (v >= vertex_count) return;
    // TODO(14.2): a weighted mean over the rows of cells around the vertex (chapter 05). About 15 lines.
    // <solution>
    const glm::vec3 x = grid::xyz(vertex[v]);
    float sum = 0, weights = 0;
    grid::for_each_row(cells, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
        for (std::uint32_t k = ranges.cell_first[first_cell]; k < ranges.cell_last[last_cell]; ++k) {
            const float dx = position[k].x - x.x, dy = position[k].y - x.y, dz = position[k].z - x.z;
            const float inside = 1 - (dx * dx + dy * dy + dz * dz) / (reach_m * reach_m);
            if (!(inside > 0)) continue;
            const float weight = inside * inside * inside;
            const float4 u = velocity[k];
            sum += weight * sqrtf(u.x * u.x + u.y * u.y + u.z * u.z);
            weights += weight;
        }
    });
    speed[v] = weights > 0 ? sum / weights : 0.0f;
    // <stub>
    //| (void)vertex, (void)position, (void)velocity, (void)ranges, (void)cells, (void)reach_m;
    //| speed[v] = float(course::kTodo);
    // </solution>
}

}  // namespace surface
