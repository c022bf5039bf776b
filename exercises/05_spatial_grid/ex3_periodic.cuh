// Exercise 05.3: a periodic box.
//
// Whoever leaves a periodic box through one face comes back through the opposite one: a piece of an endless
// liquid, with no walls. A particle near one face then has neighbours at the other.
#pragma once
#include "05_spatial_grid/neighbours.cuh"
#include "common/todo.h"

namespace grid {

// The box is what its grid says: whole cells from 0 to size / cells_per_m along each axis. An axis may have
// fewer than three cells. Every search needs a radius of less than half the box along each axis (else a
// particle would meet two images of another) and of at most a cell's edge.
inline __host__ __device__ glm::vec3 box_of(const CellGrid& grid) {
    return glm::vec3(grid.size) / grid.cells_per_m;
}

// Cube of edge box_m, in as many cells as make_grid's margin allows.
inline CellGrid make_periodic_cube(float box_m, float radius_m) {
    const double radii = double(box_m) / radius_m;
    const int cells = std::max(1, int(radii / (1.0 + 1e-5 + 3e-7 * radii)));
    return {glm::vec3(0), float(cells / double(box_m)), glm::ivec3(cells)};
}

// The shortest of all differences between two points of a box and their images. `difference_m` is that of two
// points inside the box: between -box_m and box_m along each axis.
inline __host__ __device__ glm::vec3 nearest_image(glm::vec3 difference_m, glm::vec3 box_m) {
    // TODO(5.3): an axis at a time: more than half a box apart in one direction is less than half a box apart
    // in the other. 1 to 3 lines.
    return box_m * float(course::kTodo);
}

// Calls visit(cell) for the number of each cell that can hold neighbours of x, images included: the cells
// around x as in for_each_row, but those beyond one face are the ones inside the opposite face.
template <class Visit>
__host__ __device__ void for_each_wrapped_cell(const CellGrid& grid, glm::vec3 x_m, Visit visit) {
    const glm::ivec3 centre = cell_of(grid, x_m);
    // TODO(5.3): three nested loops. Mind the sign of % in C++, and axes with one or two cells:
    // no cell may be visited twice. About 8 lines.
    visit(cell_number(grid, centre));
}

// One thread per place of the sorted order. Positions lie inside the box, 0 <= x < box.
inline __global__ void neighbours_periodic_kernel(std::uint32_t* sorted_count, const float4* sorted_position,
                                                  CellRanges ranges, CellGrid grid, float radius_m,
                                                  std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place >= n) return;
    const glm::vec3 x = xyz(sorted_position[place]);
    std::uint32_t near = 0;
    for_each_wrapped_cell(grid, x, [&](std::uint32_t cell) {
        for (std::uint32_t k = ranges.cell_first[cell]; k < ranges.cell_last[cell]; ++k) {
            const glm::vec3 d = nearest_image(x - xyz(sorted_position[k]), box_of(grid));
            near += k != place && is_near(d, glm::vec3(0), radius_m * radius_m);
        }
    });
    sorted_count[place] = near;
}

}  // namespace grid
