/// @file
/// What this chapter measures: the price of the copy, and what samples buy.
#pragma once
#include <algorithm>
#include <chrono>
#include <cmath>

#include "06_gl_interop/fountain_scene.cuh"
#include "common/program.h"
#include "common/result.h"

namespace interop {

struct Measurement {
    int width_px, height_px;
    int repeats;
};

/// Wall-clock milliseconds of `work`. Wall clock, since a frame is the work of CUDA, OpenGL and the host.
template <class Work>
double milliseconds(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    CUDA_CHECK(cudaDeviceSynchronize());
    glFinish();  // OpenGL has only been told what to do
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

/// All droplets in flight, as they are in a fountain that has run for a while.
inline void grow(SharedFountain& fountain, const particle_loop::Fountain& scene) {
    for (std::uint32_t step = 0; step < life_steps(scene); ++step) fountain.step();
}

/// Times of the parts of a frame.
struct FrameTimes {
    std::vector<double> step_ms, draw_ms;

    void add(SharedFountain& fountain, ParticleRenderer& renderer) {
        step_ms.push_back(milliseconds([&] { fountain.step(); }));
        draw_ms.push_back(milliseconds([&] { draw(renderer, fountain, first_view().camera()); }));
    }
    void add_row(course::Table& table, const SharedFountain& fountain) const {
        const bool copied = fountain.position().handover() == Handover::copied;
        const double copied_MB = copied ? 2e-6 * sizeof(float4) * fountain.size() : 0;
        const double least_ms = *std::min_element(step_ms.begin(), step_ms.end());
        table.row({fountain.size(), copied ? "copy" : "no copy", copied_MB, median(step_ms), least_ms,
                   median(draw_ms)});
    }
};

/// Copy against no copy, for a sixteenth, a quarter, and all of the particles.
inline course::Table measure_handover(const Measurement& m, std::uint32_t particles,
                                      const FountainScene& scene, const particle_loop::Fountain& fountain) {
    course::Table table(
        "Milliseconds per frame: median of " + std::to_string(m.repeats) + ", copy and no copy by turns",
        {"droplets", "handover", "copied (MB)", "step and handover", "at best", "draw points"});
    course::Progress progress("measuring", 3);
    ParticleRenderer renderer(m.width_px, m.height_px, fountain_look(Drawing::points));
    for (int size = 0; size < 3; ++size) {
        const std::uint32_t n = std::max(1u, particles >> (2 * (2 - size)));
        SharedFountain wanted(n, fountain, scene.handover), copied(n, fountain, Handover::copied);
        grow(wanted, fountain);
        grow(copied, fountain);
        FrameTimes wanted_times, copied_times, warm_up;
        warm_up.add(wanted, renderer);
        warm_up.add(copied, renderer);
        for (int k = 0; k < m.repeats; ++k) {  // by turns: what slows the machine slows both
            wanted_times.add(wanted, renderer);
            copied_times.add(copied, renderer);
        }
        if (wanted.position().handover() == Handover::shared) wanted_times.add_row(table, wanted);
        copied_times.add_row(table, copied);
        progress.update(size + 1);
    }
    return table;
}

/// Root mean square of the difference, in steps of the 255 that a colour has.
inline double difference(const course::Image& a, const course::Image& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.rgb.size(); ++k) sum += (a.rgb[k] - b.rgb[k]) * (a.rgb[k] - b.rgb[k]);
    return std::sqrt(sum / double(a.rgb.size()));
}

/// Error against time of the sphere pictures: samples a pixel, against a picture with 36 of them.
inline course::Table measure_samples(const Measurement& m, const SharedFountain& fountain) {
    const int width = std::min(m.width_px, 640), height = std::min(m.height_px, 360);
    const auto make = [&](int samples_per_axis) {
        Look look = fountain_look(Drawing::spheres);
        look.samples_per_axis = samples_per_axis;
        return ParticleRenderer(width, height, look);
    };
    const auto picture = [&](ParticleRenderer& renderer) {
        draw(renderer, fountain, first_view().camera());
        return renderer.image();
    };
    ParticleRenderer best = make(6);
    const course::Image reference = picture(best);
    course::Table table("Spheres in " + std::to_string(width) + " x " + std::to_string(height) +
                            " pixels: error against time (median of 3)",
                        {"samples a pixel", "error (of 255)", "ms per frame"});
    for (int samples_per_axis = 1; samples_per_axis <= 4; ++samples_per_axis) {
        ParticleRenderer renderer = make(samples_per_axis);
        const double error = difference(picture(renderer), reference);
        std::vector<double> times;
        for (int k = 0; k < 3; ++k)
            times.push_back(milliseconds([&] { draw(renderer, fountain, first_view().camera()); }));
        table.row({samples_per_axis * samples_per_axis, error, median(times)});
    }
    return table;
}

}  // namespace interop
