/// @file
/// A fire of particles that do not know each other: how they are born, live, and die. One thread per
/// particle.
///
/// State, also what later fires keep, and what fire_renderer.h draws:
/// - position: float4, xyz in metres, w the age in seconds (below 0: waits to be born; life or more: dead)
/// - velocity: float4, xyz in m/s, w the life in seconds that this particle was given
/// - generation: one uint32_t, how often it has been born again
///
/// Everything random about a life is a function of (seed, id, generation).
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>

#include "03_first_kernels/first_kernels.cuh"
#include "07_fire_particles/drag_step.h"
#include "07_fire_particles/wind.h"
#include "common/cuda_check.h"

namespace fire {

using particle_loop::Uniforms;

/// Where particles are born.
struct Emitter {
    enum Shape { point, disc, ring, line } shape = disc;
    glm::vec3 centre_m{0};
    glm::vec3 axis{0, 1, 0};  ///< length 1: stands on the disc or ring; the line's direction
    float size_m = 0.05f;     ///< radius, or half the line's length
    int roots = 0;            ///< discs and lines: so many small discs spread over it; 0: all of it
    float root_m = 0;         ///< radius of these small discs
};

/// One kind of particle: flame, smoke, sparks. A plain struct; the kernel gets a copy.
struct ParticleKind {
    std::uint32_t first = 0, count = 0;  ///< its particles: ids first ... first + count - 1
    Emitter emitter;
    glm::vec3 velocity_m_per_s{0};  ///< at birth...
    float outward_m_per_s = 0;      ///< and away from the emitter's middle, at its edge: hot gas expands
    float spread_m_per_s = 0;       ///< the largest deviation from that on each axis
    float life_s = 1;               ///< mean of the life a particle starts with...
    float life_spread = 0.3f;       ///< ...and its largest relative deviation, below 1
    float decay_spread = 0;         ///< the life is used up at a rate of 1 +- this: below 1
    float edge_life = 1;            ///< particles born at the emitter's edge live this part of it
    float rest_s = 0;               ///< mean time from a death to the next birth; 0: no rest
    float drag_time_s = 0.1f;       ///< its speed relative to the air falls by the factor e in this time
    float buoyancy_m_per_s2 = 0;    ///< at birth
    float cooling_time_s = 0;       ///< buoyancy falls by the factor e in this time; 0: never
};
constexpr int kMaxKinds = 4;

/// All that the kernel has to know. Kinds lie one after the other, without gaps.
struct Fire {
    int kind_count = 0;
    ParticleKind kind[kMaxKinds];
    Wind wind;
    CurlNoise noise;
    std::uint64_t seed = 1;
};

inline std::uint32_t particle_count(const Fire& fire) {
    std::uint32_t n = 0;
    for (int k = 0; k < fire.kind_count; ++k) n += fire.kind[k].count;
    return n;
}

// ---------------------------------------------------------------------------------------------- one life

//! [random_life]
/// The eight numbers that decide one life: chapter 01's random_start, for host and device.
__host__ __device__ inline Uniforms random_life(std::uint64_t seed, std::uint32_t id,
                                                std::uint32_t generation) {
    const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
    Uniforms r{};
    for (std::uint32_t block = 0; block < 2; ++block) {
        const r123::Philox4x32::ctr_type words = r123::Philox4x32()({{id, generation, block, 0}}, key);
        for (int k = 0; k < 4; ++k) r.u[4 * block + k] = particle_loop::to_unit_interval(words.v[k]);
    }
    return r;
}
//! [random_life]

//! [birthplace]
/// A point of the emitter. @param[out] edge 0 in the middle of what it was born in, 1 at its edge
__host__ __device__ inline glm::vec3 birthplace(const Emitter& emitter, float u, float v, float& edge) {
    edge = 0;
    if (emitter.shape == Emitter::point) return emitter.centre_m;
    const glm::vec3 other = std::abs(emitter.axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(emitter.axis, other)), y = glm::cross(emitter.axis, x);
    constexpr float kTurn = 6.2831853f;
    if (emitter.roots > 0) {  // choose a root, and stretch what is left of u to [0, 1) again
        const float scaled = u * float(emitter.roots), root = std::floor(scaled);
        const float part = (root + 0.5f) / float(emitter.roots);
        edge = std::sqrt(scaled - root);
        const float cosine = std::cos(kTurn * v), sine = std::sin(kTurn * v);
        if (emitter.shape == Emitter::line) {
            // Steps of the golden section, a turn of 1 each: no two gaps next to each other are alike, so
            // that the flames don't stand like the teeth of a comb.
            const float along = 2 * (0.618034f * root - std::floor(0.618034f * root)) - 1;
            return emitter.centre_m + emitter.size_m * along * emitter.axis +
                   emitter.root_m * edge * (cosine * emitter.axis + sine * x);
        }
        const glm::vec3 from_root = emitter.root_m * edge * (cosine * x + sine * y);
        // Like the seeds of a sunflower: turned by the golden angle each, they fill a disc evenly.
        const float away = emitter.size_m * std::sqrt(part), angle = 2.3999632f * root;
        return emitter.centre_m + away * (std::cos(angle) * x + std::sin(angle) * y) + from_root;
    }
    if (emitter.shape == Emitter::line) {
        edge = std::abs(2 * u - 1);
        return emitter.centre_m + emitter.size_m * (2 * u - 1) * emitter.axis;
    }
    // The square root: half the radius holds a quarter of the area.
    edge = emitter.shape == Emitter::disc ? std::sqrt(u) : 1.0f;
    return emitter.centre_m + emitter.size_m * edge * (std::cos(kTurn * v) * x + std::sin(kTurn * v) * y);
}
//! [birthplace]

/// How a life begins, and how long it lasts.
struct Birth {
    glm::vec3 position_m, velocity_m_per_s;
    float life_s;
    float rest_s;  ///< time that passes before
};

//! [birth]
__host__ __device__ inline Birth birth(const ParticleKind& kind, const Uniforms& r) {
    Birth b;
    float edge = 0;
    b.position_m = birthplace(kind.emitter, r.u[0], r.u[1], edge);
    b.velocity_m_per_s =
        kind.velocity_m_per_s + kind.spread_m_per_s * (2.0f * glm::vec3(r.u[2], r.u[3], r.u[4]) - 1.0f);
    if (kind.outward_m_per_s != 0)
        b.velocity_m_per_s +=
            kind.outward_m_per_s / kind.emitter.size_m * (b.position_m - kind.emitter.centre_m);
    // A random amount of life, used up at a random rate.
    const float amount = kind.life_s * (1 + kind.life_spread * (2 * r.u[5] - 1));
    const float rate = 1 + kind.decay_spread * (2 * r.u[6] - 1);
    // Fuel from the middle of a flame is the last to meet air.
    b.life_s = amount / rate * (1 + (kind.edge_life - 1) * edge * edge);
    b.rest_s = kind.rest_s > 0 ? -kind.rest_s * std::log(1 - r.u[7]) : 0.0f;  // 1 - u is never 0
    return b;
}
//! [birth]

/// One particle, as a thread has it in its registers.
struct FlameParticle {
    glm::vec3 position_m, velocity_m_per_s;
    float age_s, life_s;
    std::uint32_t generation;
};

//! [advance]
/// One time step of one particle.
/// @param air  tells the air's velocity in the middle of the step: air(x_m) in m/s
template <class Air>
__host__ __device__ inline void advance_in(const Air& air, const Fire& fire, std::uint32_t id, float dt_s,
                                           FlameParticle& p) {
    int k = 0;
    while (k + 1 < fire.kind_count && id >= fire.kind[k + 1].first) ++k;
    const ParticleKind& kind = fire.kind[k];

    const bool dead = p.age_s >= p.life_s, waits = p.age_s < 0;
    float lived_s = dt_s;  // up to the end of this step: the time that it has to move
    if (dead) {
        // The next life began when the last one ended, or a rest later: not at a multiple of dt.
        ++p.generation;
        const Birth b = birth(kind, random_life(fire.seed, id, p.generation));
        p.age_s -= p.life_s + b.rest_s;
    }
    p.age_s += dt_s;
    if (dead || waits) {
        if (p.age_s < 0) {
            p.life_s = 0;
            return;
        }
        const Birth b = birth(kind, random_life(fire.seed, id, p.generation));
        p.position_m = b.position_m;
        p.velocity_m_per_s = b.velocity_m_per_s;
        p.life_s = b.life_s;
        lived_s = p.age_s;
    }
    Forces<float> forces;
    // The air where the particle will be half way through: second order at the price of the first.
    forces.wind_m_per_s = air(p.position_m + 0.5f * lived_s * p.velocity_m_per_s);
    forces.drag_time_s = kind.drag_time_s;
    forces.cooling_time_s = kind.cooling_time_s;
    forces.buoyancy_m_per_s2 = kind.buoyancy_m_per_s2;
    if (kind.cooling_time_s > 0)
        forces.buoyancy_m_per_s2 *= std::exp(-(p.age_s - lived_s) / kind.cooling_time_s);
    drag_step(forces, lived_s, p.position_m, p.velocity_m_per_s);
}
//! [advance]

/// The same in the air of this chapter.
/// @tparam kCurl whether it has curl noise: without it no sine is computed
template <bool kCurl>
__host__ __device__ inline void advance(const Fire& fire, std::uint32_t id, float time_s, float dt_s,
                                        FlameParticle& p) {
    const float middle_s = time_s + 0.5f * dt_s;
    const auto air = [&](glm::vec3 x_m) {
        glm::vec3 velocity = wind_at(fire.wind, x_m, middle_s);
        if constexpr (kCurl) velocity += curl_noise(fire.noise, x_m, middle_s);
        return velocity;
    };
    advance_in(air, fire, id, dt_s, p);
}

/// Particle `id` before the first step: waits for its first birth, so that a fire grows without a bang.
__host__ __device__ inline FlameParticle unborn(const Fire& fire, std::uint32_t id) {
    int k = 0;
    while (k + 1 < fire.kind_count && id >= fire.kind[k + 1].first) ++k;
    const Uniforms r = random_life(fire.seed, id, 0);
    const Birth b = birth(fire.kind[k], r);
    const float wait_s = fire.kind[k].rest_s > 0 ? b.rest_s : b.life_s * r.u[7];
    return {b.position_m, glm::vec3(0), -wait_s, 0, 0};
}

// ------------------------------------------------------------------------------------------- the kernels

/// The arrays of a fire's state, n elements each.
struct FlameArrays {
    float4* position;
    float4* velocity;
    std::uint32_t* generation;
};
/// Bytes of state a particle has; the first 32 are drawn.
constexpr std::size_t kFlameBytes = 2 * sizeof(float4) + sizeof(std::uint32_t);

//! [kernel]
/// One thread per particle: a step of its life. Nobody looks at anybody else.
template <bool kCurl>
__global__ void flame_step_kernel(FlameArrays a, std::uint32_t n, Fire fire, float time_s, float dt_s) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float4 x = a.position[i], v = a.velocity[i];
    FlameParticle p{{x.x, x.y, x.z}, {v.x, v.y, v.z}, x.w, v.w, a.generation[i]};
    const std::uint32_t generation = p.generation;
    advance<kCurl>(fire, i, time_s, dt_s, p);
    a.position[i] = make_float4(p.position_m.x, p.position_m.y, p.position_m.z, p.age_s);
    a.velocity[i] = make_float4(p.velocity_m_per_s.x, p.velocity_m_per_s.y, p.velocity_m_per_s.z, p.life_s);
    if (p.generation != generation) a.generation[i] = p.generation;  // seldom: saves most of the writes
}
//! [kernel]

/// One thread per particle: all wait for their first birth.
inline __global__ void flame_clear_kernel(FlameArrays a, std::uint32_t n, Fire fire) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const FlameParticle p = unborn(fire, i);
    a.position[i] = make_float4(p.position_m.x, p.position_m.y, p.position_m.z, p.age_s);
    a.velocity[i] = make_float4(0, 0, 0, 0);
    a.generation[i] = 0;
}

/// Prepares arrays of particle_count(fire) elements for the first step. @throws course::CudaError
inline void launch_flame_clear(FlameArrays arrays, const Fire& fire) {
    const std::uint32_t n = particle_count(fire);
    if (n == 0) return;  // a grid of 0 blocks is an error
    flame_clear_kernel<<<first_kernels::blocks_for(n), first_kernels::kThreadsPerBlock>>>(arrays, n, fire);
    CUDA_CHECK(cudaGetLastError());
}

//! [launch]
/// One step, from `time_s` to `time_s + dt_s`: one kernel, whatever the fire is made of.
/// @param curl whether the air has curl noise
inline void launch_flame_step(FlameArrays arrays, const Fire& fire, bool curl, float time_s, float dt_s) {
    const std::uint32_t n = particle_count(fire);
    if (n == 0) return;
    const unsigned blocks = first_kernels::blocks_for(n), threads = first_kernels::kThreadsPerBlock;
    if (curl)
        flame_step_kernel<true><<<blocks, threads>>>(arrays, n, fire, time_s, dt_s);
    else
        flame_step_kernel<false><<<blocks, threads>>>(arrays, n, fire, time_s, dt_s);
    CUDA_CHECK(cudaGetLastError());
}
//! [launch]

}  // namespace fire
