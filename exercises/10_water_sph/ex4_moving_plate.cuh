// Exercise 10.4: a plate that moves.
//
// Walls without slip hold the water that touches them: the image of a particle moves the other way, so that
// halfway between the two nothing moves. If the plate itself moves along the water, what is halfway between a
// particle and its image must move with the plate. Honey between a fixed and a moving plate is Couette's
// flow.
//
// Only friction matters there; the kernel computes nothing else.
#pragma once
#include <glm/geometric.hpp>

#include "10_water_sph/sph.cuh"
#include "common/todo.h"

namespace sph {

// Velocity that the image of a particle has behind a plate that holds water and moves along itself.
inline __host__ __device__ glm::vec3 seen_in_plate(glm::vec3 velocity_m_per_s, glm::vec3 plate_m_per_s) {
    // TODO(10.4): their mean is the plate's velocity. 1 line.
    (void)velocity_m_per_s, (void)plate_m_per_s;
    return glm::vec3(course::kTodo);
}

// One thread per particle, particles sorted by cell: acceleration by friction alone,
//
//     a_i = nu rho0 m / rho_i  sum_j (v_j - v_i) lap W_ij / rho_j,
//
// over all neighbours and images. Along x and z the box is periodic: images there move as the particle does.
// The plates are its ends along y; the lower one is at rest, the upper one moves with `upper_m_per_s`.
inline __global__ void plate_friction_kernel(float4* acceleration, const float4* position,
                                             const float4* velocity, const float* density,
                                             grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid,
                                             Box box, float3 upper_m_per_s, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    // TODO(10.4): as force_kernel does it, without pressure: the sum over true neighbours, at each image of
    // x, with the velocity that the image has there. sign.y tells whether it is behind a plate. w is 0.
    // About 20 lines.
    (void)position, (void)velocity, (void)density, (void)ranges, (void)cells, (void)fluid, (void)box;
    (void)upper_m_per_s;
    acceleration[i] = make_float4(course::kTodo, course::kTodo, course::kTodo, course::kTodo);
}

}  // namespace sph
