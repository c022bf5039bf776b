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

constexpr float kSlice_m = 0.03f;  ///< half the thickness of a slice through the flames
/// What is red on the maps of what vortons know.
constexpr float kMapVorticity_per_s = 20, kMapSpeed_m_per_s = 2.5f;

/// What the comparison found.
struct TwoFires {
    course::Image side_by_side, shading;
    course::Table table{"Two fires: the same emitter, as many particles, the same time",
                        {"model", "particles", "ms per step", "steps per s of fire", "s per s of fire",
                         "kernels a step", "bytes a particle", "bytes besides"}};
};

/// One slice through the flames four times: lit evenly, lit by vorticity, and what the vortons know there:
/// vorticity, speed.
inline course::Image what_vortons_know(SharedVortexFire& fire, int width_px, int height_px) {
    const VortexScene& scene = fire.scene();
    course::Camera near = fire::camera_of(scene.fire);
    near.target_m.y = 0.42f;
    near.eye_m = glm::mix(near.target_m, near.eye_m, 0.55f);
    VortexView view(scene, std::max(1, width_px / 2), std::max(1, height_px / 2));
    std::vector<course::Image> pictures;
    Shading by_vorticity = scene.shading;
    by_vorticity.slice_m = kSlice_m;
    for (const Shading& shading : {Shading{1, 1, 1, kSlice_m}, by_vorticity}) {
        view.draw(fire, near, shading);
        pictures.push_back(view.image());
    }
    view.draw_map<Known::vorticity>(fire, near, kMapVorticity_per_s, kSlice_m);
    pictures.push_back(view.image());
    view.draw_map<Known::speed>(fire, near, kMapSpeed_m_per_s, kSlice_m);
    pictures.push_back(view.image());
    return course::contact_sheet(pictures, 2);
}

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

    TwoFires result;
    result.side_by_side = course::contact_sheet({plain_view.image(), stirred_view.image()}, 2);
    result.shading = what_vortons_know(stirred, width_px, height_px);
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
