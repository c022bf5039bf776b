/// @file
/// What this chapter measures: `--study NAME`.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "11_water_compared/experiment.cuh"
#include "common/program.h"

namespace compared {

/// A plan of the studies: one run, and only a look at its end.
inline RunPlan plan_of(Model model, int exponent, int steps) {
    RunPlan plan;
    plan.model = model;
    plan.exponent = exponent;
    plan.steps = steps;
    plan.samples = 1;
    return plan;
}

/// Seconds per step of repeated runs in turn.
inline course::Timing repeated(const RunPlan& plan, int repeats) {
    std::vector<double> seconds;
    for (int k = 0; k < repeats; ++k)
        seconds.push_back(measure(plan, from_the_middle(), [](int) {}).seconds_per_step);
    return course::timing_of(std::move(seconds));
}

//! [study_second]
/// What a second of water costs: a step's time, and how many of them a second takes. Both models are timed
/// over the same 0.4 s, in which the block falls, lands and splashes.
inline void study_second(course::Study& study) {
    course::on_device(study);
    const std::vector<int> exponents =
        study.quick ? std::vector<int>{10, 11, 12} : std::vector<int>{12, 13, 14, 15};
    study.expect(2 * int(exponents.size()));
    for (const int exponent : exponents)
        for (const Model model : {Model::spring_mass, Model::sph}) {
            RunPlan plan = plan_of(model, exponent, 1);
            const double dt_s = make_contestant(plan, from_the_middle())->dt_s;
            plan.steps = int(0.4 / dt_s);
            study.add({name_of(model), double(plan.particles()), double(plan.particles()), 0,
                       repeated(plan, 3), 1 / dt_s});
        }
}
//! [study_second]

//! [study_crowding]
/// The crowd at rest against the stiffness that holds it off. Its measure is the one a reader of the thesis
/// would take: by how much the neighbours within two spacings of the most crowded particle exceed those in a
/// cubic lattice (32). The mean would tell of the surface: a particle there has half of them.
inline void study_crowding(course::Study& study) {
    course::on_device(study);
    const std::vector<float> factors =
        study.quick ? std::vector<float>{0.1f, 1, 10} : std::vector<float>{0.1f, 0.3f, 1, 3, 10};
    study.expect(2 * int(factors.size()));
    const int exponent = study.quick ? 11 : 13;
    const double time_s = study.quick ? 0.6 : 1.2;
    for (const Model model : {Model::spring_mass, Model::sph})
        for (const float factor : factors) {
            RunPlan plan = plan_of(model, exponent, 1);
            plan.stiffness = factor;
            plan.steps = int(time_s / make_contestant(plan, from_the_middle())->dt_s);
            const RunRecord record = measure(plan, from_the_middle(), [](int) {});
            const double crowd = record.samples.back().most_neighbours;
            study.add({name_of(model), factor, double(plan.particles()), std::fabs(crowd / 32 - 1),
                       course::timing_of({record.seconds_per_step}), double(plan.steps)});
        }
}
//! [study_crowding]

//! [study_time_step]
/// How far the mean height of all particles, 0.3 s after the start, in the splash, is from that of half
/// the smallest step.
inline void study_time_step(course::Study& study) {
    course::on_device(study);
    const std::vector<float> factors =
        study.quick ? std::vector<float>{0.25f, 0.5f, 1} : std::vector<float>{0.125f, 0.25f, 0.5f, 1, 1.5f};
    study.expect(2 * int(factors.size()));
    const int exponent = study.quick ? 11 : 13;
    const double time_s = 0.3;
    const auto run = [&](Model model, float factor, RunPlan& plan) {
        plan = plan_of(model, exponent, 1);
        plan.dt_factor = factor;
        plan.steps = int(std::ceil(time_s / make_contestant(plan, from_the_middle())->dt_s));
        return measure(plan, from_the_middle(), [](int) {});
    };
    for (const Model model : {Model::spring_mass, Model::sph}) {
        RunPlan plan;
        const double truth_m = run(model, factors[0] / 2, plan).samples.back().mean_height_m;
        for (const float factor : factors) {
            const RunRecord record = run(model, factor, plan);
            study.add({name_of(model), record.dt_s, double(plan.particles()),
                       std::fabs(record.samples.back().mean_height_m / truth_m - 1),
                       course::timing_of({record.seconds_per_step}), double(plan.steps)});
        }
    }
}
//! [study_time_step]

inline void declare_studies(course::Program& program) {
    program.study({"second", "What does a second of water cost?", "none: each model is its own truth",
                   "particles", course::StudyPlot::time_against_value},
                  study_second);
    program.study({"crowding", "What does it cost to keep particles from crowding?",
                   "crowding: neighbours of the most crowded particle / 32 - 1, at rest", "stiffness"},
                  study_crowding);
    program.study({"time_step", "Which model gets the splash right in less time?",
                   "mean height after 0.3 s: difference from that of a far smaller step, relative", "dt_s"},
                  study_time_step);
}

}  // namespace compared
