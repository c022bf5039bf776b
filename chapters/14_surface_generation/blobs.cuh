/// @file
/// Blobs: what each particle adds to the field. For the anisotropic field a blob is an ellipsoid that lies
/// flat where the particles around it do.
#pragma once
#include <cuda_runtime.h>

#include <glm/exponential.hpp>

#include "05_spatial_grid/counting_sort.cuh"
#include "14_surface_generation/eigen.h"

namespace surface {

using grid::CellGrid;
using grid::CellRanges;

/// The quadratic form q^2 = d . M d that is 1 on the blob's rim, and its height's factor.
struct Stretch {
    float xx, yy, zz, xy, xz, yz;  ///< M in 1/m^2
    float height;                  ///< of the blob, relative to a round one: the product of the 1 / stretches
    float unused;
};

/// How blobs are made. Lengths in m.
struct BlobShape {
    float radius_m = 1;           ///< of a round blob
    float neighbour_reach_m = 1;  ///< particles nearer than that say how a blob lies
    float pull = 0.6f;       ///< 0: the blob stays at its particle, 1: it moves to its neighbours' centre
    float flattest = 0.25f;  ///< shortest axis / longest axis
    float longest = 1.15f;   ///< longest axis / radius of a round blob
    float lonely = 0.5f;     ///< radius of a blob with hardly any neighbours, relative to a round one
    float full_ball = 1;     ///< particles within neighbour_reach_m of one deep inside
    float few = 0.22f;       ///< part of a full ball's neighbours that is hardly any
};

//! [stretches]
/// Half axes of the blob relative to a round one: as the spread (the root of the variance) of its neighbours
/// along them. The weight 1 - (r/reach)^3 of Yu and Turk gives particles that fill the whole ball a variance
/// of 0.15 reach^2. (Theirs go with the variance itself: flatter still, and terraces show where layers of
/// particles end.)
constexpr float kFullVariance = 0.15f;

inline __host__ __device__ glm::vec3 stretches(const BlobShape& shape, glm::vec3 variance_m2) {
    const float full = kFullVariance * shape.neighbour_reach_m * shape.neighbour_reach_m;
    const glm::vec3 spread = glm::sqrt(glm::max(variance_m2, glm::vec3(0)) / full);
    const glm::vec3 stretch = glm::min(spread, glm::vec3(shape.longest));
    const float largest = glm::max(stretch.x, glm::max(stretch.y, stretch.z));
    // Particles that sit at one point have no shape: a round blob, and small.
    if (!(largest > shape.lonely)) return glm::vec3(shape.lonely);
    return glm::max(stretch, glm::vec3(shape.flattest * largest));
}
//! [stretches]

//! [make_stretch]
/// M = R diag(1 / axis^2) R^T.
inline __host__ __device__ Stretch make_stretch(const BlobShape& shape, const Eigen& eigen,
                                                glm::vec3 stretch) {
    const glm::vec3 per_axis = 1.0f / (shape.radius_m * stretch);
    const glm::mat3 rows(eigen.vector[0] * per_axis.x, eigen.vector[1] * per_axis.y,
                         eigen.vector[2] * per_axis.z);
    const glm::mat3 m = rows * glm::transpose(rows);
    return {m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2], 1 / (stretch.x * stretch.y * stretch.z), 0};
}
//! [make_stretch]

//! [blob_kernel]
/// One thread per particle, particles sorted by cell. The weighted mean and covariance of its neighbours (Yu
/// and Turk, "Reconstructing surfaces of particle-based fluids using anisotropic kernels", 2013, equations 6,
/// 9 and 10), in coordinates that start at the particle, so that no digits are lost far from the origin.
/// @param blob  out: place of the blob, and in w how far it reaches at most
inline __global__ void blob_kernel(float4* blob, Stretch* stretch, const float4* position, CellRanges ranges,
                                   CellGrid cells, BlobShape shape, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = grid::xyz(position[i]);
    if (!grid::is_finite(x)) {
        blob[i] = position[i];
        return;
    }
    const float per_reach = 1 / shape.neighbour_reach_m;
    float near = 0, sum = 0, sx = 0, sy = 0, sz = 0, sxx = 0, syy = 0, szz = 0, sxy = 0, sxz = 0, syz = 0;
    grid::for_each_row(cells, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
        const std::uint32_t first = ranges.cell_first[first_cell];
        const std::uint32_t count = ranges.cell_last[last_cell] - first;
        const float4* row = position + first;
#pragma omp simd reduction(+ : near, sum, sx, sy, sz, sxx, syy, szz, sxy, sxz, syz)
        for (std::uint32_t k = 0; k < count; ++k) {
            const float dx = row[k].x - x.x, dy = row[k].y - x.y, dz = row[k].z - x.z;
            const float q = sqrtf(dx * dx + dy * dy + dz * dz) * per_reach;
            const float w = q < 1 ? 1 - q * q * q : 0.0f;
            near += q < 1 ? 1.0f : 0.0f;
            sum += w;
            sx += w * dx;
            sy += w * dy;
            sz += w * dz;
            sxx += w * dx * dx;
            syy += w * dy * dy;
            szz += w * dz * dz;
            sxy += w * dx * dy;
            sxz += w * dx * dz;
            syz += w * dy * dz;
        }
    });
    const glm::vec3 mean = glm::vec3(sx, sy, sz) / sum;  // sum >= 1: the particle itself
    Eigen eigen{glm::vec3(0), glm::mat3(1)};
    glm::vec3 axes(shape.lonely);
    if (near > shape.few * shape.full_ball) {
        const float xy = sxy / sum - mean.x * mean.y, xz = sxz / sum - mean.x * mean.z,
                    yz = syz / sum - mean.y * mean.z;
        eigen = eigen_of(glm::mat3(sxx / sum - mean.x * mean.x, xy, xz, xy, syy / sum - mean.y * mean.y, yz,
                                   xz, yz, szz / sum - mean.z * mean.z));
        axes = stretches(shape, eigen.value);
    }
    const glm::vec3 centre = x + shape.pull * mean;
    const float reach = shape.radius_m * glm::max(axes.x, glm::max(axes.y, axes.z));
    blob[i] = make_float4(centre.x, centre.y, centre.z, reach);
    stretch[i] = make_stretch(shape, eigen, axes);
}
//! [blob_kernel]

/// One thread per particle: a round blob where the particle is.
inline __global__ void round_blob_kernel(float4* blob, const float4* position, float radius_m,
                                         std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) blob[i] = make_float4(position[i].x, position[i].y, position[i].z, radius_m);
}

}  // namespace surface
