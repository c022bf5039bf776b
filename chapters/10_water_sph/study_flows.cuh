/// @file
/// Studies `sound_speed`, `poiseuille` and `taylor_green`: flows that are known exactly, in finer and finer
/// water.
#pragma once
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "10_water_sph/flows.cuh"
#include "common/result.h"

namespace sph {

inline void study_sound_speed(course::Study& study) {
    course::on_device(study);
    const std::vector<float> supports{2, 2.6f, 3, 4};
    const std::vector<int> wavelengths =
        study.quick ? std::vector<int>{10, 20, 40} : std::vector<int>{10, 20, 40, 80};
    study.expect(int(supports.size() * wavelengths.size()));
    for (const float support : supports)
        for (const int wavelength : wavelengths) {
            std::vector<double> seconds;
            double speed = 0;
            int steps = 0;
            for (int run = 0; run < 3; ++run) {
                const auto start = std::chrono::steady_clock::now();
                speed = sound_speed(support, wavelength, steps);
                const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
                seconds.push_back(taken.count() / steps);
            }
            const double across = std::ceil(support);
            study.add({"support " + course::format_number(support) + " spacings", double(wavelength),
                       wavelength * across * across, std::abs(speed - 1), course::timing_of(seconds),
                       double(steps)});
        }
}

/// What a lattice of support 2 makes of a viscosity: its sum over neighbours (reference values:
/// tests/data/README.md, lattice_density_error) times rest density / density, since a particle's mass is that
/// of `lattice_density`.
constexpr double kLatticeViscosity = (1 - 0.01188447967909767) / (1 + 0.009775166894684828);

//! [study_poiseuille]
/// Largest error at the five times for which the flow is tabulated.
struct PoiseuilleErrors {
    double formula = 0, lattice = 0;  ///< with the fluid's viscosity, with the lattice's
    int steps = 0;
};

inline PoiseuilleErrors poiseuille_errors(Poiseuille& flow, double until_s = 1) {
    PoiseuilleErrors errors;
    for (const double time : {0.0225, 0.045, 0.1125, 0.225, 1.0}) {
        if (time > until_s) break;
        flow.run_until(time);
        errors.formula = std::fmax(errors.formula, flow.error());
        errors.lattice =
            std::fmax(errors.lattice, flow.error(kLatticeViscosity * Poiseuille::kViscosity_m2_per_s));
    }
    errors.steps = flow.steps;
    return errors;
}
//! [study_poiseuille]

inline void study_poiseuille(course::Study& study) {
    course::on_device(study);
    const std::vector<int> gaps = study.quick ? std::vector<int>{5, 10, 20} : std::vector<int>{5, 10, 20, 40};
    study.expect(2 * int(gaps.size()));
    std::vector<Water> waters;
    std::vector<PoiseuilleErrors> errors;
    for (const int spacings : gaps) {
        Poiseuille flow(spacings);
        errors.push_back(poiseuille_errors(flow));
        waters.push_back(std::move(flow.water));
    }
    const std::vector<course::Timing> per_step = time_steps(waters, study.quick ? 5 : 9);
    for (std::size_t k = 0; k < gaps.size(); ++k) {
        const auto add = [&](const char* method, double error) {
            study.add({method, double(gaps[k]), double(waters[k].size()), error, per_step[k],
                       double(errors[k].steps)});
        };
        add("against the formula", errors[k].formula);
        add("against the formula with the lattice's viscosity", errors[k].lattice);
    }
}

inline void study_taylor_green(course::Study& study) {
    course::on_device(study);
    const std::vector<int> edges = study.quick ? std::vector<int>{12, 24} : std::vector<int>{16, 32, 64};
    const std::vector<std::pair<double, double>> flows{{10, 0.1}, {100, 0.3}};  // Reynolds number, time
    study.expect(int(edges.size() * flows.size()));
    for (const auto& [reynolds, time_s] : flows)
        for (const int per_edge : edges) {
            TaylorGreen flow(per_edge, reynolds);
            flow.run_until(time_s);
            const double error = std::abs(flow.viscosity_ratio() - 1);
            std::vector<Water> timed;
            timed.push_back(std::move(flow.water));
            study.add({"Reynolds number " + course::format_number(reynolds), double(per_edge),
                       double(timed[0].size()), error, time_steps(timed, study.quick ? 3 : 5)[0],
                       double(flow.steps)});
        }
}

}  // namespace sph
