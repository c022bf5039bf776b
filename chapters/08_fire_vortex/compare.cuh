/// @file
/// The two fires side by side: chapter 07's particles that know nothing of each other, and the same particles
/// from the same place in the flow of vortons.
#pragma once
#include <chrono>

#include "08_fire_vortex/explain.h"
#include "08_fire_vortex/vortex_view.cuh"
#include "common/program.h"

namespace vortex {

/// Mean seconds of `steps` calls, kernels finished.
template <class Step>
double seconds_per_step(int steps, Step&& step) {
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < steps; ++k) step();
    CUDA_CHECK(cudaDeviceSynchronize());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
           std::max(1, steps);
}

/// What the comparison found.
struct TwoFires {
    course::Image side_by_side, shading;
    course::Table table{"Two fires: the same emitter, as many particles, the same time",
                        {"model", "particles", "ms per step", "steps per s of fire", "s per s of fire",
                         "kernels a step", "bytes a particle", "bytes besides"}};
};

//! [compare]
/// @param stirred   a vortex fire that burns
/// @param stirred_s what a step of it takes
inline TwoFires compare_fires(SharedVortexFire& stirred, double stirred_s, std::uint64_t seed, int width_px,
                              int height_px) {
    const VortexScene& scene = stirred.scene();
    const std::uint32_t particles = stirred.vortons().particles();
    fire::FireScene plain_scene = fire::make_scene("campfire", particles, seed);
    plain_scene.fire.kind[0].emitter = scene.fire.fire.kind[0].emitter;
    plain_scene.stage = scene.fire.stage;
    const course::Camera camera = fire::camera_of(scene.fire);

    fire::SharedFire plain(plain_scene);
    fire::FireView plain_view(plain_scene, width_px / 2, height_px);
    const double plain_s =
        seconds_per_step(int(std::ceil(stirred.time_s() / plain_scene.dt_s)), [&] { plain.step(); });
    plain_view.draw(plain, camera);
    VortexView stirred_view(scene, width_px / 2, height_px);
    stirred_view.draw(stirred, camera);
    const course::Image shaded = stirred_view.image();
    stirred_view.draw(stirred, camera, false);

    TwoFires result;
    result.side_by_side = course::contact_sheet({plain_view.image(), shaded}, 2);
    result.shading = course::contact_sheet({stirred_view.image(), shaded}, 2);
    int kernels = 0;
    for (const auto& launch : launches_per_step(scene, stirred.vortons().flow().grid.size))
        kernels += launch.second;
    const auto row = [&](const char* model, std::size_t n, double seconds, float dt_s, int launches,
                         std::size_t besides) {
        result.table.row(
            {model, n, 1e3 * seconds, 1 / dt_s, seconds / dt_s, launches, fire::kFlameBytes, besides});
    };
    row("non-interacting", plain.size(), plain_s, plain_scene.dt_s, 1, 0);
    row("velocity-vortex", particles, stirred_s, scene.fire.dt_s, kernels,
        vorton_bytes(scene.model) + stirred.vortons().grid_bytes());
    return result;
}
//! [compare]

}  // namespace vortex
