/// @file
/// Study `rivals`: this chapter's marbles and LAMMPS's, on the same scene from the same state.
#pragma once
#include <algorithm>
#include <chrono>
#include <random>

#include "09_water_spring_mass/lammps.h"
#include "09_water_spring_mass/run.cuh"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace spring_mass {

//! [bed]
/// A bed of glass marbles that have just settled into a heap as wide as its box: each touches two others on
/// average. The state after some hundred steps; no longer a lattice.
struct Bed {
    Material material;
    Box box;
    std::vector<float4> position, velocity;
    float dt_s;
};

inline Bed make_bed(std::uint32_t n, int settling_steps) {
    Scene scene = find_scene(all_scenes(), "drop");
    Bed bed;
    float spacing_m = 0;
    bed.position = fill_block({0, 0, 0}, {0.4f, 0.4f, 0.4f}, n, 7, 0.2f, spacing_m);
    bed.material = make_material(scene, spacing_m);
    bed.box = {{0, 0, 0}, {0.4f, 0.8f, 0.4f}};
    bed.dt_s = kStepInLimits * time_step_limit_s(bed.material);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> speed(-0.3f, 0.3f);  // m/s
    for (std::uint32_t i = 0; i < n; ++i)
        bed.velocity.push_back(make_float4(speed(random), speed(random), speed(random), 0));
    Marbles marbles(bed.material, bed.box, bed.position, bed.velocity);
    for (int step = 0; step < settling_steps; ++step) marbles.step(bed.dt_s);
    bed.position = by_id(marbles, marbles.positions());
    bed.velocity = by_id(marbles, marbles.velocities());
    return bed;
}
//! [bed]

}  // namespace spring_mass
