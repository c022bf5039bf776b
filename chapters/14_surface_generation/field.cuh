/// @file
/// The field at the nodes of the bricks, three ways. All are 0 where nothing is near, so that a brick that
/// does not exist and a brick full of zeros are the same, and grow towards the inside.
#pragma once
#include <cuda_runtime.h>

#include "14_surface_generation/blobs.cuh"
#include "14_surface_generation/bricks.cuh"
#include "14_surface_generation/settings.h"

namespace surface {

/// What the sums need. Lengths in m.
struct FieldShape {
    float radius_m = 1;   ///< of a round blob
    float volume_m3 = 1;  ///< of a particle
    float reach_m = 1;    ///< no blob reaches farther
};

/// A row of eight nodes while it is summed up.
struct FieldRow {
    float sum[kBrick] = {}, x[kBrick] = {}, y[kBrick] = {}, z[kBrick] = {};
};

//! [add_blob]
/// Adds one blob to the eight nodes of a row, the first of them at `d` from the blob: a loop that a compiler
/// can do for all eight at once.
template <FieldKind kKind>
inline __host__ __device__ void add_blob(FieldRow& row, glm::vec3 d, float spacing_m, const Stretch& m,
                                         float per_radius_squared) {
    if constexpr (kKind == FieldKind::anisotropic) {
        // q^2 = xx x^2 + 2 b x + c along the row. Where it is least it is c - b^2 / xx.
        const float b = m.xy * d.y + m.xz * d.z;
        const float c = m.yy * d.y * d.y + 2 * m.yz * d.y * d.z + m.zz * d.z * d.z;
        if (c * m.xx - b * b >= m.xx) return;
#pragma omp simd
        for (int i = 0; i < kBrick; ++i) {
            const float x = d.x + float(i) * spacing_m, q2 = (m.xx * x + 2 * b) * x + c;
            const float inside = q2 < 1 ? 1 - q2 : 0.0f;
            row.sum[i] += m.height * inside * inside * inside;
        }
    } else {
        const float across = (d.y * d.y + d.z * d.z) * per_radius_squared;
#pragma omp simd
        for (int i = 0; i < kBrick; ++i) {
            const float x = d.x + float(i) * spacing_m, q2 = x * x * per_radius_squared + across;
            const float inside = q2 < 1 ? 1 - q2 : 0.0f, w = inside * inside * inside;
            row.sum[i] += w;
            if constexpr (kKind == FieldKind::zhu_bridson) {
                row.x[i] += w * x;
                row.y[i] += w * d.y;
                row.z[i] += w * d.z;
            }
        }
    }
}
//! [add_blob]

//! [finish]
/// From sums to the field at node i of the row.
template <FieldKind kKind>
inline __host__ __device__ float field_at(const FieldRow& row, int i, const FieldShape& shape) {
    if constexpr (kKind == FieldKind::zhu_bridson) {
        if (!(row.sum[i] > 0)) return 0;
        // The mean is never farther away than the farthest blob, so this is never negative.
        const float far_m = std::sqrt(row.x[i] * row.x[i] + row.y[i] * row.y[i] + row.z[i] * row.z[i]);
        const float field = 1 - far_m / (row.sum[i] * shape.radius_m);
        return field > 0 ? field : 0.0f;
    } else {
        constexpr float kPoly6 = 1.5666815f;  // 315 / (64 pi): W's integral is 1
        const float radius = shape.radius_m;
        return row.sum[i] * (kPoly6 * shape.volume_m3 / (radius * radius * radius));
    }
}
//! [finish]

//! [field_kernel]
/// One block per brick, one thread per row of eight nodes. It walks over the cells that may hold a blob in
/// reach, eight sums at a time in registers. Most blobs there touch no node of the row: those are left early.
/// @param blob, stretch  sorted by cell; stretch is for the anisotropic field alone
template <FieldKind kKind>
__global__ void field_kernel(float* field, const int4* corner, const float4* blob, const Stretch* stretch,
                             CellRanges ranges, CellGrid cells, Lattice lattice, FieldShape shape) {
    const int4 first_node = corner[blockIdx.x];
    const int y = int(threadIdx.x) % kBrick, z = int(threadIdx.x) / kBrick;
    const glm::vec3 start = lattice.place_m(glm::vec3(first_node.x, first_node.y + y, first_node.z + z));
    const float h = lattice.spacing_m, per_radius_squared = 1 / (shape.radius_m * shape.radius_m);
    // A hair more than the reach: the sums below round, too.
    const glm::vec3 reach(1.0001f * shape.reach_m);
    const glm::ivec3 low = grid::cell_of(cells, start - reach);
    const glm::ivec3 high = grid::cell_of(cells, start + reach + glm::vec3((kBrick - 1) * h, 0, 0));
    FieldRow row;
    for (int cell_z = low.z; cell_z <= high.z; ++cell_z)
        for (int cell_y = low.y; cell_y <= high.y; ++cell_y) {
            const std::uint32_t begin = ranges.cell_first[grid::cell_number(cells, {low.x, cell_y, cell_z})];
            const std::uint32_t end = ranges.cell_last[grid::cell_number(cells, {high.x, cell_y, cell_z})];
            for (std::uint32_t k = begin; k < end; ++k) {
                const float4 b = blob[k];
                const glm::vec3 d = start - grid::xyz(b);
                if (d.y * d.y + d.z * d.z >= b.w * b.w) continue;  // passes the row at a distance
                Stretch m{};
                if constexpr (kKind == FieldKind::anisotropic) m = stretch[k];
                add_blob<kKind>(row, d, h, m, per_radius_squared);
            }
        }
    float* mine = field + blockIdx.x * std::size_t(kBrickNodes) + threadIdx.x * kBrick;
    for (int i = 0; i < kBrick; ++i) mine[i] = field_at<kKind>(row, i, shape);
}
//! [field_kernel]

}  // namespace surface
