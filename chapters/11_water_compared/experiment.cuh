/// @file
/// The experiment: runs of both models at growing sizes, timed, looked at, and kept.
#pragma once
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "11_water_compared/contestants.cuh"
#include "11_water_compared/crowding.cuh"

namespace compared {

/// How many runs of which sizes.
struct Experiment {
    int min_exponent = 14, max_exponent = 17;
    int runs = 3;
    RunPlan run;  ///< model, exponent and run number aside
};

//! [plans]
/// All runs, in the order they are made: the two models take turns, so that a machine that is slow for a
/// while is slow for both; and each repeat walks through all sizes before the next begins, so that an
/// experiment cut short still has every size.
inline std::vector<RunPlan> plans_of(const Experiment& experiment) {
    std::vector<RunPlan> plans;
    for (int run = 0; run < experiment.runs; ++run)
        for (int exponent = experiment.min_exponent; exponent <= experiment.max_exponent; ++exponent)
            for (const Model model : {Model::spring_mass, Model::sph}) {
                RunPlan plan = experiment.run;
                plan.model = model;
                plan.exponent = exponent;
                plan.run = run;
                plans.push_back(plan);
            }
    return plans;
}
//! [plans]

inline glm::vec3 as_vec3(float3 v) {
    return {v.x, v.y, v.z};
}

//! [explain]
/// The answer to --explain.
inline std::string explain(const Experiment& experiment, bool draws) {
    const std::vector<RunPlan> plans = plans_of(experiment);
    const int samples = experiment.run.samples;
    std::string text = std::to_string(plans.size()) + " runs of " + std::to_string(experiment.run.steps) +
                       " steps, 2^" + std::to_string(experiment.min_exponent) + " to 2^" +
                       std::to_string(experiment.max_exponent) + " particles\n";
    text += "each step: the kernels of chapter 09's or 10's step, and nothing else\n";
    text += "each run: " + std::to_string(samples) +
            " looks at the particles; each builds a grid and counts twice " +
            "(neighbours within two spacings, and the model's own partners), outside of the time measured\n";
    text += "left out: counting and checks in the timed steps\n";
    text += "left out: timing of single passes in all steps but " + std::to_string(samples) + " of a run\n";
    text += draws ? "left out: OpenGL in the runs; pictures come from runs of their own\n"
                  : "left out: OpenGL, its context and all its objects, since nothing is drawn\n";
    return text;
}
//! [explain]

/// For the sum of all heights. (Not inside the class: nvcc takes no private type for a kernel.)
struct Heights {
    const float4* position;
    __device__ double operator[](std::uint32_t i) const { return position[i].y; }
};

/// Looks at a contestant's particles: how crowded they are, and how high.
class Observer {
  public:
    explicit Observer(const Contestant& contestant)
        : floor_m_(contestant.tank.low_m.y),
          neighbours_(contestant.size(), as_vec3(contestant.tank.low_m), as_vec3(contestant.tank.high_m),
                      2 * contestant.spacing_m),
          partners_(contestant.size(), as_vec3(contestant.tank.low_m), as_vec3(contestant.tank.high_m),
                    contestant.partner_m),
          height_(contestant.size()) {}

    Sample operator()(const Contestant& contestant) {
        const std::uint32_t n = contestant.size();
        const Crowd crowd = neighbours_(contestant.position(), n);
        Sample sample;
        sample.mean_neighbours = crowd.mean_neighbours;
        sample.most_neighbours = crowd.most_neighbours;
        sample.fullest_cell = crowd.fullest_cell;
        sample.mean_partners = partners_(contestant.position(), n).mean_neighbours;
        height_(Heights{contestant.position()}, n);
        sample.mean_height_m = height_.download() / n - floor_m_;
        return sample;
    }

  private:
    float floor_m_;
    CrowdCounter neighbours_, partners_;
    patterns::TreeReduction<patterns::Sum<double>> height_;
};

//! [measure]
/// Makes one run. Between two samples steps are timed as a whole; the step before a sample is timed pass by
/// pass and counts for the passes alone, since waiting after each pass takes time of its own.
/// @param told  is called after each step, with its number
/// @throws course::Unstable if the run leaves the model
template <class Told>
RunRecord measure(const RunPlan& plan, const Drop& drop, Told told) {
    using Clock = std::chrono::steady_clock;
    const std::unique_ptr<Contestant> contestant = make_contestant(plan, drop);
    Observer observe(*contestant);
    RunRecord record;
    record.plan = plan;
    record.device = course::device_name();
    record.dt_s = contestant->dt_s;
    PassTimes passes;
    double seconds = 0, since_sample = 0;
    int timed = 0, timed_since_sample = 0, by_pass = 0;
    for (int step = 1; step <= plan.steps; ++step) {
        const bool look = step == plan.steps || std::int64_t(step) * plan.samples / plan.steps !=
                                                    std::int64_t(step - 1) * plan.samples / plan.steps;
        if (look && plan.steps > 1) {
            contestant->step(passes);
            ++by_pass;
        } else {
            const auto start = Clock::now();
            contestant->step();
            CUDA_CHECK(cudaDeviceSynchronize());
            since_sample += std::chrono::duration<double>(Clock::now() - start).count();
            ++timed_since_sample;
        }
        told(step);
        if (!look) continue;
        contestant->check(step);
        Sample sample = observe(*contestant);
        sample.step = step;
        seconds += since_sample;
        timed += timed_since_sample;
        if (timed_since_sample > 0) sample.seconds = since_sample / timed_since_sample;
        since_sample = timed_since_sample = 0;
        record.samples.push_back(sample);
    }
    record.seconds_per_step = timed > 0 ? seconds / timed : 0;
    for (const auto& [name, sum] : passes.seconds()) record.passes.emplace_back(name, sum / by_pass);
    return record;
}
//! [measure]

}  // namespace compared
