/// @file
/// Particles against moving obstacles: a pass of its own over positions and velocities, which knows nothing
/// of the model that moved them.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "04_parallel_patterns/reduce.cuh"
#include "05_spatial_grid/cell_grid.cuh"
#include "12_obstacles/solid.cuh"

namespace obstacles {

/// What a contact does to the velocity. Neither number ever makes a particle stick.
struct Surface {
    float restitution = 0;  ///< 0: the approach ends; 1: a particle leaves as fast as it came
    float friction = 0;     ///< Coulomb's: the part of the normal impulse that acts against sliding
};

/// One obstacle during one time step, in which it moves straight, as particles do.
struct Moving {
    Solid solid;  ///< where particle *centres* can't be: the obstacle and a gap around it
    Surface surface;
    glm::vec3 from_m{0}, to_m{0};              ///< its middle at the start and the end of the step
    glm::vec3 from_m_per_s{0}, to_m_per_s{0};  ///< its velocity then

    __host__ __device__ glm::vec3 middle_m(float fraction) const {
        return from_m + fraction * (to_m - from_m);
    }
    __host__ __device__ glm::vec3 velocity_m_per_s(float fraction) const {
        return from_m_per_s + fraction * (to_m_per_s - from_m_per_s);
    }
};

constexpr int kMaxObstacles = 4;

/// All that the pass has to know; passed to the kernel by value.
struct Obstacles {
    int count = 0;
    Moving obstacle[kMaxObstacles];
    float dt_s = 0;
    glm::vec3 low_m{-1e30f}, high_m{1e30f};  ///< the tank: nothing is pushed out of it
};

//! [bounce]
/// Velocity after a contact with a surface that moves at u and faces n. Seen from the surface, the velocity
/// along n is reversed and shrinks by the restitution, and the one along the surface shrinks by Coulomb's
/// friction. A particle that is leaving is left alone.
/// @param share  of the whole impulse: 1 where the obstacle is too heavy to feel it
inline __host__ __device__ glm::vec3 bounce(glm::vec3 v, glm::vec3 u, glm::vec3 n, Surface surface,
                                            float share = 1) {
    const glm::vec3 w = v - u;
    const float approach = -glm::dot(w, n);
    if (!(approach > 0)) return v;
    const float push = share * (1 + surface.restitution) * approach;
    v += push * n;
    if (surface.friction > 0) {
        const glm::vec3 sliding = w + approach * n;
        const float speed = glm::length(sliding);
        // At most as much as stops the sliding: friction turns nothing round.
        if (speed > 0) v -= fminf(surface.friction * push / speed, share) * sliding;
    }
    return v;
}
//! [bounce]

/// The first contact of a particle on the straight way that is left of its step.
struct Contact {
    int obstacle = -1;  ///< -1: none
    float fraction = 2;
    glm::vec3 normal{0}, place{0};  ///< place: relative to the obstacle's middle, on its surface
};

//! [first_contact]
/// @param done     fraction of the step that is over at `from`
/// @param from, x  ends of the particle's way
/// @param settled  bit k is set: obstacle k has had its contact
inline __host__ __device__ Contact first_contact(const Obstacles& all, float done, glm::vec3 from,
                                                 glm::vec3 x, glm::vec3 v, unsigned settled = 0) {
    Contact first;
    for (int k = 0; k < all.count; ++k) {
        if (settled >> k & 1) continue;
        const Moving& o = all.obstacle[k];
        // Seen from the obstacle the particle moves straight, too.
        const glm::vec3 start = from - o.middle_m(done), end = x - o.to_m;
        const float depth = signed_distance(o.solid, start);
        Crossing crossing{0, glm::vec3(0)};
        if (depth > 0) {
            if (!find_crossing(o.solid, start, end, crossing)) continue;
        } else {  // it touches already, or an obstacle was put on top of it: out by the shortest way
            crossing.normal = outward(o.solid, start);
            const bool leaves = glm::dot(v - o.velocity_m_per_s(done), crossing.normal) >= 0;
            if (leaves && signed_distance(o.solid, end) >= 0) continue;
        }
        if (crossing.fraction >= first.fraction) continue;
        first = {k, crossing.fraction, crossing.normal, start + crossing.fraction * (end - start)};
        if (depth <= 0) first.place -= depth * crossing.normal;
    }
    return first;
}
//! [first_contact]

constexpr int kMaxBounces = 4;  // of one particle in one step, between two obstacles

//! [resolve]
/// Moves one particle round the obstacles in its way.
/// @param x, v      in: where it would be at the end of the step without them, and the velocity that took it
///                  there. out: where it is, and its velocity.
/// @param moved_s   how long it has moved: dt, or less if it was born during the step
/// @param share     for each obstacle, see bounce()
/// @param on_bounce called with the obstacle and the velocities before and after
template <class OnBounce>
inline __host__ __device__ void resolve(const Obstacles& all, float moved_s, const float* share, glm::vec3& x,
                                        glm::vec3& v, OnBounce on_bounce) {
    float done = 1 - moved_s / all.dt_s;
    glm::vec3 from = x - moved_s * v;
    bool touched = false;
    unsigned settled = 0;
    for (int k = 0; k < kMaxBounces; ++k) {
        const Contact contact = first_contact(all, done, from, x, v, settled);
        if (contact.obstacle < 0) break;
        const Moving& o = all.obstacle[contact.obstacle];
        done += contact.fraction * (1 - done);
        const glm::vec3 before = v;
        v = bounce(v, o.velocity_m_per_s(done), contact.normal, o.surface, share[contact.obstacle]);
        on_bounce(contact.obstacle, before, v);
        from = o.middle_m(done) + contact.place;
        // A light obstacle gives way, but only at the end of the step. Until then the particle does not get
        // ahead of it, and does not hit it again.
        if (share[contact.obstacle] < 1) settled |= 1u << contact.obstacle;
        const float approach = -glm::dot(v - o.velocity_m_per_s(done), contact.normal);
        x = from + (1 - done) * all.dt_s * (v + fmaxf(0.0f, approach) * contact.normal);
        touched = true;
    }
    if (!touched) return;
    // What rounding, a light obstacle's recoil, or too many bounces have left inside.
    for (int k = 0; k < all.count; ++k) {
        const Moving& o = all.obstacle[k];
        const float depth = signed_distance(o.solid, x - o.to_m);
        if (depth < 0) x -= depth * outward(o.solid, x - o.to_m);
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (x[axis] < all.low_m[axis]) x[axis] = all.low_m[axis];
        if (x[axis] > all.high_m[axis]) x[axis] = all.high_m[axis];
    }
}
//! [resolve]

/// How long a particle has moved in this step: all of it...
struct WholeStep {
    float dt_s;
    __host__ __device__ float moved_s(float4) const { return dt_s; }
};
/// ...or since its birth. Flames keep their age in w.
struct SinceBirth {
    float dt_s;
    __host__ __device__ float moved_s(float4 position) const {
        return position.w < dt_s ? fmaxf(position.w, 0.0f) : dt_s;
    }
};

/// What one particle gave an obstacle, or all of them did. In double: differences of two floats are exact.
struct Impulse {
    double x, y, z;  ///< kg m/s
};

/// What the pass needs of obstacles that feel the particles.
struct TwoWay {
    Impulse* impulse;                          ///< n elements for each obstacle
    const std::uint32_t* hits[kMaxObstacles];  ///< how many particles hit it in this step
    float weight[kMaxObstacles];  ///< mass of a particle / mass of the obstacle; 0: too heavy to feel it
    double mass_kg;               ///< of a particle
};

//! [contact_kernel]
/// One thread per particle. Nobody looks at another particle.
/// @tparam Clock    how long each has moved
/// @tparam kTwoWay  obstacles feel it
template <class Clock, bool kTwoWay>
__global__ void contact_kernel(float4* position, float4* velocity, Obstacles all, Clock clock, TwoWay two_way,
                               std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float4 x4 = position[i], v4 = velocity[i];
    glm::vec3 x = grid::xyz(x4), v = grid::xyz(v4);
    float share[kMaxObstacles] = {1, 1, 1, 1};
    bool hit = false;
    if constexpr (kTwoWay) {
        for (int k = 0; k < all.count; ++k) {
            two_way.impulse[k * n + i] = {0, 0, 0};
            if (two_way.weight[k] > 0) share[k] = 1 / (1 + *two_way.hits[k] * two_way.weight[k]);
        }
    }
    resolve(all, clock.moved_s(x4), share, x, v, [&](int k, glm::vec3 before, glm::vec3 after) {
        hit = true;
        if constexpr (kTwoWay) {
            Impulse& sum = two_way.impulse[k * n + i];
            sum.x += two_way.mass_kg * (double(before.x) - after.x);
            sum.y += two_way.mass_kg * (double(before.y) - after.y);
            sum.z += two_way.mass_kg * (double(before.z) - after.z);
        }
    });
    if (!hit) return;  // nearly all: saves most of the writes
    position[i] = make_float4(x.x, x.y, x.z, x4.w);
    velocity[i] = make_float4(v.x, v.y, v.z, v4.w);
}
//! [contact_kernel]

// ---------------------------------------------------------------------------- what the obstacles feel of it

//! [reductions]
/// Chapter 04's tree adds up impulses, always in the same order: a run repeats bit for bit.
struct AddImpulses {
    using Value = Impulse;
    static __host__ __device__ Impulse nothing() { return {0, 0, 0}; }
    static __host__ __device__ Impulse combine(Impulse a, Impulse b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
};

/// The particles as an array of zeros and ones: who hits obstacle k first? None of it is ever stored.
template <class Clock>
struct Hits {
    const float4 *position, *velocity;
    Obstacles all;
    Clock clock;
    int k;

    __host__ __device__ std::uint32_t operator[](std::uint32_t i) const {
        const glm::vec3 x = grid::xyz(position[i]), v = grid::xyz(velocity[i]);
        const float moved_s = clock.moved_s(position[i]);
        return first_contact(all, 1 - moved_s / all.dt_s, x - moved_s * v, x, v).obstacle == k;
    }
};
//! [reductions]

}  // namespace obstacles
