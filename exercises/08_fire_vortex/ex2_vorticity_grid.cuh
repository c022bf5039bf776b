// Exercise 08.2: the vorticity of every cell.
//
// The chapter's shading asks for the vorticity at every particle: six samples of the grid each, forty-eight
// reads. With many more particles than cells it is cheaper to work it out once for every cell, and to sample
// the result as if it were a velocity. Vorticity is the curl of the velocity:
//
//     omega = (dw/dy - dv/dz, du/dz - dw/dx, dv/dx - du/dy)
//
// Take differences between the two neighbours along each axis, over the distance between them. At the grid's
// rim one neighbour is missing: there the cell itself takes its place, and the distance is one edge instead
// of two. Along an axis with one cell nothing changes: the difference is 0.
#pragma once
#include <glm/geometric.hpp>

#include "08_fire_vortex/trilinear.cuh"
#include "common/todo.h"

namespace vortex {

// d(field)/d(axis) at a cell, per metre. axis: 0 is x, 1 is y, 2 is z.
inline __device__ glm::vec3 difference(const float4* field, const CellGrid& grid, glm::ivec3 cell, int axis) {
    // TODO(8.2): the two neighbours along the axis (never outside of the grid),
    // and how many edges lie between them. About 6 lines.
    return glm::vec3(float(course::kTodo));
}

// One thread per cell. vorticity: xyz in 1/s, w its length.
inline __global__ void vorticity_kernel(float4* vorticity, const float4* field, CellGrid grid) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    // TODO(8.2): which cell is number c? Then the curl, from the differences along x, y and z. About 7 lines.
    const float todo = float(course::kTodo);
    if (c < grid.cell_count()) vorticity[c] = make_float4(todo, todo, todo, todo);
}

}  // namespace vortex
