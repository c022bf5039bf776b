/// @file
/// Studies `time_step` and `energy`: a standing sound wave, moved in large and in small steps.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "10_water_sph/sph_cpu.h"
#include "10_water_sph/study_water.cuh"

namespace sph {

/// A wave along a bar closed by mirrors: u = A sin(pi x / L), half a wavelength of 20 spacings. Neighbours
/// keep their order, so that "where should each particle be?" has an answer at any time, unlike in a splash,
/// where a difference in the last digit has grown to a spacing after some dozen collisions.
struct Wave {
    static constexpr int kLength = 10, kLooks = 6;
    static constexpr double kAmplitude_m = 0.05 * kLatticeSpacing;

    LatticeBox lattice = lattice_box(kLength, 3, 3);  // at rest
    Fluid fluid = lattice_fluid(2);

    explicit Wave(bool viscous) {
        if (viscous) fluid.viscosity_m2_per_s = 0.015f * fluid.support_m * fluid.sound_speed_m_per_s;
    }
    std::vector<float4> displaced() const {
        std::vector<float4> position = lattice.position;
        for (float4& x : position)
            x.x = float(x.x + kAmplitude_m * std::sin(kPi * double(x.x) / lattice.box.high_m.x));
        return position;
    }
    /// Of a wave of 20 spacings. On this lattice it is 0.983 times as fast as sound (README, "Pass two:
    /// forces").
    double period_s() const {
        return 2 * kLength * double(kLatticeSpacing) / (0.98299 * fluid.sound_speed_m_per_s);
    }
    double look_interval_s() const { return period_s() / kLooks; }
};

/// Where all particles are at one look, and how much energy they have: of motion, and of being compressed.
struct WaveState {
    Points<double> position_m;
    double energy_J;
};

//! [wave_reference]
/// The wave in double, by steps of RK4 so small that its error, some 1e-6 of the amplitude, plays no part.
inline std::vector<WaveState> wave_reference(const Wave& wave, int steps_per_look) {
    const double dt = wave.look_interval_s() / steps_per_look;
    Points<double> x = points_of(wave.displaced()), v(x.size(), glm::dvec3(0));
    const auto force = [&](const Points<double>& x_now, const Points<double>& v_now) {
        return acceleration_cpu<EquationOfState::linear>(
            x_now, v_now, density_cpu(x_now, wave.fluid, wave.lattice.box), wave.fluid, wave.lattice.box);
    };
    const auto plus = [](Points<double> a, double factor, const Points<double>& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
        return a;
    };
    std::vector<WaveState> states;
    for (int look = 0; look < Wave::kLooks; ++look) {
        for (int step = 0; step < steps_per_look; ++step) {
            const auto a1 = force(x, v);
            const auto v2 = plus(v, dt / 2, a1), a2 = force(plus(x, dt / 2, v), v2);
            const auto v3 = plus(v, dt / 2, a2), a3 = force(plus(x, dt / 2, v2), v3);
            const auto v4 = plus(v, dt, a3), a4 = force(plus(x, dt, v3), v4);
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i] += dt / 6 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
                v[i] += dt / 6 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
            }
        }
        states.push_back({x, energy_of(wave.fluid, v, density_cpu(x, wave.fluid, wave.lattice.box))});
    }
    return states;
}
//! [wave_reference]

/// What one time step does to the wave. Errors are the largest of all looks.
struct WaveErrors {
    double position = 0;  ///< rms distance from where the particles should be, over the amplitude
    double energy = 0;    ///< difference, over the energy at the start
};

inline WaveErrors run_wave(const Wave& wave, const std::vector<WaveState>& reference, int steps_per_look) {
    const auto start = wave.displaced();
    Water water(wave.fluid, wave.lattice.box, EquationOfState::linear, start, at_rest(start.size()));
    const double start_J = energy_of(wave.fluid, Points<double>(start.size(), glm::dvec3(0)),
                                     density_cpu(start, wave.fluid, wave.lattice.box));
    const float dt_s = float(wave.look_interval_s() / steps_per_look);
    WaveErrors errors;
    for (const WaveState& exact : reference) {
        for (int step = 0; step < steps_per_look; ++step) water.step(dt_s);
        const auto x = points_of(by_id(water, water.positions())),
                   v = points_of(by_id(water, water.velocities()));
        const auto density = by_id(water, water.densities());
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double d = distance(x[i] - exact.position_m[i]);
            sum += d * d;
        }
        const double energy_J = energy_of(wave.fluid, v, std::vector<double>(density.begin(), density.end()));
        errors.position = std::max(errors.position, std::sqrt(sum / double(x.size())) / Wave::kAmplitude_m);
        errors.energy = std::max(errors.energy, std::abs(energy_J - exact.energy_J) / start_J);
    }
    return errors;
}

/// @param error  which of the two errors of a run the study is about
inline void study_wave(course::Study& study, double WaveErrors::*error) {
    course::on_device(study);
    // 2 steps a look are 0.85 h / c, shortly below the lattice's limit; 4 are about the program's own 0.4 h /
    // c.
    const std::vector<int> steps = study.quick ? std::vector<int>{2, 4, 8, 16, 32, 64}
                                               : std::vector<int>{2, 3, 4, 6, 8, 16, 32, 64, 128, 256};
    study.expect(2 * int(steps.size()));
    const std::vector<Wave> waves{Wave(false), Wave(true)};
    std::vector<Water> waters;
    for (const Wave& wave : waves)
        waters.emplace_back(wave.fluid, wave.lattice.box, EquationOfState::linear, wave.displaced(),
                            at_rest(wave.lattice.position.size()));
    const std::vector<course::Timing> per_step = time_steps(waters, study.quick ? 5 : 15);  // whatever dt is
    for (std::size_t w = 0; w < waves.size(); ++w) {
        const auto reference = wave_reference(waves[w], study.quick ? 24 : 48);
        for (const int steps_per_look : steps) {
            const WaveErrors errors = run_wave(waves[w], reference, steps_per_look);
            study.add({w == 0 ? "without viscosity" : "with the scenes' viscosity",
                       waves[w].look_interval_s() / steps_per_look, double(waters[w].size()), errors.*error,
                       per_step[w], double(Wave::kLooks * steps_per_look)});
        }
    }
}

inline void study_time_step(course::Study& study) {
    study_wave(study, &WaveErrors::position);
}

inline void study_energy(course::Study& study) {
    study_wave(study, &WaveErrors::energy);
}

}  // namespace sph
