/// @file
/// Detail finer than the cells: the place at which the grid is read is shifted to and fro by rising
/// turbulence.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "01_particle_loop/particle_loop.h"
#include "08_fire_vortex/trilinear.cuh"

namespace volume {

constexpr int kDetailSize = 32;  ///< points of the noise table on each axis, after which it repeats

/// Shifts of up to reach_m. reach_m 0: there is no detail, and no kernel has the code for it.
struct Detail {
    const float4* table = nullptr;  ///< kDetailSize^3 random vectors, each component from -1 to 1
    float reach_m = 0;              ///< the largest shift along each axis...
    float full_height_m = 0.1f;     ///< ...from this height on; at y = 0 nothing is shifted
    float length_m = 0.1f;          ///< of the larger eddies; the smaller ones have half of it
    float risen_m = 0;              ///< how far the pattern has gone up
};

inline std::vector<float4> detail_table(std::uint64_t seed) {
    std::vector<float4> table;
    for (std::uint32_t i = 0; i < kDetailSize * kDetailSize * kDetailSize; ++i) {
        const particle_loop::Uniforms r = particle_loop::random_start(seed, i, 0xDE7A11u);
        table.push_back(make_float4(2 * r.u[0] - 1, 2 * r.u[1] - 1, 2 * r.u[2] - 1, 0));
    }
    return table;
}

//! [detail]
/// Smooth between the points of the table, which repeats for ever.
__host__ __device__ inline glm::vec3 detail_noise(const float4* table, glm::vec3 x) {
    const glm::vec3 floor = glm::floor(x), f = x - floor, t = f * f * (3.0f - 2.0f * f);
    const glm::ivec3 cell(floor);
    const auto along_x = [&](int dy, int dz) {
        const int mask = kDetailSize - 1;  // a power of two less 1: wraps negative numbers as well
        const float4* row =
            table + (((cell.z + dz) & mask) * kDetailSize + ((cell.y + dy) & mask)) * kDetailSize;
        return vortex::mix(row[cell.x & mask], row[(cell.x + 1) & mask], t.x);
    };
    return grid::xyz(vortex::mix(vortex::mix(along_x(0, 0), along_x(1, 0), t.y),
                                 vortex::mix(along_x(0, 1), along_x(1, 1), t.y), t.z));
}

/// Where to read the grid instead of at x_m: at most reach_m away along each axis. Eddies are twice as high
/// as wide, as the plume stretches them.
__host__ __device__ inline glm::vec3 shifted(const Detail& detail, glm::vec3 x_m) {
    const glm::vec3 p = glm::vec3(x_m.x, 0.5f * (x_m.y - detail.risen_m), x_m.z) / detail.length_m;
    const glm::vec3 noise =
        (detail_noise(detail.table, p) + 0.5f * detail_noise(detail.table, 2.03f * p)) / 1.5f;
    return x_m + detail.reach_m * glm::clamp(x_m.y / detail.full_height_m, 0.0f, 1.0f) * noise;
}
//! [detail]

}  // namespace volume
