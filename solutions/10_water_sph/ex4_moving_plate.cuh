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
    // <solution>
    return 2.0f * plate_m_per_s - velocity_m_per_s;
    // <stub>
    //| (void)velocity_m_per_s, (void)plate_m_per_s;
    //| return glm::vec3(course::kTodo);
    // </solution>
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
    // <solution>
    const glm::vec3 x = grid::xyz(position[i]), own = grid::xyz(velocity[i]);
    const glm::vec3 upper(upper_m_per_s.x, upper_m_per_s.y, upper_m_per_s.z);
    const float h = fluid.support_m;
    glm::vec3 sum(0);  // of h^5 lap W (v_j - v_i) / rho_j
    for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3 sign) {
        const bool in_plate = sign.y < 0;
        const glm::vec3 plate = image.y > box.high_m.y ? upper : glm::vec3(0);
        const glm::vec3 v = in_plate ? seen_in_plate(own, plate) : own;
        const float back = in_plate ? -1.0f : 1.0f;  // through the plate: what slows the image speeds us up
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            for (std::uint32_t j = ranges.cell_first[first_cell]; j < ranges.cell_last[last_cell]; ++j) {
                const glm::vec3 d = image - grid::xyz(position[j]);
                const float weight = viscosity_laplacian(glm::length(d) / h) / density[j];
                sum += back * weight * (grid::xyz(velocity[j]) - v);
            }
        });
    });
    const glm::vec3 a = fluid.viscosity_m2_per_s * fluid.rest_density_kg_per_m3 * fluid.mass_kg /
                        (h * h * h * h * h) / density[i] * sum;
    acceleration[i] = make_float4(a.x, a.y, a.z, 0);
    // <stub>
    //| (void)position, (void)velocity, (void)density, (void)ranges, (void)cells, (void)fluid, (void)box;
    //| (void)upper_m_per_s;
    //| acceleration[i] = make_float4(course::kTodo, course::kTodo, course::kTodo, course::kTodo);
    // </solution>
}

}  // namespace sph
