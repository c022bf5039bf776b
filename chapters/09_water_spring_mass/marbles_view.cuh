/// @file
/// How the marbles look: chapter 06's view of a tank, and which speed is white.
#pragma once
#include "06_gl_interop/tank_view.cuh"
#include "09_water_spring_mass/run.cuh"

namespace spring_mass {

inline interop::TankScene look_of(const Settings& settings, const Start& start) {
    const Scene& from = settings.scene;
    interop::TankScene scene;
    scene.tank = {as_vec3(from.tank.low_m), as_vec3(from.tank.high_m)};
    scene.drawing =
        settings.drawing == Drawing::points ? interop::Drawing::points : interop::Drawing::spheres;
    scene.radius_m = 0.5f * start.marbles.material().diameter_m;
    // White where marbles are as fast as a free fall from the top of the block makes them.
    const float top_m = from.block_low_m.y + from.block_size_m.y - from.tank.low_m.y;
    scene.white_at_m_per_s = 1.1f * std::sqrt(2 * 9.81f * top_m);
    return scene;
}

}  // namespace spring_mass
