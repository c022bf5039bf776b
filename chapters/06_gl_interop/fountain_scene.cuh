/// @file
/// What a run of this chapter's program shows, and what follows from that: arrays, kernels, OpenGL objects.
#pragma once
#include <string>

#include "06_gl_interop/particle_renderer.h"
#include "06_gl_interop/shared_fountain.cuh"

namespace interop {

constexpr float kDropletRadius_m = 0.012f;  // as drawn; droplets do not touch each other

struct FountainScene {
    bool points = true, spheres = true;  ///< pictures to make; neither: numbers alone
    Handover handover = Handover::shared;

    bool draws() const { return points || spheres; }
};

/// What a scene needs for its droplets. Tests hold it against what a run really makes.
struct Needs {
    int kernels_per_step = 1;
    int gl_buffers = 0;
    std::size_t device_bytes_per_droplet = 0;  ///< from cudaMalloc
    std::size_t gl_bytes_per_droplet = 0;
    std::size_t copied_bytes_per_droplet = 0;  ///< each step, device to host, and again host to OpenGL
};
//! [needs]
inline Needs needs(const FountainScene& scene) {
    constexpr std::size_t kState = 2 * sizeof(float4);  // position and age, velocity
    Needs needs;
    if (scene.draws()) {
        needs.gl_buffers = 2;
        needs.gl_bytes_per_droplet = kState;
    }
    if (!scene.draws() || scene.handover == Handover::copied) needs.device_bytes_per_droplet = kState;
    if (scene.draws() && scene.handover == Handover::copied) needs.copied_bytes_per_droplet = kState;
    return needs;
}
//! [needs]

/// The answer to --explain.
inline std::string explain(const FountainScene& scene) {
    const Needs n = needs(scene);
    std::string text =
        "each step: " + std::to_string(n.kernels_per_step) + " kernel (fountain_step_float4_kernel)\n";
    text += "each droplet: " + std::to_string(n.device_bytes_per_droplet) + " bytes from cudaMalloc, " +
            std::to_string(n.gl_bytes_per_droplet) + " bytes in " + std::to_string(n.gl_buffers) +
            " OpenGL buffers, " + std::to_string(n.copied_bytes_per_droplet) + " bytes copied each step\n";
    if (scene.points) text += "points: 2 passes (backdrop, points)\n";
    if (scene.spheres) text += "spheres: 3 passes (shadow map, surface, lighting)\n";
    if (!scene.draws()) text += "left out: OpenGL, its context and all its objects, since nothing is drawn\n";
    if (scene.draws() && scene.handover == Handover::shared)
        text += "left out: device arrays and copies (made only if CUDA can't use OpenGL's buffers)\n";
    if (scene.points && !scene.spheres)
        text += "left out: surface buffer, shadow map, lighting (points need none)\n";
    if (scene.draws()) text += "left out: colour array (colour follows from speed), tank edges\n";
    return text + "left out: neighbours and grid (droplets do not touch)\n";
}

inline Look fountain_look(Drawing drawing) {
    Look look;
    look.drawing = drawing;
    look.palette = {{glm::vec3(0.010f, 0.100f, 0.290f), glm::vec3(0.030f, 0.260f, 0.500f),
                     glm::vec3(0.260f, 0.600f, 0.760f), glm::vec3(0.86f, 0.93f, 0.96f)},
                    7.0f};
    look.region = {{-2.6f, 0, -2.6f}, {2.6f, 3.4f, 2.6f}};
    look.floor_tile_m = 1;
    look.occlusion_radii = 4;
    return look;
}

inline course::OrbitCamera first_view() {
    course::OrbitCamera orbit;
    orbit.target_m = {0, 1.05f, 0};
    orbit.distance_m = 8;
    orbit.yaw_rad = 0.05f;
    orbit.pitch_rad = 0.31f;
    return orbit;
}

inline void draw(ParticleRenderer& renderer, const SharedFountain& fountain, const course::Camera& camera) {
    renderer.draw(fountain.position().gl_buffer(), &fountain.velocity().gl_buffer(), fountain.born(),
                  kDropletRadius_m, camera);
}

}  // namespace interop
