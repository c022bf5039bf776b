/// @file
/// Studies of what a step, a stiffness and a skin cost and buy: `bounce`, `energy`, `overlap` and `skin`.
#pragma once
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "09_water_spring_mass/run.cuh"
#include "common/gpu_timer.h"
#include "common/result.h"
#include "common/study.h"

namespace spring_mass {

/// Steps of some marbles with the clock running. The marbles are gone after it: each repeat goes on.
inline course::Timing time_steps(Marbles& marbles, float dt_s, int repeats, int steps) {
    return course::time_work(repeats,
                             [&] {
                                 for (int step = 0; step < steps; ++step) marbles.step(dt_s);
                                 CUDA_CHECK(cudaDeviceSynchronize());
                             })
        .per(steps);
}

//! [pairs]
/// Many pairs that meet head on at 1 m/s, each at its own moment, so that contacts begin at every phase of a
/// step. Diameter 1 cm, mass 1 g; omega = 2000 / s, so that they are pressed in by 5 % at most.
struct Pairs {
    Material material;
    Box box{{0, 0, 0}, {1, 1, 1}};
    std::vector<float4> position, velocity;
};

inline Pairs make_pairs(int count, float restitution) {
    Pairs pairs;
    Material& m = pairs.material;
    m.diameter_m = 0.01f;
    m.mass_kg = 1e-3f;
    m.stiffness_N_per_m = 2000;
    m.normal_damping_per_s = damping_for_restitution(restitution, m.stiffness_N_per_m, m.mass_kg);
    m.gravity_m_per_s2 = glm::vec3(0);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> gap_m(0, 1e-3f);
    for (int i = 0; i < count; ++i) {
        const float x = 0.05f + 0.05f * (i % 18), y = 0.05f + 0.025f * (i / 18 % 36),
                    z = 0.05f + 0.025f * (i / 648);
        pairs.position.push_back(make_float4(x, y, z, 0));
        pairs.position.push_back(make_float4(x + 0.0101f + gap_m(random), y, z, 0));
        pairs.velocity.push_back(make_float4(0.5f, 0, 0, 0));
        pairs.velocity.push_back(make_float4(-0.5f, 0, 0, 0));
    }
    return pairs;
}
//! [pairs]

inline void study_bounce(course::Study& study) {
    course::on_device(study);
    const std::vector<double> steps_per_contact = study.quick
                                                      ? std::vector<double>{6, 12, 25, 50, 100}
                                                      : std::vector<double>{4, 6, 9, 12, 25, 50, 100, 200};
    const std::vector<float> restitutions{1, 0.5f, 0.1f};
    study.expect(int(restitutions.size() * steps_per_contact.size()));
    for (const float restitution : restitutions)
        for (const double steps_each : steps_per_contact) {
            const int count = study.quick ? 300 : 1000;
            Pairs pairs = make_pairs(count, restitution);
            Marbles marbles(pairs.material, pairs.box, pairs.position, pairs.velocity);
            const float dt_s = float(3.14159265 / 2000 / steps_each);
            const int steps = int(0.006f / dt_s);  // all have met and parted
            const course::Timing timing =
                course::time_work(3, [&] {
                    marbles = Marbles(pairs.material, pairs.box, pairs.position, pairs.velocity);
                    for (int step = 0; step < steps; ++step) marbles.step(dt_s);
                    CUDA_CHECK(cudaDeviceSynchronize());
                }).per(steps);
            const auto v = by_id(marbles, marbles.velocities());
            double sum = 0;
            for (int i = 0; i < count; ++i) {
                const double error = double(v[2 * i + 1].x) - v[2 * i].x - restitution;
                sum += error * error;
            }
            study.add({"e = " + course::format_number(restitution), dt_s, 2.0 * count, std::sqrt(sum / count),
                       timing, double(steps)});
        }
}

//! [gas]
/// Marbles that lose nothing, in a box without weight: their energy is the one of the start for ever.
inline void study_energy(course::Study& study) {
    course::on_device(study);
    const int count = study.quick ? 500 : 2000;
    const double time_s = study.quick ? 0.2 : 0.5;
    Scene scene = find_scene(all_scenes(), "drop");
    scene.touch.restitution = 1;
    scene.touch.friction = 0;
    float spacing_m = 0;
    const std::vector<float4> position = fill_block({0.005f, 0.005f, 0.005f}, {0.39f, 0.39f, 0.39f},
                                                    std::uint32_t(count), 1, kJitter, spacing_m);
    Material material = make_material(scene, spacing_m);
    material.gravity_m_per_s2 = glm::vec3(0);
    std::mt19937 random(4);
    std::normal_distribution<float> speed(0, 1);
    std::vector<float4> velocity;
    for (int i = 0; i < count; ++i)
        velocity.push_back(make_float4(speed(random), speed(random), speed(random), 0));
    const std::vector<double> factors{0.8, 0.5, 0.3, 0.2, 0.12, 0.07};
    study.expect(int(factors.size()));
    for (const double factor : factors) {
        const float dt_s = float(factor * time_step_limit_s(material));
        Marbles marbles(material, {{0, 0, 0}, {0.4f, 0.45f, 0.4f}}, position, velocity);
        Summarizer summarize(marbles.size());
        const double start_J = summarize(marbles).energy_J();
        const int steps = int(time_s / dt_s);
        double worst = 0;
        const course::Timing timing = time_steps(marbles, dt_s, 3, std::max(1, steps / 4)).per(1);
        for (int k = 0; k < 50; ++k) {  // the four quarters have run; now look at the state 50 times
            marbles.step(dt_s);
            worst = std::max(worst, std::abs(summarize(marbles).energy_J() / start_J - 1));
        }
        study.add({"leapfrog", dt_s, double(count), worst, timing, double(steps)});
    }
}
//! [gas]

//! [overlap]
/// What is bought by stiffness: marbles that are not pressed into each other. Its price is the number of
/// steps. The deepest overlap of all marbles and all steps that were looked at, in diameters.
inline void study_overlap(course::Study& study) {
    course::on_device(study);
    const std::vector<float> stiffness =
        study.quick ? std::vector<float>{0.1f, 1, 10} : std::vector<float>{0.1f, 0.3f, 1, 3, 10, 30};
    const std::vector<std::string> scenes{"drop", "dam_break", "syrup"};
    study.expect(int(scenes.size() * stiffness.size()));
    for (const std::string& name : scenes)
        for (const float factor : stiffness) {
            Settings settings;
            settings.scene = find_scene(all_scenes(), name);
            settings.scene.touch.stiffness = factor;
            settings.particles = study.quick ? 500 : 4096;
            Start start = make_start(settings);
            Summarizer summarize(start.marbles.size());
            const int steps = int(0.5f / start.dt_s);
            std::vector<double> seconds;
            float deepest_m = 0;
            for (int step = 0; step < steps; step += 10) {
                seconds.push_back(
                    time_steps(start.marbles, start.dt_s, 1, 5).median_s);  // twice 5: one to warm up
                deepest_m = std::max(deepest_m, summarize(start.marbles).deepest_m);
            }
            study.add({name, factor, double(settings.particles),
                       deepest_m / start.marbles.material().diameter_m, course::timing_of(seconds),
                       double(steps)});
        }
}
//! [overlap]

inline void study_skin(course::Study& study) {
    course::on_device(study);
    const std::vector<float> skins =
        study.quick ? std::vector<float>{0.05f, 0.2f, 0.4f, 0.8f}
                    : std::vector<float>{0.03f, 0.06f, 0.1f, 0.2f, 0.3f, 0.4f, 0.6f, 0.8f};
    const std::vector<std::string> scenes{"drop", "dam_break"};
    study.expect(int(scenes.size() * skins.size()));
    for (const std::string& name : scenes)
        for (const float skin : skins) {
            Settings settings;
            settings.scene = find_scene(all_scenes(), name);
            settings.particles = study.quick ? 2000 : 8192;
            settings.skin = skin;
            Start start = make_start(settings);
            // 0.3 s: the block has hit the floor, or is on its way to the other wall.
            const int steps = int(0.3f / start.dt_s), repeats = 5;
            const course::Timing timing =
                time_steps(start.marbles, start.dt_s, repeats, steps / (repeats + 1));
            study.add({name, skin, double(settings.particles), 0, timing, double(steps)});
        }
}

}  // namespace spring_mass
