/// @file
/// CPU reference of the two passes: every pair, written to be read, in the precision asked for. The kernels
/// are checked against it in double.
#pragma once
#include <cmath>
#include <vector>

#include "10_water_sph/sph.cuh"

namespace sph {

template <class T>
using Points = std::vector<glm::vec<3, T>>;

/// What a kernel's array holds, in double.
inline Points<double> points_of(const std::vector<float4>& values) {
    Points<double> points;
    for (const float4& value : values) points.push_back(glm::dvec3(grid::xyz(value)));
    return points;
}

template <class T>
T distance(glm::vec<3, T> d) {
    return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

//! [cpu_reference]
/// A particle or one of its mirror images, which is what a wall puts in front of the others.
template <class T>
struct Mirrored {
    std::size_t particle;
    glm::vec<3, T> position_m, velocity_m_per_s;
};

/// All particles with all their images in the box's walls, edges and corners, or beyond its periodic ends: 27
/// for each.
template <class T>
std::vector<Mirrored<T>> with_images(const Points<T>& position, const Points<T>& velocity, const Box& box) {
    const glm::vec<3, T> low(box.low_m.x, box.low_m.y, box.low_m.z),
        high(box.high_m.x, box.high_m.y, box.high_m.z);
    std::vector<Mirrored<T>> all;
    for (std::size_t i = 0; i < position.size(); ++i)
        for (int image = 0; image < 27; ++image) {
            Mirrored<T> m{i, position[i], velocity[i]};
            for (int axis = 0, rest = image; axis < 3; ++axis, rest /= 3) {
                if (rest % 3 == 0) continue;
                const bool at_low = rest % 3 == 1;
                if (box.wall[axis] == Wall::periodic) {
                    m.position_m[axis] += (at_low ? T(-1) : T(1)) * (high[axis] - low[axis]);
                    continue;
                }
                m.position_m[axis] = 2 * (at_low ? low : high)[axis] - m.position_m[axis];
                if (box.wall[axis] == Wall::slip)
                    m.velocity_m_per_s[axis] = -m.velocity_m_per_s[axis];
                else
                    m.velocity_m_per_s = -m.velocity_m_per_s;
            }
            all.push_back(m);
        }
    return all;
}

/// Density of each particle, kg/m^3: kernel sum over all particles and images, itself included.
template <class T>
std::vector<T> density_cpu(const Points<T>& position, const Fluid& fluid, const Box& box) {
    const T h = fluid.support_m;
    const std::vector<Mirrored<T>> others = with_images(position, position, box);
    std::vector<T> density;
    for (const auto& x : position) {
        T sum = 0;
        for (const Mirrored<T>& other : others) {
            const T q = distance(x - other.position_m) / h;
            sum += poly6(q * q);
        }
        density.push_back(T(fluid.mass_kg) * sum / (h * h * h));
    }
    return density;
}

/// Acceleration of each particle, m/s^2, from the densities: pressure, viscosity, gravity.
template <EquationOfState kState, class T>
Points<T> acceleration_cpu(const Points<T>& position, const Points<T>& velocity,
                           const std::vector<T>& density, const Fluid& fluid, const Box& box) {
    const T h = fluid.support_m, m = fluid.mass_kg, rho0 = fluid.rest_density_kg_per_m3,
            nu = fluid.viscosity_m2_per_s;
    std::vector<T> term;  // p / rho^2
    for (T rho : density) term.push_back(pressure_of<kState>(fluid, rho) / (rho * rho));

    const std::vector<Mirrored<T>> others = with_images(position, velocity, box);
    Points<T> acceleration;
    for (std::size_t i = 0; i < position.size(); ++i) {
        glm::vec<3, T> a(fluid.gravity_m_per_s2.x, fluid.gravity_m_per_s2.y, fluid.gravity_m_per_s2.z);
        for (const Mirrored<T>& other : others) {
            const std::size_t j = other.particle;
            const glm::vec<3, T> d = position[i] - other.position_m;
            const T r = distance(d), q = r / h;
            if (!(q < 1)) continue;  // beyond the support
            if (r > 0)               // itself, or one at the very same place: no direction to push in
                a += m * (term[i] + term[j]) * spiky_slope(q) / (h * h * h * h) * (d / r);
            a += nu * rho0 * m / (density[i] * density[j]) * viscosity_laplacian(q) / (h * h * h * h * h) *
                 (other.velocity_m_per_s - velocity[i]);
        }
        acceleration.push_back(a);
    }
    return acceleration;
}
//! [cpu_reference]

//! [energy_of]
/// Energy of motion and of compression, in J. Compressing a kilogram takes the integral of p / rho^2, for the
/// linear equation of state c^2 (ln x + 1 / x - 1) with x = rho / rho0.
inline double energy_of(const Fluid& fluid, const Points<double>& velocity,
                        const std::vector<double>& density) {
    double sum = 0;
    const double c = fluid.sound_speed_m_per_s;
    for (std::size_t i = 0; i < velocity.size(); ++i) {
        const double speed = distance(velocity[i]), x = density[i] / fluid.rest_density_kg_per_m3;
        sum += 0.5 * speed * speed + c * c * (std::log(x) + 1 / x - 1);
    }
    return fluid.mass_kg * sum;
}
//! [energy_of]

// The same for arrays as the kernels have them, in double.
inline std::vector<Mirrored<double>> with_images(const std::vector<float4>& position,
                                                 const std::vector<float4>& velocity, const Box& box) {
    return with_images(points_of(position), points_of(velocity), box);
}

inline std::vector<double> density_cpu(const std::vector<float4>& position, const Fluid& fluid,
                                       const Box& box) {
    return density_cpu(points_of(position), fluid, box);
}

template <EquationOfState kState>
Points<double> acceleration_cpu(const std::vector<float4>& position, const std::vector<float4>& velocity,
                                const std::vector<double>& density, const Fluid& fluid, const Box& box) {
    return acceleration_cpu<kState>(points_of(position), points_of(velocity), density, fluid, box);
}

}  // namespace sph
