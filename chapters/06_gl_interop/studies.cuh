/// @file
/// What this chapter's studies ask: how to draw spheres (error of the picture against the time of a frame),
/// and what the copy costs that it does without.
#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "01_particle_loop/scenes.h"
#include "01_particle_loop/stopwatch.h"
#include "06_gl_interop/measure.cuh"
#include "common/gl_context.h"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace interop {

// ------------------------------------------------------------------------------------------------- spheres

/// Droplets far larger than this chapter's own: a sphere is some six pixels wide, so that its shape counts.
struct SpherePicture {
    int width_px = 640, height_px = 360;
    float radius_m = 0.05f;
    Look look = fountain_look(Drawing::spheres);

    ParticleRenderer renderer() const { return {width_px, height_px, look}; }
    void draw(ParticleRenderer& renderer, const SharedFountain& fountain) const {
        renderer.draw(fountain.position().gl_buffer(), &fountain.velocity().gl_buffer(), fountain.born(),
                      radius_m, first_view().camera());
    }
};

/// One way to draw the spheres.
struct Contender {
    std::string method;
    ParticleRenderer renderer;
};

/// Impostors, triangles and points against the picture that takes 36 rays a pixel.
inline void study_spheres(course::Study& study) {
    const auto context = course::make_headless_context();
    study.backend = "opengl";
    study.device = context->info().renderer;
    const particle_loop::Fountain scene = particle_loop::make_scene("crown");
    SharedFountain fountain(study.quick ? 1024 : 4096, scene);
    grow(fountain, scene);

    SpherePicture picture;
    if (study.quick) picture.width_px = 320, picture.height_px = 180;
    picture.look.samples_per_axis = 6;
    ParticleRenderer best = picture.renderer();
    picture.draw(best, fountain);
    const course::Image reference = best.image();

    const int most_samples = study.quick ? 3 : 4;
    study.expect(4 * most_samples + 1);
    for (int samples = 1; samples <= most_samples; ++samples) {
        picture.look.samples_per_axis = samples;
        std::vector<Contender> contenders;
        const auto enter = [&](const std::string& method, int mesh_rings) {
            picture.look.mesh_rings = mesh_rings;
            contenders.push_back({method, picture.renderer()});
        };
        enter("impostors", 0);
        enter("16 triangles", 2);
        enter("64 triangles", 4);
        enter("256 triangles", 8);
        if (samples == 1) {
            SpherePicture points = picture;
            points.look = fountain_look(Drawing::points);
            contenders.push_back({"points", points.renderer()});
        }
        std::vector<std::function<void()>> frames;
        for (Contender& c : contenders)
            frames.push_back([&] {
                picture.draw(c.renderer, fountain);
                finish();
            });
        const std::vector<course::Timing> timings = particle_loop::by_turns(study.quick ? 3 : 7, frames);
        for (std::size_t k = 0; k < contenders.size(); ++k)
            study.add({contenders[k].method, double(samples) * samples, double(fountain.size()),
                       difference(contenders[k].renderer.image(), reference), timings[k]});
    }
}

// ------------------------------------------------------------------------------------------------ handover

/// Bytes of two OpenGL buffers that differ.
inline double different_bytes(const course::GlBuffer& a, const course::GlBuffer& b) {
    const auto bytes_of = [](const course::GlBuffer& buffer) {
        std::vector<unsigned char> bytes(buffer.bytes());
        glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
        glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(bytes.size()), bytes.data());
        return bytes;
    };
    const std::vector<unsigned char> p = bytes_of(a), q = bytes_of(b);
    double different = 0;
    for (std::size_t k = 0; k < p.size(); ++k) different += p[k] != q[k];
    return different;
}

/// A step and its handover to OpenGL, with no copy and through the host, for a growing number of droplets.
inline void study_handover(course::Study& study) {
    const auto context = course::make_headless_context();
    course::on_device(study);
    study.device += " and " + context->info().renderer;
    std::vector<std::uint32_t> sizes{1u << 12, 1u << 14, 1u << 16, 1u << 18};
    if (!study.quick) sizes.push_back(1u << 20);
    study.expect(2 * int(sizes.size()));
    const particle_loop::Fountain scene = particle_loop::make_scene("crown");
    for (const std::uint32_t n : sizes) {
        SharedFountain shared(n, scene, Handover::shared), copied(n, scene, Handover::copied);
        grow(shared, scene);
        grow(copied, scene);
        const int steps = int(std::max(1u, (1u << 16) / n));
        const auto steps_of = [&](SharedFountain& fountain) {
            return [&fountain, steps] {
                for (int k = 0; k < steps; ++k) fountain.step();
                finish();
            };
        };
        const std::vector<course::Timing> timings =
            particle_loop::by_turns(study.quick ? 5 : 15, {steps_of(shared), steps_of(copied)});
        const double different =
            different_bytes(shared.position().gl_buffer(), copied.position().gl_buffer()) +
            different_bytes(shared.velocity().gl_buffer(), copied.velocity().gl_buffer());
        // Where CUDA can't use this OpenGL's buffers, both rows are copies, and the first says so.
        const bool really_shared = shared.position().handover() == Handover::shared;
        study.add({really_shared ? "no copy" : "no copy (refused: copied)", double(n), double(n), different,
                   timings[0].per(steps)});
        study.add({"copy through the host", double(n), double(n), different, timings[1].per(steps)});
    }
}

}  // namespace interop
