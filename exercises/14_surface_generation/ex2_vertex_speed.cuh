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
    (void)vertex, (void)position, (void)velocity, (void)ranges, (void)cells, (void)reach_m;
    speed[v] = float(course::kTodo);
}

}  // namespace surface
