/// @file
/// A field stored at the centres of cells, read anywhere.
#pragma once
#include <cuda_runtime.h>

#include <glm/common.hpp>

#include "05_spatial_grid/cell_grid.cuh"

namespace vortex {

using grid::CellGrid;

inline __host__ __device__ float4 mix(float4 a, float4 b, float t) {
    return make_float4(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z),
                       a.w + t * (b.w - a.w));
}

/// Where the value of a cell belongs: its centre. Cell numbers run x fastest.
inline __host__ __device__ glm::ivec3 cell_at(glm::ivec3 size, std::uint32_t number) {
    const std::uint32_t row = number / std::uint32_t(size.x);
    return {int(number % std::uint32_t(size.x)), int(row % std::uint32_t(size.y)),
            int(row / std::uint32_t(size.y))};
}
inline __host__ __device__ glm::vec3 centre_m(const CellGrid& grid, glm::ivec3 cell) {
    return grid.origin_m + (glm::vec3(cell) + 0.5f) / grid.cells_per_m;
}

//! [sample]
/// The field at x: eight cell centres surround it; mix along x, then y, then z. Beyond the outermost centres
/// the field continues with the value at the rim. A position that is not finite reads zeros.
inline __host__ __device__ float4 sample(const float4* field, const CellGrid& grid, glm::vec3 x_m) {
    if (!grid::is_finite(x_m)) return make_float4(0, 0, 0, 0);
    const glm::vec3 last = glm::vec3(grid.size - 1);
    const glm::vec3 place = glm::clamp((x_m - grid.origin_m) * grid.cells_per_m - 0.5f, glm::vec3(0), last);
    const glm::ivec3 low = glm::ivec3(place);  // place is not negative: this is floor
    const glm::ivec3 high = glm::min(low + 1, grid.size - 1);
    const glm::vec3 t = place - glm::vec3(low);
    const auto along_x = [&](int y, int z) {
        const float4* row = field + grid::cell_number(grid, {0, y, z});
        return mix(row[low.x], row[high.x], t.x);
    };
    return mix(mix(along_x(low.y, low.z), along_x(high.y, low.z), t.y),
               mix(along_x(low.y, high.z), along_x(high.y, high.z), t.y), t.z);
}
//! [sample]

//! [slope]
/// How the field changes along a unit direction, per metre: a central difference over two cells.
inline __host__ __device__ float4 slope(const float4* field, const CellGrid& grid, glm::vec3 x_m,
                                        glm::vec3 direction) {
    const glm::vec3 step_m = direction / grid.cells_per_m;
    const float4 ahead = sample(field, grid, x_m + step_m), behind = sample(field, grid, x_m - step_m);
    const float k = 0.5f * grid.cells_per_m;
    return make_float4(k * (ahead.x - behind.x), k * (ahead.y - behind.y), k * (ahead.z - behind.z),
                       k * (ahead.w - behind.w));
}
//! [slope]

}  // namespace vortex
