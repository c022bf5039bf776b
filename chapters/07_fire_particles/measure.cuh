/// @file
/// What the parts of a frame cost, and what sorted smoke costs.
#pragma once
#include <cmath>

#include "07_fire_particles/fire_view.cuh"
#include "common/result.h"
#include "common/timing.h"

namespace fire {

/// Milliseconds of `work`, kernels and drawing finished: the median of `repeats`.
template <class Work>
double milliseconds(int repeats, Work&& work) {
    const course::Timing timing = course::time_work(repeats, [&] {
        work();
        CUDA_CHECK(cudaDeviceSynchronize());
        glFinish();  // OpenGL has only been told what to do
    });
    return 1e3 * timing.median_s;
}

/// Root mean square of the difference, in steps of the 255 that a colour has.
inline double difference(const course::Image& a, const course::Image& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.rgb.size(); ++k) sum += double(a.rgb[k] - b.rgb[k]) * (a.rgb[k] - b.rgb[k]);
    return std::sqrt(sum / double(a.rgb.size()));
}

inline course::Table cost_table(int width_px, int height_px) {
    return {"Milliseconds in " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                " pixels: median of 3",
            {"scene", "particles", "step", "stage and film", "flames", "smoke sorted", "smoke unsorted",
             "picture error unsorted (of 255)"}};
}

//! [cost]
/// One row of cost_table(): the fire as it is now.
inline void add_cost(course::Table& table, SharedFire& fire, FireView& sorted, FireView& unsorted) {
    constexpr int kRepeats = 3;
    const course::Camera camera = camera_of(fire.scene());
    bool smoke = false;
    for (const SpriteLook& look : fire.scene().looks) smoke = smoke || look.blend == Blend::alpha;
    const auto begin = [&] { sorted.renderer().begin(camera, lights_at(fire.scene(), fire.time_s())); };
    const double stage = milliseconds(kRepeats, [&] {
        begin();
        sorted.renderer().finish();
    });
    const double flames = milliseconds(kRepeats, [&] { sorted.draw_kinds(fire, Blend::additive, camera); });
    double in_order = 0, out_of_order = 0, error = 0;
    if (smoke) {
        begin();
        in_order = milliseconds(kRepeats, [&] { sorted.draw_kinds(fire, Blend::alpha, camera); });
        unsorted.draw(fire, camera);
        out_of_order = milliseconds(kRepeats, [&] { unsorted.draw_kinds(fire, Blend::alpha, camera); });
        unsorted.draw(fire, camera);
        sorted.draw(fire, camera);
        error = difference(sorted.image(), unsorted.image());
    }
    const double step = milliseconds(kRepeats, [&] { fire.step(); });
    table.row({fire.scene().name, fire.size(), step, stage, flames, in_order, out_of_order, error});
}
//! [cost]

}  // namespace fire
