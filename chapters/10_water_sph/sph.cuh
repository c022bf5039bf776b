/// @file
/// Water by smoothed particle hydrodynamics: a density and pressure pass, then a pass for the forces.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "05_spatial_grid/counting_sort.cuh"
#include "05_spatial_grid/lanes.cuh"
#include "10_water_sph/smoothing_kernels.cuh"
#include "10_water_sph/walls.cuh"

/// Chapter 10: water by smoothed particle hydrodynamics.
namespace sph {

/// How pressure follows from density. Both have the same slope, c^2, at the rest density.
enum class EquationOfState {
    linear,  ///< p = c^2 (rho - rho0), Müller et al. 2003
    tait,    ///< p = (rho0 c^2 / 7) ((rho / rho0)^7 - 1), stiffer under compression
};

/// What the water is made of. Constant during a run; passed to the kernels by value.
struct Fluid {
    float support_m = 0.1f;               ///< smoothing kernels end here (h); about 2 particle spacings
    float mass_kg = 0.1f;                 ///< of each particle
    float rest_density_kg_per_m3 = 1000;  ///< rho0
    float sound_speed_m_per_s = 10;  ///< c: the stiffness. Ten times the fastest water keeps rho within 1 %
    float viscosity_m2_per_s = 0;    ///< nu, kinematic
    float3 gravity_m_per_s2 = {0, -9.81f, 0};
    /// Pressure is never below this. 0 for water with a surface: particles that are few, like spray, must not
    /// pull each other together. Far below 0 for sound in a medium without a surface.
    float lowest_pressure_Pa = 0;
};

//! [pressure]
/// Pressure in Pa from density in kg/m^3. T: float in kernels, double in the reference.
template <EquationOfState kState, class T>
inline __host__ __device__ T pressure_of(const Fluid& fluid, T density) {
    const T rho0 = fluid.rest_density_kg_per_m3, c = fluid.sound_speed_m_per_s;
    T pressure;
    if constexpr (kState == EquationOfState::linear) {
        pressure = c * c * (density - rho0);
    } else {
        // ratio^7 - 1 factored, so that at small compression no digits are lost by subtracting 1 from
        // nearly 1.
        const T x = density / rho0, x2 = x * x;
        pressure = rho0 * c * c / T(7) * (x - T(1)) * (T(1) + x * (T(1) + x) * (T(1) + x2 + x2 * x2));
    }
    return pressure > T(fluid.lowest_pressure_Pa) ? pressure : T(fluid.lowest_pressure_Pa);
}
//! [pressure]

//! [density_kernel]
/// One thread per particle, particles sorted by cell, so that a row of cells is one stretch of memory.
/// Density by summation, then the pressure term p / rho^2 that the force pass needs of every neighbour.
template <EquationOfState kState>
__global__ void density_kernel(float* density, float* pressure_term, grid::Columns<const float> position,
                               grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid, Box box,
                               std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = position[i];
    if (!grid::is_finite(x)) {  // it sits in the limbo; the check of the state will report it
        density[i] = pressure_term[i] = x.x - x.x;
        return;
    }
    const float h = fluid.support_m, per_h_squared = 1.0f / (h * h);
    grid::LaneSum<float> sum;  // of h^3 W, the particle itself included
    for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3) {
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::uint32_t first = ranges.cell_first[first_cell];
            const std::uint32_t count = ranges.cell_last[last_cell] - first;
            grid::for_each_in_lanes(first, count, [&](int lane, std::ptrdiff_t k, bool mine) {
                const float dx = image.x - position.x[k], dy = image.y - position.y[k],
                            dz = image.z - position.z[k];
                const float weight = poly6((dx * dx + dy * dy + dz * dz) * per_h_squared);
                sum.lane[lane] += mine ? weight : 0.0f;
            });
        });
    });
    const float rho = fluid.mass_kg * sum.total() / (h * h * h);
    density[i] = rho;
    pressure_term[i] = pressure_of<kState>(fluid, rho) / (rho * rho);
}
//! [density_kernel]

//! [force_kernel]
/// One thread per particle, particles sorted by cell. Acceleration by pressure, gravity and, if the water has
/// any, viscosity. The pair terms are symmetric in i and j, so what one particle gains the other loses:
/// momentum stays.
/// @param velocity  is not read, and need not exist, without viscosity
template <bool kViscous>
__global__ void force_kernel(float4* acceleration, grid::Columns<const float> position,
                             grid::Columns<const float> velocity, const float* density,
                             const float* pressure_term, grid::CellRanges ranges, grid::CellGrid cells,
                             Fluid fluid, Box box, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = position[i];
    if (!grid::is_finite(x)) return;
    const float h = fluid.support_m, per_h = 1.0f / h, own_term = pressure_term[i];
    const float friction = fluid.viscosity_m2_per_s * fluid.rest_density_kg_per_m3 * per_h / density[i];
    glm::vec3 sum(0);  // of both terms, but for the factor they share: mass / h^4
    for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3 sign) {
        const glm::vec3 moves = velocity_sign(box, sign);
        glm::vec3 v(0);
        // The sum goes back through the mirror as a whole; what friction adds is turned so that it fits.
        const glm::vec3 turned = sign * moves;
        if constexpr (kViscous) v = moves * velocity[i];
        grid::LaneSum<float> sum_x, sum_y, sum_z;
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::uint32_t first = ranges.cell_first[first_cell];
            const std::uint32_t count = ranges.cell_last[last_cell] - first;
            grid::for_each_in_lanes(first, count, [&](int lane, std::ptrdiff_t k, bool mine) {
                const float dx = image.x - position.x[k], dy = image.y - position.y[k],
                            dz = image.z - position.z[k];
                const float r = sqrtf(dx * dx + dy * dy + dz * dz), q = r * per_h;
                // The particle itself, and one at the very same place, have no direction: they don't push.
                const float per_r = r > 0.0f ? 1.0f / r : 0.0f;
                const float push = (own_term + pressure_term[k]) * spiky_slope(q) * per_r;
                float ax = push * dx, ay = push * dy, az = push * dz;
                if constexpr (kViscous) {
                    const float drag = friction * viscosity_laplacian(q) / density[k];
                    ax += drag * turned.x * (velocity.x[k] - v.x);
                    ay += drag * turned.y * (velocity.y[k] - v.y);
                    az += drag * turned.z * (velocity.z[k] - v.z);
                }
                sum_x.lane[lane] += mine ? ax : 0.0f;
                sum_y.lane[lane] += mine ? ay : 0.0f;
                sum_z.lane[lane] += mine ? az : 0.0f;
            });
        });
        sum += sign * glm::vec3(sum_x.total(), sum_y.total(), sum_z.total());  // back through the mirror
    });
    const glm::vec3 a = fluid.mass_kg * per_h * per_h * per_h * per_h * sum;
    const float3 g = fluid.gravity_m_per_s2;
    acceleration[i] = make_float4(a.x + g.x, a.y + g.y, a.z + g.z, 0.0f);
}
//! [force_kernel]

//! [kick_drift_kernel]
/// One thread per particle: first half of the leapfrog step, v += dt/2 a, then x += dt v. The box is closed:
/// a particle that would leave it is put back. (The walls' pressure turns nearly all particles back before
/// that.)
inline __global__ void kick_drift_kernel(float4* position, float4* velocity, const float4* acceleration,
                                         float dt_s, Box box, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    glm::vec3 v = grid::xyz(velocity[i]) + 0.5f * dt_s * grid::xyz(acceleration[i]);
    glm::vec3 x = grid::xyz(position[i]) + dt_s * v;
    keep_inside(box, x, v);
    position[i] = make_float4(x.x, x.y, x.z, 0.0f);
    velocity[i] = make_float4(v.x, v.y, v.z, 0.0f);
}
//! [kick_drift_kernel]

//! [kick_kernel]
/// One thread per particle: second half of the leapfrog step, v += dt/2 a, with the acceleration at the new
/// place.
inline __global__ void kick_kernel(float4* velocity, const float4* acceleration, float dt_s,
                                   std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 v = grid::xyz(velocity[i]) + 0.5f * dt_s * grid::xyz(acceleration[i]);
    velocity[i] = make_float4(v.x, v.y, v.z, 0.0f);
}
//! [kick_kernel]

}  // namespace sph
