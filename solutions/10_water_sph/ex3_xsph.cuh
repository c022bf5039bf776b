// Exercise 10.3: XSPH, particles that move with their neighbours.
//
// SPH particles rattle against each other as water does not. Monaghan (1989, quoted from memory) lets each
// one move with a velocity between its own and that of its neighbourhood:
//
//     v'_i = v_i + strength * sum_j m / rho_ij (v_j - v_i) W(x_i - x_j),      rho_ij = (rho_i + rho_j) / 2
//
// With a strength of 0 nothing changes; with 1 hardly anything of a particle's own motion is left. Viscosity
// takes time to calm the rattling, this does it at once, whatever the time step.
#pragma once
#include <glm/geometric.hpp>

#include "10_water_sph/sph.cuh"
#include "common/todo.h"

namespace sph {

// One thread per particle, particles sorted by cell. W is poly6; walls are mirrors, as in the lesson.
// `smoothed` is another array than `velocity`: neighbours are still reading that one.
inline __global__ void smooth_velocity_kernel(float4* smoothed, const float4* position,
                                              const float4* velocity, const float* density,
                                              grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid,
                                              Box box, float strength, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = grid::xyz(position[i]);
    if (!grid::is_finite(x)) {
        smoothed[i] = velocity[i];
        return;
    }
    // TODO(10.3): the sum over all neighbours and all mirrored ones. force_kernel's viscosity shows the way:
    // for_each_image, then for_each_row. w of the result is 0. About 15 lines.
    // <solution>
    const float h = fluid.support_m, per_h_squared = 1.0f / (h * h);
    glm::vec3 sum(0);  // of h^3 W (v_j - v_i) / rho_ij
    for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3 sign) {
        const glm::vec3 v = sign * grid::xyz(velocity[i]);
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            for (std::uint32_t j = ranges.cell_first[first_cell]; j < ranges.cell_last[last_cell]; ++j) {
                const glm::vec3 d = image - grid::xyz(position[j]);
                const float mean_density = 0.5f * (density[i] + density[j]);
                const float weight = poly6(glm::dot(d, d) * per_h_squared) / mean_density;
                sum += sign * weight * (grid::xyz(velocity[j]) - v);  // back through the mirror
            }
        });
    });
    const glm::vec3 v = grid::xyz(velocity[i]) + strength * fluid.mass_kg / (h * h * h) * sum;
    smoothed[i] = make_float4(v.x, v.y, v.z, 0.0f);
    // <stub>
    //| smoothed[i] = make_float4(course::kTodo, course::kTodo, course::kTodo, course::kTodo);
    // </solution>
}

}  // namespace sph
