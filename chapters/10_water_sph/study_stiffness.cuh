/// @file
/// Studies `stiffness` and `equation`: how much water gives way, and what it costs to let it give way less.
#pragma once
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "10_water_sph/run.cuh"
#include "10_water_sph/study_water.cuh"

namespace sph {

//! [compression]
/// How far the water is above its rest density: rms over all particles and 40 looks of a run. Density below
/// rest is no error: at a surface it is what the sum gives, and there is no pressure from it.
struct Compression {
    double rms;  ///< infinite if the run left the model
    int steps;
};

inline Compression compression_of(const Settings& settings, double time_s) {
    Start start = make_start(settings);
    const Fluid& fluid = start.water.fluid();
    const int steps = int(std::ceil(time_s / start.dt_s)), looks = 40;
    Summarizer summarize(start.water.size());
    double sum = 0;
    int taken = 0;
    for (int step = 1; step <= steps; ++step) {
        start.water.step(start.dt_s);
        if (step < double(steps) * (taken + 1) / looks) continue;
        ++taken;
        if (!is_water(fluid, summarize(start.water))) return {INFINITY, steps};
        for (float rho : start.water.densities().download()) {
            const double above = std::max(rho / double(fluid.rest_density_kg_per_m3) - 1, 0.0);
            sum += above * above;
        }
    }
    return {std::sqrt(sum / (double(taken) * start.water.size())), steps};
}
//! [compression]

/// The water of these settings in full motion, half of `time_s` after the start.
inline Water water_in_motion(const Settings& settings, double time_s) {
    Start start = make_start(settings);
    for (int step = 0; step < 0.5 * time_s / start.dt_s; ++step) start.water.step(start.dt_s);
    return std::move(start.water);
}

/// Water that stands in a shaft and has nothing to do but carry its weight.
inline Scene still_column() {
    return {"still column", {{0, 0, 0}, {0.2f, 0.6f, 0.2f}}, {0, 0, 0}, {0.2f, 0.4f, 0.2f}};
}

/// A method of one of the two studies: its settings but for the stiffness.
struct Stiffened {
    std::string method;
    Settings settings;
    float part_of_limit = 1;  ///< time step / the largest that is allowed
};

/// All methods at all factors on the sound speed. A step costs the same at all of them, so it is timed once.
inline void add_compressions(course::Study& study, const std::vector<Stiffened>& methods,
                             const std::vector<float>& factors, double time_s) {
    course::on_device(study);
    study.expect(int(methods.size() * factors.size()));
    std::vector<Water> waters;
    for (const Stiffened& m : methods) waters.push_back(water_in_motion(m.settings, time_s));
    const std::vector<course::Timing> per_step = time_steps(waters, study.quick ? 5 : 15);
    for (std::size_t k = 0; k < methods.size(); ++k)
        for (const float factor : factors) {
            Settings settings = methods[k].settings;
            settings.choice.stiffness = factor;
            settings.dt_s = methods[k].part_of_limit * make_start(settings).dt_s;
            const Compression result = compression_of(settings, time_s);
            study.add({methods[k].method, factor, double(settings.particles), result.rms, per_step[k],
                       double(result.steps)});
        }
}

inline Settings stiffness_settings(const Scene& scene, EquationOfState state, bool quick) {
    Settings settings;
    settings.scene = scene;
    settings.state = state;
    settings.particles = quick ? 500 : 2000;
    return settings;
}

inline void study_stiffness(course::Study& study) {
    const auto settings = [&](const Scene& scene) {
        return stiffness_settings(scene, EquationOfState::linear, study.quick);
    };
    add_compressions(study,
                     {{"still column", settings(still_column())},
                      {"dam break", settings(find_scene(all_scenes(), "dam_break"))}},
                     study.quick ? std::vector<float>{0.5f, 1, 2, 4} : std::vector<float>{0.5f, 1, 2, 4, 8},
                     0.6);
}

inline void study_equation(course::Study& study) {
    const auto settings = [&](EquationOfState state) {
        return stiffness_settings(find_scene(all_scenes(), "drop"), state, study.quick);
    };
    add_compressions(
        study,
        {{"linear", settings(EquationOfState::linear)},
         {"Tait", settings(EquationOfState::tait)},
         {"Tait, half the step", settings(EquationOfState::tait), 0.5f}},
        study.quick ? std::vector<float>{0.7f, 1, 2, 4} : std::vector<float>{0.7f, 1, 1.4f, 2, 4}, 0.5);
}

}  // namespace sph
