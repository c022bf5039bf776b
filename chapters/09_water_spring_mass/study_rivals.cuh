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
/// A bed of glass marbles that settles into a heap as wide as its box: each touches about two others while it
/// is measured. The state after some hundred steps; no longer a lattice.
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
    bed.position = fill_block({0, 0, 0}, {0.4f, 0.4f, 0.4f}, n, 7, 0.1f, spacing_m);
    bed.material = make_material(scene, 1.04f * spacing_m);  // some touch from the start
    bed.box = {{0, 0, 0}, {0.4f, 0.8f, 0.4f}};
    bed.dt_s = kStepInLimits * time_step_limit_s(bed.material);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> speed(-0.1f, 0.1f);  // m/s
    for (std::uint32_t i = 0; i < n; ++i)
        bed.velocity.push_back(make_float4(speed(random), speed(random), speed(random), 0));
    Marbles marbles(bed.material, bed.box, bed.position, bed.velocity);
    for (int step = 0; step < settling_steps; ++step) marbles.step(bed.dt_s);
    bed.position = by_id(marbles, marbles.positions());
    bed.velocity = by_id(marbles, marbles.velocities());
    return bed;
}
//! [bed]

/// The same for LAMMPS.
inline LammpsScene in_lammps(const Bed& bed, int steps, double skin_m) {
    LammpsScene scene;
    scene.material = in_double(bed.material);
    scene.low_m = as_vec3(bed.box.low_m);
    scene.high_m = as_vec3(bed.box.high_m);
    for (const float4& p : bed.position) scene.position.push_back(grid::xyz(p));
    for (const float4& v : bed.velocity) scene.velocity.push_back(grid::xyz(v));
    scene.dt_s = bed.dt_s;
    scene.steps = steps;
    scene.skin_m = skin_m;
    return scene;
}

//! [rivals]
/// All methods run the same steps from the same state, in turns, so that whatever else the machine does
/// meets all of them alike. LAMMPS gets the skin that is best for it.
inline void study_rivals(course::Study& study) {
    course::on_device(study);
    constexpr float kLammpsSkin = 0.3f;  // of 0.1, 0.2, 0.3, 0.4 and 0.5 diameters the fastest (measured)
    const int steps = 300, rounds = study.quick ? 3 : 5;
    const std::vector<std::uint32_t> sizes = study.quick ? std::vector<std::uint32_t>{4096, 16384}
                                                         : std::vector<std::uint32_t>{16384, 65536, 131072};
    int ranks = !is_installed("lmp") ? 0 : is_installed("mpirun") ? 2 : 1;
    if (ranks == 0)
        std::printf(
            "LAMMPS is not installed, so this study has no rival to show (Debian: apt-get install "
            "lammps)\n");
    study.expect(int(sizes.size()) * (1 + ranks));
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "marbles_in_lammps";
    std::filesystem::create_directories(folder);
    for (const std::uint32_t n : sizes) {
        const Bed bed = make_bed(n, 600);
        const LammpsScene scene = in_lammps(bed, steps, kLammpsSkin * bed.material.diameter_m);
        std::vector<double> ours;
        std::vector<std::vector<double>> theirs(3);
        double contacts = 0;
        for (int round = 0; round < rounds; ++round) {
            Marbles marbles(bed.material, bed.box, bed.position, bed.velocity);
            const auto before = std::chrono::steady_clock::now();
            for (int step = 0; step < steps; ++step) marbles.step(bed.dt_s);
            CUDA_CHECK(cudaDeviceSynchronize());
            ours.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
            contacts = Summarizer(n)(marbles).contacts / n;
            for (int r = 1; r <= ranks; ++r) theirs[r].push_back(run_lammps(scene, folder, r).seconds);
        }
        const auto add = [&](const std::string& method, const std::vector<double>& seconds) {
            const course::Timing timing = course::timing_of(seconds);
            study.add({method, double(n), double(n), 0, timing.per(steps), double(steps)});
            std::printf(
                "%s, %u marbles, %.1f contacts each: %.1f million marble-steps per s (%.1f to %.1f)\n",
                method.c_str(), n, contacts, 1e-6 * n * steps / timing.median_s,
                1e-6 * n * steps / timing.high_s, 1e-6 * n * steps / timing.low_s);
        };
        add("this chapter", ours);
        for (int r = 1; r <= ranks; ++r) {
            add("LAMMPS, " + std::to_string(r) + (r == 1 ? " process" : " processes"), theirs[r]);
            std::vector<double> ratio;
            for (std::size_t k = 0; k < ours.size(); ++k) ratio.push_back(theirs[r][k] / ours[k]);
            const course::Timing spread = course::timing_of(ratio);
            std::printf("    time of LAMMPS / time of this chapter: %.2f (%.2f to %.2f)\n", spread.median_s,
                        spread.low_s, spread.high_s);
        }
    }
    std::filesystem::remove_all(folder);
}
//! [rivals]

}  // namespace spring_mass
