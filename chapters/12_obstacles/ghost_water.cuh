/// @file
/// What an obstacle is to SPH: a place where neighbours are missing. As if it were full of water, of which
/// nothing but its density and its pressure can be felt.
#pragma once
#include "10_water_sph/water.cuh"
#include "12_obstacles/obstacle_set.cuh"

namespace obstacles {

//! [planes]
/// Part of the poly6 kernel beyond a plane at q supports: the density, relative to that of rest, that a half
/// space of water adds. A slice of (1 - r^2)^3 at z holds pi/4 (1 - z^2)^4; here is its integral. 1/2 at the
/// plane itself, and more than that behind it.
inline __host__ __device__ float poly6_beyond(float q) {
    if (q >= 1) return 0;
    if (q <= -1) return 1;
    const float q2 = q * q;
    const float integral = q * (1 + q2 * (-4.0f / 3 + q2 * (6.0f / 5 + q2 * (-4.0f / 7 + q2 / 9))));
    return 315.0f / 256 * (128.0f / 315 - integral);
}

/// Slice of the spiky kernel at q supports, times h. By Gauss's theorem it is the sum of all the gradients in
/// the half space beyond. It adds up to 1/2 over all q: with the pressure p in both waters, the plane carries
/// exactly p.
inline __host__ __device__ float spiky_slice(float q) {
    const float left = 1 - fabsf(q);
    return left > 0 ? 1.5f * left * left * left * left * (5 - 4 * left) : 0.0f;
}
//! [planes]

/// What the water in an obstacle's place would do to a particle at r.
struct Ghost {
    float density = 0;  ///< to add, over that of rest
    glm::vec3 push{0};  ///< -h times the sum of spiky's gradients
};

//! [ghost_of]
/// @param r  relative to the obstacle's middle
inline __host__ __device__ Ghost ghost_of(const Solid& solid, glm::vec3 r, float h) {
    if (solid.shape == Shape::sphere) {
        const float radius = solid.half_size_m.x, distance = glm::length(r) - radius, q = distance / h;
        if (q >= 1) return {};
        // A sphere curves away from its tangent plane: at a distance s from where they touch by s^2 / 2R.
        // What it lacks of the half space is, to first order in h / R, the slice's second moment over 2R.
        const float inside = 1 - q * q, inside2 = inside * inside;
        const float lacks = 315.0f / 2560 * h / radius * inside2 * inside2 * inside;
        return {fmaxf(0.0f, poly6_beyond(q) - lacks),
                spiky_slice(q) * fmaxf(0.0f, 1 - distance / radius) * outward(solid, r)};
    }
    // A box is what three slabs share. For a kernel that is a product, as a Gaussian is, its part in the box
    // is the product of its parts in the slabs. Poly6 is not far from one.
    glm::vec3 part, slice;
    for (int axis = 0; axis < 3; ++axis) {
        const float near = (fabsf(r[axis]) - solid.half_size_m[axis]) / h;
        const float far = (fabsf(r[axis]) + solid.half_size_m[axis]) / h;
        if (near >= 1) return {};
        part[axis] = poly6_beyond(near) - poly6_beyond(far);
        slice[axis] = (r[axis] < 0 ? -1 : 1) * (spiky_slice(near) - spiky_slice(far));
    }
    return {part.x * part.y * part.z,
            {slice.x * part.y * part.z, slice.y * part.x * part.z, slice.z * part.x * part.y}};
}
//! [ghost_of]

//! [lattice_ghost]
/// Water is a sum over particles, and 30 of them are not quite an integral: a lattice that ends half a
/// spacing before a plane gets less from its continuation beyond it than from a half space. This is the part
/// of it. One per cent of density is as much pressure as 14 cm of this water, so it counts.
/// @param support_in_spacings  support radius / spacing of the lattice
inline double lattice_ghost(double support_in_spacings) {
    const double s = support_in_spacings;
    const int reach = int(s);
    double sum = 0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = 1; z <= reach; ++z) sum += sph::poly6((x * x + y * y + z * z) / (s * s));
    return sum / (s * s * s) / sph::lattice_density(s) / poly6_beyond(float(0.5 / s));
}
//! [lattice_ghost]

/// The pass's parameters, by value.
struct GhostPass {
    Impulse* impulse;  ///< n elements for each obstacle, added to; nullptr if nobody feels it
    float part;        ///< lattice_ghost()
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
    Ghost ghost[kMaxObstacles];
    float added = 0;
    for (int k = 0; k < all.count; ++k) {
        const Moving& o = all.obstacle[k];
        ghost[k] = ghost_of(inflated(o.solid, -pass.gap_m), x - o.to_m, h);
        added += pass.part * rho0 * ghost[k].density;
    }
    if (!(added > 0)) return;  // far from all of them, as most particles are; or not a number
    const float rho = water.density[i] + added;
    const float pressure = sph::pressure_of<kState>(fluid, rho);
    water.density[i] = rho;
    water.pressure_term[i] = pressure / (rho * rho);
    if (!(pressure > 0)) return;  // spray: nothing to push with
    const float4 before = water.velocity[i];
    glm::vec3 v = grid::xyz(before);
    for (int k = 0; k < all.count; ++k) {
        if (!(ghost[k].density > 0)) continue;
        const Moving& o = all.obstacle[k];
        // The ghost lies beyond the surface, where still water has another pressure: by rho g times the
        // height. In an obstacle that speeds up, what the water weighs is g less that acceleration. So the
        // mean of both pressures is the one at the surface.
        const glm::vec3 r = x - o.to_m, out = outward(o.solid, r);
        const glm::vec3 weight =
            glm::vec3(fluid.gravity_m_per_s2.x, fluid.gravity_m_per_s2.y, fluid.gravity_m_per_s2.z) -
            (o.to_m_per_s - o.from_m_per_s) / pass.dt_s;
        const float distance = signed_distance(o.solid, r) + pass.gap_m;
        const float at_surface = fmaxf(0.0f, pressure - rho0 * distance * glm::dot(weight, out));
        // A whole kick at the new place is half a one for this step and half a one for the next: leapfrog.
        const glm::vec3 was = v;
        v += pass.dt_s * rho0 * 2 * at_surface / (rho * rho * h) * ghost[k].push;
        if (!pass.impulse) continue;
        // Particles have been sorted since contact_kernel wrote here: it is the sum that counts.
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
        const float gap_m = obstacles.setting().gap_m;  // half a spacing
        const double part = gap_m > 0 ? lattice_ghost(0.5 * water.fluid().support_m / gap_m) : 1;
        const GhostPass pass{obstacles.impulses(), float(part), gap_m, obstacles.now().dt_s};
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
