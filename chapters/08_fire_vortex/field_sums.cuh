/// @file
/// The field of many vortons at the centres of the grid's cells, one thread per cell, three ways: everybody,
/// neighbour cells alone, and neighbour cells with a pyramid of cell sums for all the rest.
#pragma once
#include <cuda_runtime.h>

#include "05_spatial_grid/counting_sort.cuh"
#include "08_fire_vortex/blob.cuh"
#include "08_fire_vortex/trilinear.cuh"

namespace vortex {

using grid::CellRanges;

/// Vortons in cell order. position: xyz in m, w not read. strength: xyz = alpha in m^3/s, w = heat, the
/// buoyancy of the hot gas the vorton carries times its volume, in m^4/s^2.
struct SortedVortons {
    const float4* position;
    const float4* strength;
    CellRanges ranges;
};

//! [FieldSum]
/// Adds up what vortons give at one point: the velocity they induce and the buoyancy of their gas.
struct FieldSum {
    float u = 0, v = 0, w = 0, buoyancy = 0;

    /// Adds `count` vortons that stand in a row in memory. The common factors wait until the end.
    __host__ __device__ void add(const float4* position, const float4* strength, std::uint32_t count,
                                 glm::vec3 x, float core2) {
        float du = 0, dv = 0, dw = 0, db = 0;
#pragma omp simd reduction(+ : du, dv, dw, db)
        for (std::uint32_t k = 0; k < count; ++k) {
            const float dx = x.x - position[k].x, dy = x.y - position[k].y, dz = x.z - position[k].z;
            const float r2 = dx * dx + dy * dy + dz * dz;
            const float inverse = 1.0f / (r2 + core2);
            const float power = inverse * inverse * std::sqrt(inverse);  // (r^2 + sigma^2)^(-5/2)
            const float factor = (r2 + 2.5f * core2) * power;
            du += factor * (strength[k].y * dz - strength[k].z * dy);
            dv += factor * (strength[k].z * dx - strength[k].x * dz);
            dw += factor * (strength[k].x * dy - strength[k].y * dx);
            db += strength[k].w * inverse * power;
        }
        u += du, v += dv, w += dw, buoyancy += db;
    }
    /// xyz: velocity in m/s; w: buoyancy in m/s^2
    __host__ __device__ float4 field(float core2) const {
        constexpr float kBiotSavart = float(1 / (4 * kPi)), kDensity = float(15 / (8 * kPi));
        return make_float4(kBiotSavart * u, kBiotSavart * v, kBiotSavart * w,
                           kDensity * core2 * core2 * buoyancy);
    }
};
//! [FieldSum]

//! [direct]
/// One thread per cell: all n vortons.
inline __global__ void field_direct_kernel(float4* field, const float4* position, const float4* strength,
                                           std::uint32_t n, CellGrid grid, float core2) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= grid.cell_count()) return;
    FieldSum sum;
    sum.add(position, strength, n, centre_m(grid, cell_at(grid.size, c)), core2);
    field[c] = sum.field(core2);
}
//! [direct]

//! [neighbours]
/// Adds the vortons of the cells at most `reach` cells away, row by row: a row of cells is one stretch of
/// memory.
inline __host__ __device__ void add_neighbours(FieldSum& sum, const SortedVortons& vortons,
                                               const CellGrid& grid, glm::ivec3 cell, int reach, glm::vec3 x,
                                               float core2) {
    const glm::ivec3 low = glm::max(cell - reach, glm::ivec3(0));  // no wrap-around: the world ends here
    const glm::ivec3 high = glm::min(cell + reach, grid.size - 1);
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y) {
            const std::uint32_t first = vortons.ranges.cell_first[grid::cell_number(grid, {low.x, y, z})];
            const std::uint32_t last = vortons.ranges.cell_last[grid::cell_number(grid, {high.x, y, z})];
            sum.add(vortons.position + first, vortons.strength + first, last - first, x, core2);
        }
}

/// One thread per cell: the thesis's sum, own and neighbouring cells. What is farther away is dropped.
inline __global__ void field_neighbours_kernel(float4* field, SortedVortons vortons, CellGrid grid, int reach,
                                               float core2) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= grid.cell_count()) return;
    const glm::ivec3 cell = cell_at(grid.size, c);
    FieldSum sum;
    add_neighbours(sum, vortons, grid, cell, reach, centre_m(grid, cell), core2);
    field[c] = sum.field(core2);
}
//! [neighbours]

//! [Pyramid]
constexpr int kMaxLevels = 12;

/// All vortons of a cell as one, for those who are far away. Level 0 has the grid's cells; each cell of the
/// next level holds up to eight of the one below.
struct Pyramid {
    float4* centroid;  ///< xyz: where the cell's vorticity is centred, m; w: the sum of |alpha|
    float4* strength;  ///< sums of the vortons' strengths
    int levels = 0;
    glm::ivec3 size[kMaxLevels];      ///< cells along each axis
    std::uint32_t first[kMaxLevels];  ///< where the level begins in the two arrays

    /// Levels over a grid: until a level has at most 4 cells along each axis, or `max_levels` are there.
    __host__ void shape(glm::ivec3 grid_size, int max_levels) {
        std::uint32_t next = 0;
        for (levels = 0; levels < std::min(max_levels, kMaxLevels);) {
            size[levels] = grid_size;
            first[levels] = next;
            next += std::uint32_t(grid_size.x) * grid_size.y * grid_size.z;
            ++levels;
            if (glm::max(grid_size.x, glm::max(grid_size.y, grid_size.z)) <= 4) break;
            grid_size = (grid_size + 1) / 2;
        }
    }
    __host__ __device__ std::uint32_t index(int level, int x, int y, int z) const {
        return first[level] + (std::uint32_t(z) * size[level].y + y) * size[level].x + x;
    }
    /// Enough for any grid of so many cells: a grid of one row halves once a level, all others sooner.
    static std::size_t max_entries(std::size_t max_cells) { return 2 * max_cells + 8 * kMaxLevels; }
};
//! [Pyramid]

//! [monopoles]
/// Sums of one cell. The centre is weighted by |alpha|, so that a strong vorton is where it is; the tiny
/// addition gives a cell whose vortons are all without strength a centre as well.
struct Monopole {
    glm::vec3 weighted_m{0}, alpha{0};
    float weight = 0, heat = 0;

    __host__ __device__ void add(glm::vec3 x_m, float w, float4 strength) {
        weighted_m += w * x_m;
        weight += w;
        alpha += xyz(strength);
        heat += strength.w;
    }
    __host__ __device__ void store(float4& centroid, float4& strength, glm::vec3 if_empty_m) const {
        const glm::vec3 x = weight > 0 ? weighted_m / weight : if_empty_m;
        centroid = make_float4(x.x, x.y, x.z, weight);
        strength = make_float4(alpha.x, alpha.y, alpha.z, heat);
    }
};

/// One thread per cell: level 0, from the vortons.
inline __global__ void monopoles_kernel(Pyramid pyramid, SortedVortons vortons, CellGrid grid) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= grid.cell_count()) return;
    Monopole sum;
    for (std::uint32_t k = vortons.ranges.cell_first[c]; k < vortons.ranges.cell_last[c]; ++k)
        sum.add(xyz(vortons.position[k]), glm::length(xyz(vortons.strength[k])) + 1e-20f,
                vortons.strength[k]);
    sum.store(pyramid.centroid[c], pyramid.strength[c], centre_m(grid, cell_at(grid.size, c)));
}

/// One thread per cell of a coarser level: from its up to eight children.
inline __global__ void coarsen_kernel(Pyramid pyramid, int level) {
    const glm::ivec3 size = pyramid.size[level], finer = pyramid.size[level - 1];
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= std::uint32_t(size.x) * size.y * size.z) return;
    const glm::ivec3 cell = cell_at(size, c), end = glm::min(2 * cell + 2, finer);
    Monopole sum;
    for (int z = 2 * cell.z; z < end.z; ++z)
        for (int y = 2 * cell.y; y < end.y; ++y)
            for (int x = 2 * cell.x; x < end.x; ++x) {
                const std::uint32_t child = pyramid.index(level - 1, x, y, z);
                sum.add(xyz(pyramid.centroid[child]), pyramid.centroid[child].w, pyramid.strength[child]);
            }
    const std::uint32_t own = pyramid.first[level] + c;
    sum.store(pyramid.centroid[own], pyramid.strength[own], glm::vec3(0));  // empty: strength 0, so anywhere
}
//! [monopoles]

//! [FieldOfEight]
/// The sums of eight points at once. Each source is read once for all of them; a GPU keeps the sums in
/// registers, a CPU in the eight lanes of a vector.
struct FieldOfEight {
    static constexpr int kPoints = 8;
    float x[kPoints], y[kPoints], z[kPoints];  // the points
    float u[kPoints] = {}, v[kPoints] = {}, w[kPoints] = {}, buoyancy[kPoints] = {};

    /// Adds one source. `part` of it, 0 or 1, goes to each point.
    __host__ __device__ void add(float4 position, float4 strength, const float* part, float core2) {
#pragma omp simd
        for (int k = 0; k < kPoints; ++k) {
            const float dx = x[k] - position.x, dy = y[k] - position.y, dz = z[k] - position.z;
            const float r2 = dx * dx + dy * dy + dz * dz;
            const float inverse = 1.0f / (r2 + core2);
            const float power = part[k] * inverse * inverse * std::sqrt(inverse);
            const float factor = (r2 + 2.5f * core2) * power;
            u[k] += factor * (strength.y * dz - strength.z * dy);
            v[k] += factor * (strength.z * dx - strength.x * dz);
            w[k] += factor * (strength.x * dy - strength.y * dx);
            buoyancy[k] += strength.w * inverse * power;
        }
    }
    __host__ __device__ FieldSum of(int k) const {
        return {u[k], v[k], w[k], buoyancy[k]};
    }
};
//! [FieldOfEight]

//! [pyramid_sum]
/// One thread per block of 2 x 2 x 2 cells, since what is far from one of them is far from all: near vortons
/// one by one, all others as cells that are the larger the farther away they are. On each level a cell takes
/// those cells that its parent's neighbourhood covers and its own does not; on the top level all beyond its
/// own. Each vorton is counted once.
inline __global__ void field_pyramid_kernel(float4* field, SortedVortons vortons, Pyramid pyramid,
                                            CellGrid grid, int reach, float core2) {
    const std::uint32_t b = blockIdx.x * blockDim.x + threadIdx.x;
    const glm::ivec3 blocks = (grid.size + 1) / 2;
    if (b >= std::uint32_t(blocks.x) * blocks.y * blocks.z) return;
    glm::ivec3 own = cell_at(blocks, b);  // the block's place, on level 1; later its ancestors'
    const glm::ivec3 corner = 2 * own;
    const auto cell_of_point = [&](int k) { return corner + glm::ivec3(k & 1, k >> 1 & 1, k >> 2); };
    FieldOfEight sum;
    for (int k = 0; k < FieldOfEight::kPoints; ++k) {
        const glm::vec3 x = centre_m(grid, cell_of_point(k));
        sum.x[k] = x.x, sum.y[k] = x.y, sum.z[k] = x.z;
    }

    // The cells of level 0: near for some of the eight, far for the others.
    glm::ivec3 low(0), high = grid.size - 1;
    if (pyramid.levels > 1) {
        low = glm::max(2 * (own - reach), low);
        high = glm::min(2 * (own + reach) + 1, high);
    }
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                float near[FieldOfEight::kPoints], far[FieldOfEight::kPoints];
                int near_points = 0;
                for (int k = 0; k < FieldOfEight::kPoints; ++k) {
                    const glm::ivec3 d = glm::abs(cell_of_point(k) - glm::ivec3(x, y, z));
                    const bool is_near = d.x <= reach && d.y <= reach && d.z <= reach;
                    near[k] = is_near ? 1.0f : 0.0f, far[k] = is_near ? 0.0f : 1.0f;
                    near_points += is_near;
                }
                const std::uint32_t c = grid::cell_number(grid, {x, y, z});
                if (near_points > 0)
                    for (std::uint32_t k = vortons.ranges.cell_first[c]; k < vortons.ranges.cell_last[c]; ++k)
                        sum.add(vortons.position[k], vortons.strength[k], near, core2);
                if (near_points < FieldOfEight::kPoints && pyramid.centroid[c].w > 0)
                    sum.add(pyramid.centroid[c], pyramid.strength[c], far, core2);
            }

    // The levels above.
    const float all[FieldOfEight::kPoints] = {1, 1, 1, 1, 1, 1, 1, 1};
    for (int level = 1; level < pyramid.levels; ++level, own /= 2) {
        low = glm::ivec3(0), high = pyramid.size[level] - 1;
        if (level + 1 < pyramid.levels) {
            low = glm::max(2 * (own / 2 - reach), low);
            high = glm::min(2 * (own / 2 + reach) + 1, high);
        }
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const glm::ivec3 d = glm::abs(own - glm::ivec3(x, y, z));
                    if (d.x <= reach && d.y <= reach && d.z <= reach)
                        continue;  // a lower level has done these
                    const std::uint32_t c = pyramid.index(level, x, y, z);
                    if (pyramid.centroid[c].w > 0)  // empty cells are many
                        sum.add(pyramid.centroid[c], pyramid.strength[c], all, core2);
                }
    }
    for (int k = 0; k < FieldOfEight::kPoints; ++k) {
        const glm::ivec3 cell = cell_of_point(k);
        if (cell.x < grid.size.x && cell.y < grid.size.y && cell.z < grid.size.z)  // sizes may be odd
            field[grid::cell_number(grid, cell)] = sum.of(k).field(core2);
    }
}
//! [pyramid_sum]

}  // namespace vortex
