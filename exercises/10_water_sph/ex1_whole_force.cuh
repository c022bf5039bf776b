// Exercise 10.1: the whole force.
//
// Müller, Charypar and Gross (2003) write the pressure force on a unit of volume around particle i as
//
//     f_i = - sum_j m (p_i + p_j) / (2 rho_j) grad W(x_i - x_j),      a_i = f_i / rho_i      (equation 10)
//
// which is only half of what it should be: measured in water, sound comes out at 0.7 of its speed. Write the
// whole of it, and keep what is right about equation 10: what i gets from j, j gets from i the other way.
#pragma once
#include <glm/geometric.hpp>

#include "10_water_sph/sph.cuh"
#include "common/todo.h"

namespace sph {

// What the pressure between two particles depends on.
struct Pressed {
    glm::vec3 position_m;
    float density_kg_per_m3;
    float pressure_Pa;
};

// Acceleration of particle i by the pressure between it and particle j, in m/s^2. Both have the mass
// fluid.mass_kg.
inline __host__ __device__ glm::vec3 push_on(const Pressed& i, const Pressed& j, const Fluid& fluid) {
    // TODO(10.1): the whole gradient, symmetric in i and j. grad W is that of spiky, from spiky_slope. j can
    // be i itself. About 8 lines.
    (void)i, (void)j, (void)fluid;
    return glm::vec3(course::kTodo);
}

// One thread per particle, particles sorted by cell. The water has no walls here.
inline __global__ void push_kernel(float4* acceleration, const float4* position, const float* density,
                                   grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid,
                                   std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const auto particle = [&](std::uint32_t k) {
        return Pressed{grid::xyz(position[k]), density[k],
                       pressure_of<EquationOfState::linear>(fluid, density[k])};
    };
    const Pressed own = particle(i);
    glm::vec3 a(0);
    grid::for_each_row(cells, own.position_m, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
        for (std::uint32_t j = ranges.cell_first[first_cell]; j < ranges.cell_last[last_cell]; ++j)
            a += push_on(own, particle(j), fluid);
    });
    acceleration[i] = make_float4(a.x, a.y, a.z, 0.0f);
}

}  // namespace sph
