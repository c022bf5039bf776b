/// @file
/// Error against run time: the step, the cells, skipping, and sprites against the volume. The error is always
/// that of the fire's own light and shadow, in linear light, against a picture that took far more time.
#pragma once
#include <cmath>

#include "13_volume_rendering/sprites.cuh"
#include "13_volume_rendering/volume_scene.cuh"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace volume {

using Light = std::vector<float4>;

//! [rmse]
/// Root of the mean square difference of light and transmittance, in units of the root mean square light of
/// the answer: 0.01 is one percent of a typical bright pixel.
inline double picture_error(const Light& got, const Light& answer, bool with_transmittance = true) {
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < answer.size(); ++i) {
        const double r = double(got[i].x) - answer[i].x, g = double(got[i].y) - answer[i].y;
        const double b = double(got[i].z) - answer[i].z, t = double(got[i].w) - answer[i].w;
        difference += r * r + g * g + b * b + (with_transmittance ? t * t : 0);
        size += double(answer[i].x) * answer[i].x + double(answer[i].y) * answer[i].y +
                double(answer[i].z) * answer[i].z;
    }
    return size > 0 ? std::sqrt(difference / size) : std::sqrt(difference);
}
//! [rmse]

/// A campfire of which pictures are made: particles that have burnt for a while, and a small camera.
struct StudyFire {
    VolumeScene scene;
    Particles particles;
    Lens lens;
    course::DeviceBuffer<float4> seen;

    explicit StudyFire(bool quick)
        : scene(make_scene("campfire", quick ? 4000 : 20000, 1)),
          particles(scene),
          lens(make_lens(camera_of(scene), quick ? 160 : 320, quick ? 90 : 180)),
          seen(std::size_t(lens.width) * lens.height) {
        for (int k = 0; k < scene.warm_up_steps; ++k) particles.step();
        scene.look.solid = false;
        if (quick) scene.look.cell_m = 0.025f;
    }
    void fill(FireVolume& fire) const {
        fire.fill(particles.position(), particles.velocity(), particles.size());
    }
    Light draw(const FireVolume& fire) {
        fire.draw(seen.data(), lens);
        return seen.download();
    }
    /// Filling the grid is part of the price.
    course::Timing time_picture(FireVolume& volume) {
        return course::time_work(3, [&] {
            fill(volume);
            volume.draw(seen.data(), lens);
            CUDA_CHECK(cudaDeviceSynchronize());
        });
    }
    course::Timing time_draw(const FireVolume& fire, int repeats) {
        return course::time_work(repeats, [&] {
            fire.draw(seen.data(), lens);
            CUDA_CHECK(cudaDeviceSynchronize());
        });
    }
};

inline course::StudyQuestion step_size_question() {
    return {"step_size", "How long may the steps of the march be, and by which rule?",
            "RMS difference of light and transmittance from a march with steps of 1/64 cell, relative to the "
            "RMS light",
            "step_in_cells"};
}

inline void study_step_size(course::Study& study) {
    course::on_device(study);
    StudyFire fire(study.quick);
    VolumeLook look = fire.scene.look;
    look.enough = 0;
    FireVolume volume(look);
    fire.fill(volume);
    const std::vector<float> steps =
        study.quick ? std::vector<float>{4, 1, 0.25f} : std::vector<float>{8, 4, 2, 1, 0.5f, 0.25f, 0.125f};
    study.expect(int(3 * steps.size()));
    volume.look().step_in_cells = study.quick ? 1 / 16.0f : 1 / 64.0f;
    const Light answer = fire.draw(volume);
    const int repeats = study.quick ? 3 : 5;
    const auto measure = [&](auto rule, const char* name) {
        for (const float step : steps) {
            const auto draw = [&] {
                launch_march<decltype(rule)::value>(fire.seen.data(), volume.field<true, true>(), fire.lens,
                                                    {step * look.cell_m, 0});
                CUDA_CHECK(cudaDeviceSynchronize());
            };
            const course::Timing time = course::time_work(repeats, draw);
            study.add({name, step, double(fire.lens.width * fire.lens.height),
                       picture_error(fire.seen.download(), answer), time, 1});
        }
    };
    measure(std::integral_constant<StepRule, StepRule::exponential>{}, "1 - exp(-sigma dx)");
    measure(std::integral_constant<StepRule, StepRule::proportional>{}, "sigma dx");
    measure(std::integral_constant<StepRule, StepRule::midpoint>{}, "from the middle");
}

inline course::StudyQuestion grid_resolution_question() {
    return {"grid_resolution",
            "How small must the cells be, and is the time better spent on cells or on steps?",
            "RMS difference of light and transmittance from a picture with cells of 9 mm (quick: 20 mm), "
            "relative to the RMS light",
            "cell_m"};
}

inline void study_grid_resolution(course::Study& study) {
    course::on_device(study);
    StudyFire fire(study.quick);
    VolumeLook look = fire.scene.look;
    look.detail.reach_m = 0;  // detail is there to hide the cells: here we want to see them
    const auto time_picture = [&](float cell_m, float step_in_cells, Light& light) {
        look.cell_m = cell_m;
        look.step_in_cells = step_in_cells;
        FireVolume volume(look);
        const course::Timing time = fire.time_picture(volume);
        light = fire.seen.download();
        return time;
    };
    // With 1 cm the smoke's largest particles, of 0.12 m, reach over 25 cells: the table ends at 32.
    const std::vector<float> cells =
        study.quick ? std::vector<float>{0.1f, 0.05f, 0.03f}
                    : std::vector<float>{0.1f, 0.07f, 0.05f, 0.035f, 0.025f, 0.018f, 0.0125f};
    study.expect(int(2 * cells.size()));
    Light answer, light;
    look.light_edge = 0;  // its cells grow with the grid's; the study is about the fire's own
    time_picture(study.quick ? 0.02f : 0.009f, 0.125f, answer);
    for (const float step : {0.5f, 2.0f})
        for (const float cell_m : cells) {
            const course::Timing time = time_picture(cell_m, step, light);
            study.add({step < 1 ? "steps of half a cell" : "steps of two cells", cell_m,
                       std::ceil(1.8 / cell_m) * std::ceil(2.5 / cell_m) * std::ceil(1.6 / cell_m),
                       picture_error(light, answer), time, 1});
        }
}

inline course::StudyQuestion skipping_question() {
    return {"skipping", "What does it save to leave out what is empty, and what cannot be seen?",
            "RMS difference of light and transmittance from the march that leaves out nothing, relative to "
            "the RMS light",
            "largest_transmittance_left_out"};
}

inline void study_skipping(course::Study& study) {
    course::on_device(study);
    StudyFire fire(study.quick);
    const std::vector<float> ends{0.3f, 0.1f, 0.03f, 0.01f, 0.001f};
    const std::vector<int> edges = study.quick ? std::vector<int>{0, 8} : std::vector<int>{0, 4, 8, 16};
    study.expect(int(ends.size() * edges.size()));
    Light answer;
    for (const int edge : edges) {
        VolumeLook look = fire.scene.look;
        look.block_edge = edge;
        FireVolume volume(look);
        fire.fill(volume);
        volume.look().enough = 0;
        if (answer.empty()) answer = fire.draw(volume);  // edge 0 comes first: it leaves out nothing
        for (const float end : ends) {
            volume.look().enough = end;
            const course::Timing time = fire.time_draw(volume, study.quick ? 3 : 5);
            study.add({edge == 0 ? "no blocks" : "blocks of " + std::to_string(edge) + " cells", end,
                       double(fire.lens.width * fire.lens.height),
                       picture_error(fire.seen.download(), answer), time, 1});
        }
    }
}

inline course::StudyQuestion sprites_question() {
    return {
        "sprites", "At equal time, what is nearer to the converged picture: sprites, or a volume?",
        "RMS difference of light from the converged volume (steps of 1/16 cell), relative to the RMS light",
        "particles_or_step_in_cells"};
}

inline void study_sprites(course::Study& study) {
    course::on_device(study);
    StudyFire fire(study.quick);
    VolumeLook look = fire.scene.look;
    look.light_edge = 0;  // sprites have no scattered light either
    const std::vector<float> steps =
        study.quick ? std::vector<float>{4, 1, 0.5f} : std::vector<float>{8, 4, 2, 1, 0.5f};
    const std::vector<int> parts = study.quick ? std::vector<int>{16, 4, 1} : std::vector<int>{64, 16, 4, 1};
    study.expect(int(2 * steps.size() + parts.size()));
    Light answer;
    for (const float cell_m : {look.cell_m, 2.5f * look.cell_m}) {
        VolumeLook this_look = look;
        this_look.cell_m = cell_m;
        FireVolume volume(this_look);
        if (answer.empty()) {
            fire.fill(volume);
            volume.look().enough = 0;
            volume.look().step_in_cells = 1 / 16.0f;
            answer = fire.draw(volume);
            volume.look().enough = look.enough;
        }
        for (const float step : steps) {
            volume.look().step_in_cells = step;
            const course::Timing time = fire.time_picture(volume);
            study.add({cell_m > look.cell_m ? "volume, coarse cells" : "volume", step,
                       double(fire.particles.size()), picture_error(fire.seen.download(), answer, false),
                       time, 1});
        }
    }
    // Every 64th, 16th, 4th, or all of the particles, with as much more light each. A copy of the arrays
    // keeps each k-th particle of each kind and lets the others be unborn.
    SpriteDrawer sprites(fire.lens.width, fire.lens.height);
    const fire::SpriteLook flame = fire::campfire(100).looks[0];
    const glm::vec2 temperature_K(flame.temperature_start_K, flame.temperature_end_K);
    for (const int part : parts) {
        std::vector<float4> x = fire.particles.positions().download(),
                            v = fire.particles.velocities().download();
        std::vector<float4> some_x, some_v;
        Cargos cargos = look.cargos;
        for (int k = 0; k < cargos.count; ++k) {
            const std::uint32_t begin = look.cargos.first[k];
            const std::uint32_t end =
                k + 1 < cargos.count ? look.cargos.first[k + 1] : std::uint32_t(x.size());
            cargos.first[k] = std::uint32_t(some_x.size());
            for (std::uint32_t i = begin; i < end; i += part) some_x.push_back(x[i]), some_v.push_back(v[i]);
        }
        const course::DeviceBuffer<float4> position(some_x), velocity(some_v);
        const auto draw = [&](float gain) {
            sprites.draw(fire.seen.data(), position.data(), velocity.data(), std::uint32_t(some_x.size()),
                         cargos, look.gas, temperature_K, fire.lens, gain);
            CUDA_CHECK(cudaDeviceSynchronize());
        };
        // Their best chance: the gain with the smallest error, by least squares.
        draw(1);
        double product = 0, square = 0;
        const Light unit = fire.seen.download();
        for (std::size_t i = 0; i < unit.size(); ++i) {
            product += double(unit[i].x) * answer[i].x + double(unit[i].y) * answer[i].y +
                       double(unit[i].z) * answer[i].z;
            square +=
                double(unit[i].x) * unit[i].x + double(unit[i].y) * unit[i].y + double(unit[i].z) * unit[i].z;
        }
        const float gain = square > 0 ? float(product / square) : 1.0f;
        const course::Timing time = course::time_work(5, [&] { draw(gain); });
        study.add({"sprites", double(some_x.size()), double(some_x.size()),
                   picture_error(fire.seen.download(), answer, false), time, 1});
    }
}

}  // namespace volume
