/// @file
/// What an obstacle is to SPH: a place where neighbours are missing. As if it were full of water, of which
/// nothing but its density and its pressure can be felt.
#pragma once
#include "10_water_sph/water.cuh"
#include "12_obstacles/obstacle_set.cuh"

namespace obstacles {

//! [ghost]
/// Part of the poly6 kernel beyond a plane at distance q supports: the density, relative to that of rest,
/// that a half space of water adds. A slice at z holds pi/4 (1 - z^2)^4 of (1 - q^2)^3; here is its integral.
/// 1/2 at the plane itself.
inline __host__ __device__ float poly6_beyond(float q) {
    if (q >= 1) return 0;
    q = fmaxf(q, 0.0f);
    const float q2 = q * q;
    const float integral = q * (1 + q2 * (-4.0f / 3 + q2 * (6.0f / 5 + q2 * (-4.0f / 7 + q2 / 9))));
    return 315.0f / 256 * (128.0f / 315 - integral);
}

/// Slice of the spiky kernel at distance q supports, times h. By Gauss's theorem it is the pull of all the
/// gradients in the half space beyond. Its integral is 1/2: with the pressure p on both sides, the plane
/// carries exactly p.
inline __host__ __device__ float spiky_slice(float q) {
    const float left = 1 - fmaxf(q, 0.0f);
    return left > 0 ? 1.5f * left * left * left * left * (5 - 4 * left) : 0.0f;
}
//! [ghost]

/// The pass's parameters, by value.
struct GhostPass {
    Impulse* impulse;  ///< n elements for each obstacle, added to; nullptr if nobody feels it
    float gap_m;       ///< by which the obstacles' solids are inflated
    float dt_s;
};

//! [ghost_kernel]
/// One thread per particle, between the density pass and the force pass. Near an obstacle the density gets
/// what its ghost water adds, the pressure follows, and both waters push each other apart with it.
template <sph::EquationOfState kState>
__global__ void ghost_kernel(sph::WaterArrays water, Obstacles all, GhostPass pass, sph::Fluid fluid) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= water.n) return;
    const glm::vec3 x = grid::xyz(water.position[i]);
    const float h = fluid.support_m, rho0 = fluid.rest_density_kg_per_m3;
    float distance[kMaxObstacles], added = 0;
    for (int k = 0; k < all.count; ++k) {
        const Moving& o = all.obstacle[k];
        distance[k] = (signed_distance(o.solid, x - o.to_m) + pass.gap_m) / h;
        added += rho0 * poly6_beyond(distance[k]);
    }
    if (!(added > 0)) return;  // far from all of them, as most particles are; or not a number
    const float rho = water.density[i] + added;
    const float term = sph::pressure_of<kState>(fluid, rho) / (rho * rho);
    water.density[i] = rho;
    water.pressure_term[i] = term;
    const float4 before = water.velocity[i];
    glm::vec3 v = grid::xyz(before);
    for (int k = 0; k < all.count; ++k) {
        if (distance[k] >= 1) continue;
        const Moving& o = all.obstacle[k];
        // A whole kick at the new place is half a one for this step and half a one for the next: leapfrog.
        const float push = pass.dt_s * rho0 * 2 * term * spiky_slice(distance[k]) / h;
        const glm::vec3 was = v;
        v += push * outward(o.solid, x - o.to_m);
        if (!pass.impulse) continue;
        Impulse& sum = pass.impulse[k * water.n + i];
        sum.x += double(fluid.mass_kg) * (double(was.x) - v.x);
        sum.y += double(fluid.mass_kg) * (double(was.y) - v.y);
        sum.z += double(fluid.mass_kg) * (double(was.z) - v.z);
    }
    water.velocity[i] = make_float4(v.x, v.y, v.z, before.w);
}
//! [ghost_kernel]

/// How an obstacle feels to water.
enum class Skin {
    bare,  ///< particles stop at it, and miss the neighbours beyond
    ghost  ///< and feel as much water beyond it as it takes
};

//! [InWater]
/// The obstacles as a guest of chapter 10's water.
struct InWater {
    ObstacleSet& obstacles;
    Skin skin;
    const sph::Water& water;

    void after_drift(sph::WaterArrays a) {
        obstacles.contact(a.position, a.velocity, a.n, WholeStep{obstacles.now().dt_s});
    }
    void after_density(sph::WaterArrays a) {
        if (skin == Skin::bare || obstacles.empty()) return;
        const GhostPass pass{obstacles.impulses(), obstacles.setting().gap_m, obstacles.now().dt_s};
        const std::uint32_t blocks = grid::blocks_for(a.n, ObstacleSet::kThreads);
        if (water.state() == sph::EquationOfState::linear)
            ghost_kernel<sph::EquationOfState::linear>
                <<<blocks, ObstacleSet::kThreads>>>(a, obstacles.now(), pass, water.fluid());
        else
            ghost_kernel<sph::EquationOfState::tait>
                <<<blocks, ObstacleSet::kThreads>>>(a, obstacles.now(), pass, water.fluid());
        CUDA_CHECK(cudaGetLastError());
    }
};

/// One step of water and obstacles.
inline void step(sph::Water& water, ObstacleSet& obstacles, Skin skin) {
    obstacles.move();
    water.step(float(obstacles.setting().dt_s), InWater{obstacles, skin, water});
    obstacles.finish(water.size());
}
//! [InWater]

}  // namespace obstacles
