/// @file
/// The two models behind one shape, so that the experiment treats them alike: the same particles at the same
/// places in the same tank.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "09_water_spring_mass/run.cuh"
#include "10_water_sph/run.cuh"
#include "11_water_compared/record.h"
#include "common/gpu_timer.h"

namespace compared {

//! [PassTimes]
/// Adds up the time of passes by name. Handed to a model's step() it runs and times each pass; without it a
/// step waits for nothing between its passes.
class PassTimes {
  public:
    template <class Pass>
    void operator()(const char* name, Pass pass) {
        timer_.start();
        pass();
        add(name, 1e-3 * timer_.stop());
    }
    /// In the order of their first appearance.
    const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

  private:
    void add(const std::string& name, double seconds) {
        for (auto& [known, sum] : seconds_)
            if (known == name) {
                sum += seconds;
                return;
            }
        seconds_.emplace_back(name, seconds);
    }

    course::GpuTimer timer_;
    std::vector<std::pair<std::string, double>> seconds_;
};
//! [PassTimes]

/// Where and how the particles start. Lengths in metres.
struct Drop {
    std::string name = "drop";
    sph::Box tank{{0, 0, 0}, {0.8f, 0.8f, 0.8f}};
    float3 block_low_m{0.2f, 0.25f, 0.2f}, block_size_m{0.4f, 0.4f, 0.4f};
    float jitter = 0.05f;  ///< particles start on a lattice, moved by up to so many spacings along each axis
};

/// The thesis's experiment lets particles fall from the middle; its pictures show a block along the left
/// wall.
inline Drop from_the_middle() {
    return {};
}
inline Drop along_the_left_wall() {
    return {"dam_break", {{0, 0, 0}, {0.9f, 0.8f, 0.4f}}, {0, 0, 0}, {0.4f, 0.4f, 0.4f}};
}

/// One of the two models with its particles.
class Contestant {
  public:
    virtual ~Contestant() = default;
    virtual void step() = 0;
    virtual void step(PassTimes& times) = 0;
    virtual std::uint32_t size() const = 0;
    virtual const float4* position() const = 0;
    virtual const float4* velocity() const = 0;
    /// @throws course::Unstable if the run has left the model
    virtual void check(int step) = 0;

    float spacing_m = 0;         ///< of the particles at the start
    float dt_s = 0;              ///< of a step
    float partner_m = 0;         ///< two particles closer than this act on each other
    std::size_t bytes_each = 0;  ///< of device memory, for a particle
    sph::Box tank;
};

inline void timed_step(sph::Water& w, float dt_s, PassTimes& times) {
    w.step(dt_s, sph::NoGuest(), std::ref(times));
}
inline void timed_step(spring_mass::Marbles& m, float dt_s, PassTimes& times) {
    m.step(dt_s, std::ref(times));
}

/// A model's own class in the contestant's shape.
template <class Body, class Check>
class ContestantOf : public Contestant {
  public:
    ContestantOf(Body body, Check check) : body_(std::move(body)), check_(std::move(check)) {}
    void step() override { body_.step(dt_s); }
    void step(PassTimes& times) override { timed_step(body_, dt_s, times); }
    std::uint32_t size() const override { return body_.size(); }
    const float4* position() const override { return std::as_const(body_).position(); }
    const float4* velocity() const override { return std::as_const(body_).velocity(); }
    void check(int step) override { check_(body_, step, dt_s); }

  private:
    Body body_;
    Check check_;
};

//! [make_contestant]
/// Both models get the same positions, at rest. A marble is 0.95 spacings wide; a smoothing kernel
/// reaches two spacings. Each takes the time step that its own chapter's program would, times dt_factor.
inline std::unique_ptr<Contestant> make_contestant(const RunPlan& plan, const Drop& drop) {
    float spacing_m = 0;
    const std::vector<float4> start = spring_mass::fill_block(
        drop.block_low_m, drop.block_size_m, plan.particles(), plan.seed + plan.run, drop.jitter, spacing_m);
    const std::vector<float4> at_rest(start.size(), make_float4(0, 0, 0, 0));
    std::unique_ptr<Contestant> contestant;
    if (plan.model == Model::sph) {
        const sph::Scene scene{drop.name, drop.tank, drop.block_low_m, drop.block_size_m};
        sph::FluidChoice choice;
        choice.stiffness = std::sqrt(plan.stiffness);  // a factor on the speed of sound there
        const sph::Fluid fluid = sph::make_fluid(scene, spacing_m, choice);
        const auto check = [summarize = std::make_shared<sph::Summarizer>(plan.particles())](
                               const sph::Water& water, int step, float dt_s) {
            sph::check_state(water, (*summarize)(water), step, dt_s);
        };
        contestant = std::make_unique<ContestantOf<sph::Water, decltype(check)>>(
            sph::Water(fluid, drop.tank, sph::EquationOfState::linear, start, at_rest), check);
        contestant->dt_s = sph::time_step_limit(fluid).smallest_s();
        contestant->partner_m = fluid.support_m;
        contestant->bytes_each = sph::Water::bytes_per_particle(fluid.viscosity_m2_per_s > 0);
    } else {
        const spring_mass::Box tank{drop.tank.low_m, drop.tank.high_m};
        spring_mass::Scene scene{drop.name, tank, drop.block_low_m, drop.block_size_m, {}};
        scene.touch.stiffness = plan.stiffness;  // smooth marbles: friction 0, as water has none
        const spring_mass::Material material = spring_mass::make_material(scene, spacing_m);
        spring_mass::Marbles marbles(material, tank, start, at_rest);
        const auto summarize = std::make_shared<spring_mass::Summarizer>(plan.particles());
        const auto check = [summarize, start_J = (*summarize)(marbles).energy_J()](
                               const spring_mass::Marbles& now, int step, float dt_s) {
            spring_mass::check_state(now, (*summarize)(now), start_J, step, dt_s);
        };
        contestant =
            std::make_unique<ContestantOf<spring_mass::Marbles, decltype(check)>>(std::move(marbles), check);
        contestant->dt_s = spring_mass::kStepInLimits * spring_mass::time_step_limit_s(material);
        contestant->partner_m = material.diameter_m;
        contestant->bytes_each = spring_mass::Marbles::kBytesPerMarble;
    }
    contestant->dt_s *= plan.dt_factor;
    contestant->spacing_m = spacing_m;
    contestant->tank = drop.tank;
    return contestant;
}
//! [make_contestant]

}  // namespace compared
