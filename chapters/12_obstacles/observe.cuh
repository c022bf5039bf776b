/// @file
/// Looking at particles and obstacles from outside: momentum, and whether anything is where it cannot be.
#pragma once
#include <algorithm>
#include <cmath>

#include "12_obstacles/obstacle_set.cuh"

namespace obstacles {

struct Observation {
    glm::dvec3 momentum_kg_m_per_s{0};  ///< of all particles
    double fastest_m_per_s = 0;
    std::uint32_t inside = 0;  ///< particles whose centres are nearer to an obstacle than the gap...
    double deepest_m = 0;      ///< ...and the most that one lacks
};

/// On the host, in double: for a table, not for every step.
inline Observation observe(const float4* position, const float4* velocity, std::uint32_t n, double mass_kg,
                           const ObstacleSet& obstacles) {
    std::vector<float4> x(n), v(n);
    if (n > 0) {
        CUDA_CHECK(cudaMemcpy(x.data(), position, n * sizeof(float4), cudaMemcpyDeviceToHost));
        CUDA_CHECK(cudaMemcpy(v.data(), velocity, n * sizeof(float4), cudaMemcpyDeviceToHost));
    }
    Observation seen;
    for (std::uint32_t i = 0; i < n; ++i) {
        const glm::dvec3 u = grid::xyz(v[i]);
        seen.momentum_kg_m_per_s += mass_kg * u;
        seen.fastest_m_per_s = std::max(seen.fastest_m_per_s, glm::length(u));
        for (int k = 0; k < obstacles.size(); ++k) {
            const Moving& o = obstacles.now().obstacle[k];
            const double depth_m = -signed_distance(o.solid, grid::xyz(x[i]) - o.to_m);
            // What fp32 leaves of a particle that lies on the surface is no depth.
            if (depth_m > 1e-6 * glm::length(o.to_m) + 1e-5 * o.solid.half_size_m.x) ++seen.inside;
            seen.deepest_m = std::max(seen.deepest_m, depth_m);
        }
    }
    return seen;
}

}  // namespace obstacles
