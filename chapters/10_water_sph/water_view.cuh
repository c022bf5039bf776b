/// @file
/// How this chapter's water looks: chapter 06's view of a tank, and which speed is white.
#pragma once
#include "06_gl_interop/tank_view.cuh"
#include "10_water_sph/run.cuh"

namespace sph {

inline interop::TankScene look_of(const Settings& settings, const Start& start) {
    const Box& tank = settings.scene.tank;
    interop::TankScene scene;
    scene.tank = {{tank.low_m.x, tank.low_m.y, tank.low_m.z}, {tank.high_m.x, tank.high_m.y, tank.high_m.z}};
    scene.drawing =
        settings.drawing == Drawing::points ? interop::Drawing::points : interop::Drawing::spheres;
    scene.radius_m = 0.55f * start.spacing_m;
    // White where water is as fast as a free fall from the top of the block makes it.
    scene.white_at_m_per_s =
        1.1f * start.water.fluid().sound_speed_m_per_s / (6 * settings.choice.stiffness) * 1.4142f;
    return scene;
}

}  // namespace sph
