/// @file
/// CPU reference: every pair, in double, one loop after the other. Slow, and easy to believe.
#pragma once
#include <vector>

#include "09_water_spring_mass/contact.cuh"

namespace spring_mass {

/// Marbles as the reference keeps them: in the order they were given.
struct MarblesCpu {
    MaterialOf<double> material;
    glm::dvec3 low_m, high_m;  ///< of the box; infinite where there is no wall
    std::vector<glm::dvec3> position, velocity;
    std::vector<glm::dvec3> force_N = {};  ///< of contacts and gravity, after forces()
};

//! [forces_cpu]
/// Forces with these velocities, by looking at all pairs.
template <bool kShear = true, bool kAttraction = true>
void forces_cpu(MarblesCpu& marbles, const std::vector<glm::dvec3>& velocity) {
    const MaterialOf<double>& material = marbles.material;
    const std::vector<glm::dvec3>& x = marbles.position;
    marbles.force_N.assign(x.size(), material.mass_kg * material.gravity_m_per_s2);
    for (std::size_t i = 0; i < x.size(); ++i) {
        marbles.force_N[i] += wall_force<kShear>(material, marbles.low_m, marbles.high_m, x[i], velocity[i]);
        for (std::size_t j = i + 1; j < x.size(); ++j) {
            const glm::dvec3 apart = x[i] - x[j];
            if (!(glm::dot(apart, apart) < material.diameter_m * material.diameter_m)) continue;
            const glm::dvec3 force =
                pair_force<kShear, kAttraction>(material, apart, velocity[i] - velocity[j], true);
            marbles.force_N[i] += force;
            marbles.force_N[j] -= force;  // action and reaction
        }
    }
}
//! [forces_cpu]

//! [step_cpu]
/// One leapfrog step, kick, drift, kick: forces see the velocity in the middle of the step.
/// @pre forces of the present state are in force_N
inline void step_cpu(MarblesCpu& marbles, double dt_s) {
    const double half_s = 0.5 * dt_s, drag = marbles.material.drag_per_s;
    for (std::size_t i = 0; i < marbles.position.size(); ++i) {
        glm::dvec3& v = marbles.velocity[i];
        v += half_s * (marbles.force_N[i] / marbles.material.mass_kg - drag * v);
        marbles.position[i] += dt_s * v;
    }
    forces_cpu(marbles, marbles.velocity);
    for (std::size_t i = 0; i < marbles.position.size(); ++i) {
        glm::dvec3& v = marbles.velocity[i];
        v = (v + half_s * marbles.force_N[i] / marbles.material.mass_kg) / (1 + half_s * drag);
    }
}
//! [step_cpu]

}  // namespace spring_mass
