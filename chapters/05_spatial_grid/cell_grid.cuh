/// @file
/// A uniform grid of cubic cells: which cell holds a point, and which cells can hold its neighbours.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "04_parallel_patterns/bounds.cuh"

/// Chapter 05: cells, and who is near whom.
namespace grid {

// Chapter 04's: particles as vectors, and the box around them, so that the grid can follow them.
using patterns::Bounds;
using patterns::bounds_cpu;
using patterns::find_bounds;
using patterns::is_finite;
using patterns::xyz;

/// Where the cells are. Cells are numbered x fastest, then y, then z, from 0 to cell_count() - 1.
/// One number more, cell_count() itself, is the *limbo*: particles whose position is not finite go there, and
/// no search ever looks into it.
struct CellGrid {
    glm::vec3 origin_m{0};  ///< lower corner of cell 0
    float cells_per_m = 1;  ///< 1 / edge of a cell
    glm::ivec3 size{1};     ///< cells along each axis, at least 1

    __host__ __device__ std::uint32_t cell_count() const {
        return std::uint32_t(size.x) * std::uint32_t(size.y) * std::uint32_t(size.z);
    }
};

//! [cell_of]
/// Cell that holds the point. Points beyond the grid belong to the nearest cell of its rim: clamping moves no
/// two points further apart, so neighbours stay in the same or adjacent cells.
/// @pre x_m is finite. Converting NaN or 1e20 to int is undefined, so the clamp comes before the conversion.
inline __host__ __device__ glm::ivec3 cell_of(const CellGrid& grid, glm::vec3 x_m) {
    const glm::vec3 cell = glm::floor((x_m - grid.origin_m) * grid.cells_per_m);
    return glm::ivec3(glm::clamp(cell, glm::vec3(0.0f), glm::vec3(grid.size - 1)));
}

inline __host__ __device__ std::uint32_t cell_number(const CellGrid& grid, glm::ivec3 cell) {
    return (std::uint32_t(cell.z) * grid.size.y + cell.y) * grid.size.x + cell.x;
}
//! [cell_of]

//! [make_grid]
/// Grid over the box from `low_m` to `high_m` for neighbours closer than `radius_m`.
///
/// The edge is a little more than the radius. In fp32 the scaled coordinate s = (x - origin) / edge carries
/// an error of up to 1.2e-7 s, so with n cells along an axis two points less than one edge apart can land two
/// cells apart unless the edge exceeds the radius by 2.4e-7 n. We add 3e-7 n, and 1e-5 for the rounding of
/// the distance itself.
///
/// A box with more than `max_cells` cells gets larger ones: the search stays exact, it only looks at more
/// candidates.
inline CellGrid make_grid(glm::vec3 low_m, glm::vec3 high_m, float radius_m, std::uint32_t max_cells) {
    // In double: neither the extent of a huge box nor the product of its cell counts overflows.
    const glm::dvec3 extent_m = glm::max(glm::dvec3(high_m) - glm::dvec3(low_m), 0.0);
    const double longest = glm::max(extent_m.x, glm::max(extent_m.y, extent_m.z)) / radius_m;
    double edge_m = radius_m * (1.0 + 1e-5 + 3e-7 * longest);
    for (;; edge_m *= 2) {
        const glm::dvec3 cells = glm::floor(extent_m / edge_m) + 1.0;
        if (cells.x * cells.y * cells.z <= max_cells) return {low_m, float(1.0 / edge_m), glm::ivec3(cells)};
    }
}
//! [make_grid]

/// Largest grid worth having for n particles: more cells than that are nearly all empty, and memory is
/// bounded by n.
inline std::uint32_t max_cells_for(std::size_t particle_count) {
    const std::size_t cells = 4096 + 4 * particle_count;
    return cells < (1u << 30) ? std::uint32_t(cells) : 1u << 30;
}

//! [for_each_row]
/// Calls visit(first_cell, last_cell) for the up to nine rows of three cells around x. Cells of a row have
/// successive numbers, so when particles are sorted by cell a row is one contiguous range of particles.
template <class Visit>
__host__ __device__ __forceinline__ void for_each_row(const CellGrid& grid, glm::vec3 x_m, Visit visit) {
    const glm::ivec3 centre = cell_of(grid, x_m);
    const glm::ivec3 low = glm::max(centre - 1, glm::ivec3(0));
    const glm::ivec3 high = glm::min(centre + 1, grid.size - 1);
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            visit(cell_number(grid, {low.x, y, z}), cell_number(grid, {high.x, y, z}));
}
//! [for_each_row]

}  // namespace grid
