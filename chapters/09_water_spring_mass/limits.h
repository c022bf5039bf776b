/// @file
/// The largest stable time step of springs with dashpots, and the damping that a bounce asks for.
#pragma once
#include <cmath>
#include <vector>

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

/// How marbles are packed decides how hard they hold each other.
enum class Packing { pair, chain, cubic, fcc };

/// Frequency squared, in k / m, of a wave in the packing whose every contact is pressed along its normal
/// (`springs`), and how much its tangential dashpots add (`sliding`, the same sum across the contacts).
struct StiffestWave {
    double springs, sliding;
};

/// The waves that can break the step: D = sum over contacts of (1 - cos q.d) n n^T, at its largest. In fcc,
/// where twelve neighbours touch and nothing packs more densely, two: the first shakes the springs most, the
/// second the tangential dashpots.
inline std::vector<StiffestWave> stiffest_waves(Packing packing) {
    switch (packing) {
        case Packing::pair:
            return {{2, 0}, {0, 2}};  // along their line, and across it
        case Packing::chain:
            return {{4, 0}, {0, 4}};  // neighbours in opposite motion
        case Packing::cubic:
            return {{4, 8}, {0, 12}};  // all neighbours in opposite motion
        case Packing::fcc:
            break;
    }
    return {{8, 8}, {4, 12}};
}

/// Largest stable step for marbles packed that way. Dashpots add up over contacts as springs do.
inline double time_step_limit_s(const MaterialOf<double>& material, Packing packing = Packing::fcc) {
    const double stiffness = material.stiffness_N_per_m + material.attraction_N_per_m;
    double limit_s = INFINITY;
    for (const StiffestWave& wave : stiffest_waves(packing)) {
        const double omega = std::sqrt(wave.springs * stiffness / material.mass_kg);
        const double damping = 0.5 * (wave.springs * material.normal_damping_per_s +
                                      wave.sliding * material.tangential_damping_per_s);
        limit_s = std::fmin(limit_s, oscillator_limit_s(omega, damping));
    }
    return limit_s;
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
