/// @file
/// Study `pressure` and stability map `corrections`: position based fluids beside the equations of state.
#pragma once
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "10_water_sph/stability_maps.cuh"
#include "10_water_sph/study_stiffness.cuh"

namespace sph {

//! [timed_run]
/// A run that is measured while it goes on: how long its steps take and how far its water is pressed.
struct TimedRun {
    std::string method;
    double allowed;                               ///< compression that was asked for
    double particles;                             ///< how many
    std::function<int(double until_s)> advance;   ///< takes steps up to that time: how many?
    std::function<std::vector<float>()> density;  ///< now
    std::function<bool()> is_water;
    double square_sum = 0, seconds = 0, steps = 0;
    std::vector<double> per_step_s;  ///< of each look
    bool broken = false;
};

/// Runs go on in turn, look by look: a machine that is busy for a while slows all of them alike.
inline void run_in_turn(std::vector<TimedRun>& runs, double time_s, int looks) {
    for (int look = 1; look <= looks; ++look)
        for (TimedRun& run : runs) {
            if (run.broken) continue;
            const auto start = std::chrono::steady_clock::now();
            const int steps = run.advance(time_s * look / looks);
            CUDA_CHECK(cudaDeviceSynchronize());
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
            run.seconds += taken.count();
            run.steps += steps;
            if (steps > 0) run.per_step_s.push_back(taken.count() / steps);
            run.broken = !run.is_water();
            for (float rho : run.density()) {
                const double above = std::fmax(rho / 1000.0 - 1, 0.0);
                run.square_sum += above * above / run.particles / looks;
            }
        }
}
//! [timed_run]

/// An equation of state that lets the water's lowest layer give way by `allowed`: g H = allowed c^2.
inline TimedRun timed_state_run(const std::string& name, Settings settings, double allowed) {
    settings.choice.stiffness = float(1 / (6 * std::sqrt(allowed)));
    // Friction as with position based fluids: that of factor 1. (make_fluid makes it grow with the sound.)
    settings.choice.viscosity = 1 / settings.choice.stiffness;
    auto start = std::make_shared<Start>(make_start(settings));
    auto time_s = std::make_shared<double>(0);
    return {name + ", linear",
            allowed,
            double(settings.particles),
            [=](double until_s) {
                int steps = 0;
                for (; *time_s < until_s; ++steps, *time_s += start->dt_s) start->water.step(start->dt_s);
                return steps;
            },
            [=] { return start->water.densities().download(); },
            [=] { return is_water(start->water.fluid(), Summarizer(start->water.size())(start->water)); }};
}

/// Position based fluids that let it give way by `allowed` on average, with the program's own step.
inline TimedRun timed_pbf_run(const std::string& name, Settings settings, double allowed) {
    settings.pbf.tolerance = float(allowed);
    auto start = std::make_shared<PbfStart>(make_pbf_start(settings));
    auto time_s = std::make_shared<double>(0);
    return {name + ", PBF",
            allowed,
            double(settings.particles),
            [=](double until_s) {
                int steps = 0;
                for (; *time_s < until_s; ++steps, *time_s += start->dt_s) start->water.step(start->dt_s);
                return steps;
            },
            [=] { return start->water.densities().download(); },
            [=] {
                return is_water(start->water.fluid(), Summarizer(start->water.size())(start->water),
                                start->dt_s);
            }};
}

//! [pressure_cases]
/// What water has to do, and from which start.
struct PressureCase {
    std::string name;
    Scene scene;
    std::uint64_t seed;
};

/// The first two are those that position based fluids were tuned on; the others are their test.
inline std::vector<PressureCase> pressure_cases(bool quick) {
    const Scene dam = find_scene(all_scenes(), "dam_break"), drop = find_scene(all_scenes(), "drop");
    std::vector<PressureCase> cases{{"dam break", dam, 1}, {"still column", still_column(), 1}};
    if (quick) return cases;
    cases.push_back({"dam break of seed 2", dam, 2});
    cases.push_back({"drop of seed 3", drop, 3});
    return cases;
}
//! [pressure_cases]

inline void study_pressure(course::Study& study) {
    course::on_device(study);
    const std::vector<double> allowed = study.quick ? std::vector<double>{0.03, 0.01, 0.003}
                                                    : std::vector<double>{0.03, 0.01, 0.003, 0.001, 0.0005};
    std::vector<TimedRun> runs;
    for (const PressureCase& one : pressure_cases(study.quick))
        for (const double part : allowed) {
            Settings settings = stiffness_settings(one.scene, EquationOfState::linear, study.quick);
            settings.seed = one.seed;
            runs.push_back(timed_state_run(one.name, settings, part));
            runs.push_back(timed_pbf_run(one.name, settings, part));
        }
    study.expect(int(runs.size()));
    run_in_turn(runs, study.quick ? 0.3 : 0.6, study.quick ? 10 : 40);
    for (const TimedRun& run : runs) {
        course::Timing timing = course::timing_of(run.per_step_s);
        // Steps differ in their corrections: it is the mean that makes up the run's time, not the median.
        timing.median_s = run.seconds / run.steps;
        study.add({run.method, run.allowed, run.particles, run.broken ? INFINITY : std::sqrt(run.square_sum),
                   timing, run.steps});
    }
}

//! [pbf_is_stable]
/// A small dam break. Stable if no particle crosses its support in a step, none is pressed to twice the rest
/// density, and the energy of motion and height stays below that of the start.
inline bool pbf_is_stable(const Settings& settings, double time_s) {
    PbfStart start = make_pbf_start(settings);
    Summarizer summarize(start.water.size());
    const double start_J = summarize(start.water).potential_J;
    const int steps = std::max(1, int(time_s / start.dt_s));
    for (int step = 1; step <= steps; ++step) {
        start.water.step(start.dt_s);
        const Summary now = summarize(start.water);
        // 2 %: room for water that swells by its tolerance.
        if (!is_water(start.water.fluid(), now, start.dt_s) ||
            !(now.kinetic_J + now.potential_J < 1.02 * start_J))
            return false;
    }
    return true;
}
//! [pbf_is_stable]

inline void map_corrections(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<float> tolerances =
        map.quick ? std::vector<float>{0.03f, 0.01f} : std::vector<float>{0.1f, 0.03f, 0.01f, 0.003f};
    const std::vector<int> corrections = map.quick ? std::vector<int>{50} : std::vector<int>{5, 50};
    const std::vector<double> factors = map.quick ? std::vector<double>{0.3, 0.75, 1.5, 3}
                                                  : std::vector<double>{0.15, 0.3, 0.5, 0.75, 1, 1.5, 2, 3};
    map.expect(int(tolerances.size() * corrections.size()));
    Settings settings = dam_break_settings(map.quick);
    const Fluid fluid = make_pbf_start(settings).water.fluid();
    const double speed = 2 * std::sqrt(9.81 * 0.4);  // m/s: 2 sqrt(g H), of a dam 0.4 m high
    for (const int most : corrections)
        for (const float tolerance : tolerances) {
            settings.pbf.tolerance = tolerance;
            settings.pbf.max_corrections = most;
            map.column("at most " + std::to_string(most) + " corrections", tolerance,
                       0.4 * fluid.support_m / speed, factors, map.quick ? 1 : 3, [&](double dt_s) {
                           settings.dt_s = float(dt_s);
                           return pbf_is_stable(settings, 0.6);
                       });
        }
}

}  // namespace sph
