/// @file
/// Both models in pictures: the same block at the same moment, side by side, and each one's time lapse.
#pragma once
#include <algorithm>
#include <vector>

#include "06_gl_interop/tank_view.cuh"
#include "11_water_compared/experiment.cuh"
#include "common/image.h"

namespace compared {

constexpr int kStepsPerStill = 100;  ///< of a time lapse, as in the thesis
constexpr int kStills = 9;

inline interop::TankScene look_of(const Contestant& contestant, const Drop& drop) {
    const sph::Box& tank = contestant.tank;
    interop::TankScene look;
    look.tank = {as_vec3(tank.low_m), as_vec3(tank.high_m)};
    look.radius_m = 0.5f * contestant.spacing_m;
    // White where particles are as fast as a free fall from the top of the block makes them.
    look.white_at_m_per_s =
        1.1f * std::sqrt(2 * 9.81f * (drop.block_low_m.y + drop.block_size_m.y - tank.low_m.y));
    return look;
}

/// Draws one contestant as often as wanted. Needs a current OpenGL context.
class Portrait {
  public:
    Portrait(const Contestant& contestant, const Drop& drop, int width_px, int height_px)
        : look_(look_of(contestant, drop)), view_(look_, contestant.size(), width_px, height_px) {}

    course::Image operator()(const Contestant& contestant) {
        view_.draw(contestant.position(), contestant.velocity(), contestant.size(),
                   interop::first_view(look_.tank).camera());
        return view_.image();
    }

  private:
    interop::TankScene look_;
    interop::TankView view_;
};

/// Nine stills, one each hundred steps, the first of the start.
template <class Told>
std::vector<course::Image> time_lapse(const RunPlan& plan, const Drop& drop, int width_px, int height_px,
                                      Told told) {
    const auto contestant = make_contestant(plan, drop);
    Portrait portrait(*contestant, drop, width_px, height_px);
    std::vector<course::Image> stills = {portrait(*contestant)};
    for (int step = 1; step <= (kStills - 1) * kStepsPerStill; ++step) {
        contestant->step();
        told();
        if (step % kStepsPerStill != 0) continue;
        contestant->check(step);
        stills.push_back(portrait(*contestant));
    }
    return stills;
}

//! [same_moments]
/// Stills at the same times, whatever the steps: the two models take different ones, and steps are no clock.
template <class Told>
std::vector<course::Image> at_moments(const RunPlan& plan, const Drop& drop,
                                      const std::vector<double>& moments_s, int width_px, int height_px,
                                      Told told) {
    const auto contestant = make_contestant(plan, drop);
    Portrait portrait(*contestant, drop, width_px, height_px);
    std::vector<course::Image> stills;
    int step = 0;
    for (const double moment_s : moments_s) {
        for (; step < moment_s / contestant->dt_s; ++step) contestant->step();
        contestant->check(step);
        stills.push_back(portrait(*contestant));
        told();
    }
    return stills;
}
//! [same_moments]

}  // namespace compared
