/// @file
/// The largest stable time step of springs with dashpots, and the damping that a bounce asks for.
#pragma once
#include <cmath>

#include "09_water_spring_mass/contact.cuh"

namespace spring_mass {

//! [restitution]
/// gamma_n such that two marbles part with `restitution` times the speed they met with.
/// For this force law, whose dashpot may pull towards the end of a contact:
/// e = exp(-pi zeta / sqrt(1 - zeta^2)), with zeta = gamma_n / (2 omega) and omega^2 = k / m_eff.
/// @param restitution  above 0, at most 1
inline float damping_for_restitution(float restitution, float stiffness_N_per_m, float mass_kg) {
    const double log_e = std::log(double(restitution));
    const double zeta = -log_e / std::sqrt(3.14159265358979 * 3.14159265358979 + log_e * log_e);
    return float(2 * zeta * std::sqrt(double(stiffness_N_per_m) / (0.5 * mass_kg)));
}
//! [restitution]

//! [limit]
/// Largest stable step of leapfrog for an oscillator of frequency omega whose dashpot takes `damping_per_s`
/// of the velocity. The dashpot sees the velocity of half a step before, so damping shortens the step:
/// (omega dt)^2 + 2 damping dt < 4.
inline double oscillator_limit_s(double omega_per_s, double damping_per_s) {
    const double w2 = omega_per_s * omega_per_s;
    return w2 > 0 ? (std::sqrt(damping_per_s * damping_per_s + 4 * w2) - damping_per_s) / w2
                  : 2 / damping_per_s;
}

/// How marbles are packed decides how hard they hold each other: the highest frequency, squared, in units of
/// k / m, from the contacts' directions.
enum class Packing { pair, chain, cubic, fcc };

inline double omega_squared_m_per_k(Packing packing) {
    switch (packing) {
        case Packing::pair:
            return 2;         // the two against each other: k / m_eff
        case Packing::chain:  // neighbours in opposite motion
        case Packing::cubic:
            return 4;
        case Packing::fcc:
            return 8;  // twelve neighbours; nothing packs more densely
    }
    return 8;
}

/// Largest stable step for marbles packed that way. Dashpots between marbles add up as springs do: normal
/// ones are in line with the springs, tangential ones across (in the densest packing at most 6 gamma_t).
inline double time_step_limit_s(const MaterialOf<double>& material, Packing packing = Packing::fcc) {
    const double contacts = omega_squared_m_per_k(packing);
    const double omega =
        std::sqrt(contacts * (material.stiffness_N_per_m + material.attraction_N_per_m) / material.mass_kg);
    const double damping = 0.5 * contacts * material.normal_damping_per_s +
                           (packing == Packing::fcc ? 6 : 0) * material.tangential_damping_per_s;
    return oscillator_limit_s(omega, damping);
}
//! [limit]

inline MaterialOf<double> in_double(const Material& m) {
    return {m.diameter_m,
            m.mass_kg,
            m.stiffness_N_per_m,
            m.normal_damping_per_s,
            m.tangential_damping_per_s,
            m.friction,
            m.attraction_N_per_m,
            m.drag_per_s,
            glm::dvec3(m.gravity_m_per_s2)};
}
inline float time_step_limit_s(const Material& material, Packing packing = Packing::fcc) {
    return float(time_step_limit_s(in_double(material), packing));
}

}  // namespace spring_mass
