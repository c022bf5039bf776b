/// @file
/// The fountain of chapter 01 on the device: one thread per droplet, in three layouts.
///
/// The physics is chapter 01's own: its constexpr functions run in device code (nvcc:
/// --expt-relaxed-constexpr), so host and device cannot drift apart. Its loops over a vector are the CPU
/// reference of the kernels here: `step(std::vector<Particle>&, ...)`, `step(ParticleArrays&, ...)`.
#pragma once
#include <cuda_runtime.h>

#include "01_particle_loop/particle_loop.h"
#include "common/cuda_check.h"

/// Chapter 03: the fountain on the device.
namespace first_kernels {

using particle_loop::Fountain;
using particle_loop::Particle;
using particle_loop::StepPlan;
using particle_loop::Uniforms;

constexpr unsigned kThreadsPerBlock = 256;  // a multiple of the warp size 32; measure others with --block

//! [blocks_for]
/// Blocks that hold at least `n` threads: n / threads, rounded up.
constexpr unsigned blocks_for(std::uint32_t n, unsigned threads_per_block = kThreadsPerBlock) {
    return (n + threads_per_block - 1) / threads_per_block;
}
//! [blocks_for]

//! [random_start_on_device]
/// particle_loop::random_start for device code: Random123 has the same function for both sides.
__device__ inline Uniforms random_start_on_device(std::uint64_t seed, std::uint32_t id,
                                                  std::uint32_t generation) {
    const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
    Uniforms start{};
    for (std::uint32_t block = 0; block < 2; ++block) {
        const r123::Philox4x32::ctr_type words = r123::Philox4x32()({{id, generation, block, 0}}, key);
        for (int k = 0; k < 4; ++k) start.u[4 * block + k] = particle_loop::to_unit_interval(words.v[k]);
    }
    return start;
}
//! [random_start_on_device]

//! [advance]
/// What one thread does with its droplet, wherever the droplet was loaded from.
/// @return the droplet's age in seconds after the step
__device__ inline float advance(const Fountain& fountain, const StepPlan& plan, std::uint32_t id,
                                glm::vec3& position, glm::vec3& velocity, float age_s = 0.0f) {
    if (plan.starts(id))
        return emit(fountain, random_start_on_device(fountain.seed, id, plan.generation), position, velocity);
    move(fountain, position, velocity);
    return age_s + fountain.dt_s;
}
//! [advance]

// ------------------------------------------------------------------------------------------ three layouts

//! [aos_kernel]
/// One thread per droplet, an array of 24-byte structs: the threads of a warp read addresses 24 bytes apart.
__global__ void fountain_step_aos_kernel(Particle* particles, std::uint32_t n, Fountain fountain,
                                         StepPlan plan) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n || plan.waits(i)) return;  // the last block has threads to spare
    Particle p = particles[i];
    advance(fountain, plan, i, p.position_m, p.velocity_m_per_s);
    particles[i] = p;
}
//! [aos_kernel]

/// Six device arrays of n floats: a particle_loop::ParticleArrays as a kernel sees it.
struct ArrayPointers {
    float *x_m, *y_m, *z_m, *vx_m_per_s, *vy_m_per_s, *vz_m_per_s;
};

//! [soa_kernel]
/// The same with six arrays: the 32 threads of a warp read 32 floats that lie side by side, six times.
__global__ void fountain_step_soa_kernel(ArrayPointers a, std::uint32_t n, Fountain fountain, StepPlan plan) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n || plan.waits(i)) return;
    glm::vec3 position{a.x_m[i], a.y_m[i], a.z_m[i]};
    glm::vec3 velocity{a.vx_m_per_s[i], a.vy_m_per_s[i], a.vz_m_per_s[i]};
    advance(fountain, plan, i, position, velocity);
    a.x_m[i] = position.x, a.y_m[i] = position.y, a.z_m[i] = position.z;
    a.vx_m_per_s[i] = velocity.x, a.vy_m_per_s[i] = velocity.y, a.vz_m_per_s[i] = velocity.z;
}
//! [soa_kernel]

//! [float4_kernel]
/// The same with two float4 arrays: 16 bytes a load, and room for the age in position.w (seconds; below
/// zero: not born yet). velocity.w is 0.
__global__ void fountain_step_float4_kernel(float4* position, float4* velocity, std::uint32_t n,
                                            Fountain fountain, StepPlan plan) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n || plan.waits(i)) return;
    const float4 p = position[i], v = velocity[i];
    glm::vec3 x{p.x, p.y, p.z}, u{v.x, v.y, v.z};
    const float age_s = advance(fountain, plan, i, x, u, p.w);
    position[i] = make_float4(x.x, x.y, x.z, age_s);
    velocity[i] = make_float4(u.x, u.y, u.z, 0.0f);
}
//! [float4_kernel]

/// One thread per droplet: nobody is born yet. Waiting droplets lie below the floor with age -1.
__global__ void fountain_clear_kernel(float4* position, float4* velocity, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    position[i] = make_float4(0.0f, -1.0f, 0.0f, -1.0f);
    velocity[i] = make_float4(0.0f, 0.0f, 0.0f, 0.0f);
}

// ----------------------------------------------------------------------------------------------- launchers

/// Prepares two float4 arrays of n elements for step 0. @throws course::CudaError
inline void launch_fountain_clear(float4* position, float4* velocity, std::uint32_t n) {
    if (n == 0) return;  // a grid of 0 blocks is an error
    fountain_clear_kernel<<<blocks_for(n), kThreadsPerBlock>>>(position, velocity, n);
    CUDA_CHECK(cudaGetLastError());
}

//! [launch]
/// Step number `step_index` (0, 1, 2, ...) of the fountain in two float4 arrays of n elements: xyz and age;
/// velocity. Clear them first. @throws course::CudaError
inline void launch_fountain_step(float4* position, float4* velocity, std::uint32_t n,
                                 const Fountain& fountain, std::uint32_t step_index,
                                 unsigned threads_per_block = kThreadsPerBlock) {
    if (n == 0) return;  // a grid of 0 blocks is an error
    fountain_step_float4_kernel<<<blocks_for(n, threads_per_block), threads_per_block>>>(
        position, velocity, n, fountain, plan_step(fountain, n, step_index));
    CUDA_CHECK(cudaGetLastError());  // a launch returns nothing: ask at once whether it was accepted
}
//! [launch]

inline void launch_fountain_step(Particle* particles, std::uint32_t n, const Fountain& fountain,
                                 std::uint32_t step_index, unsigned threads_per_block = kThreadsPerBlock) {
    if (n == 0) return;
    fountain_step_aos_kernel<<<blocks_for(n, threads_per_block), threads_per_block>>>(
        particles, n, fountain, plan_step(fountain, n, step_index));
    CUDA_CHECK(cudaGetLastError());
}

inline void launch_fountain_step(const ArrayPointers& arrays, std::uint32_t n, const Fountain& fountain,
                                 std::uint32_t step_index, unsigned threads_per_block = kThreadsPerBlock) {
    if (n == 0) return;
    fountain_step_soa_kernel<<<blocks_for(n, threads_per_block), threads_per_block>>>(
        arrays, n, fountain, plan_step(fountain, n, step_index));
    CUDA_CHECK(cudaGetLastError());
}

}  // namespace first_kernels
