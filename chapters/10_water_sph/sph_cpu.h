/// @file
/// CPU reference of the two passes: every pair, in double, written to be read. The kernels are checked
/// against it.
#pragma once
#include <cmath>
#include <vector>

#include "10_water_sph/sph.cuh"

namespace sph {

//! [cpu_reference]
/// A particle or one of its mirror images, which is what a wall puts in front of the others.
struct Mirrored {
    std::size_t particle;
    glm::dvec3 position_m, velocity_m_per_s;
};

/// All particles with all their images in the box's walls, edges and corners: 27 for each.
inline std::vector<Mirrored> with_images(const std::vector<float4>& position,
                                         const std::vector<float4>& velocity, const Box& box) {
    const glm::dvec3 low(box.low_m.x, box.low_m.y, box.low_m.z),
        high(box.high_m.x, box.high_m.y, box.high_m.z);
    std::vector<Mirrored> all;
    for (std::size_t i = 0; i < position.size(); ++i)
        for (int image = 0; image < 27; ++image) {
            Mirrored m{i, glm::dvec3(grid::xyz(position[i])), glm::dvec3(grid::xyz(velocity[i]))};
            for (int axis = 0, rest = image; axis < 3; ++axis, rest /= 3) {
                if (rest % 3 == 0) continue;
                m.position_m[axis] = 2 * (rest % 3 == 1 ? low : high)[axis] - m.position_m[axis];
                m.velocity_m_per_s[axis] = -m.velocity_m_per_s[axis];
            }
            all.push_back(m);
        }
    return all;
}

inline double distance(glm::dvec3 d) {
    return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

/// Density of each particle, kg/m^3: kernel sum over all particles and images, itself included.
inline std::vector<double> density_cpu(const std::vector<float4>& position, const Fluid& fluid,
                                       const Box& box) {
    const double h = fluid.support_m;
    const std::vector<Mirrored> others = with_images(position, position, box);
    std::vector<double> density;
    for (const float4& p : position) {
        double sum = 0;
        for (const Mirrored& other : others) {
            const double q = distance(glm::dvec3(grid::xyz(p)) - other.position_m) / h;
            sum += poly6(q * q);
        }
        density.push_back(fluid.mass_kg * sum / (h * h * h));
    }
    return density;
}

/// Acceleration of each particle, m/s^2, from the densities: pressure, viscosity, gravity.
template <EquationOfState kState>
std::vector<glm::dvec3> acceleration_cpu(const std::vector<float4>& position,
                                         const std::vector<float4>& velocity,
                                         const std::vector<double>& density, const Fluid& fluid,
                                         const Box& box) {
    const double h = fluid.support_m, m = fluid.mass_kg, rho0 = fluid.rest_density_kg_per_m3;
    std::vector<double> term;  // p / rho^2
    for (double rho : density) term.push_back(pressure_of<kState>(fluid, rho) / (rho * rho));

    const std::vector<Mirrored> others = with_images(position, velocity, box);
    std::vector<glm::dvec3> acceleration;
    for (std::size_t i = 0; i < position.size(); ++i) {
        const glm::dvec3 x(grid::xyz(position[i])), v(grid::xyz(velocity[i]));
        glm::dvec3 a(fluid.gravity_m_per_s2.x, fluid.gravity_m_per_s2.y, fluid.gravity_m_per_s2.z);
        for (const Mirrored& other : others) {
            const std::size_t j = other.particle;
            const glm::dvec3 d = x - other.position_m;
            const double r = distance(d), q = r / h;
            if (r > 0)  // itself, or one at the very same place: no direction to push in
                a += m * (term[i] + term[j]) * spiky_slope(q) / (h * h * h * h) * (d / r);
            a += fluid.viscosity_m2_per_s * rho0 * m / (density[i] * density[j]) * viscosity_laplacian(q) /
                 (h * h * h * h * h) * (other.velocity_m_per_s - v);
        }
        acceleration.push_back(a);
    }
    return acceleration;
}
//! [cpu_reference]

}  // namespace sph
