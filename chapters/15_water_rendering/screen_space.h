/// @file
/// A surface without a mesh: the particles' spheres as depths in the picture, smoothed there.
#pragma once
#include "15_water_rendering/mesh_pass.h"

namespace water {

/// How screen-space water is made. Lengths in spacings of the particles.
struct ScreenSettings {
    float radius = 0.95f;  ///< of a sphere: neighbours overlap, so that no hole shows
    float reach = 2.4f;    ///< of the filter
    float narrow = 2.5f;   ///< steps in depth above this are edges
    int rounds = 3;        ///< of the filter, each across and up
};

/// Draws a FirstSurface from particles in a buffer.
class ScreenSpace {
  public:
    ScreenSpace(int width_px, int height_px, const ScreenSettings& settings = {})
        : settings_(settings),
          depth_(width_px, height_px, GL_R32F, Framebuffer::Depth::float32),
          between_(width_px, height_px, GL_R32F, Framebuffer::Depth::none),
          spheres_({"sphere_impostor.vert", "screen_depth.frag"}),
          chords_({"sphere_impostor.vert", "screen_thickness.frag"}),
          smooth_({"fullscreen.vert", "screen_smooth.frag"}),
          surface_({"fullscreen.vert", "screen_surface.frag"}) {}

    //! [screen_space]
    void draw(const FirstSurface& to, GLuint positions, std::size_t count, float spacing_m, const Shot& shot,
              const WholePicture& whole) {
        glBindVertexArray(particles_.id());
        glBindBuffer(GL_ARRAY_BUFFER, positions);
        glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(0);
        glVertexAttribDivisor(0, 1);  // one position an instance, that is, a sphere
        glVertexAttrib4f(1, 0, 0, 0, 0);
        glClearColor(0, 0, 0, 0);

        depth_.bind();
        glEnable(GL_DEPTH_TEST);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        draw_spheres(spheres_, count, spacing_m, shot);
        glDisable(GL_DEPTH_TEST);

        to.thickness->bind();
        glClear(GL_COLOR_BUFFER_BIT);
        {
            const Adding adding;
            draw_spheres(chords_, count, spacing_m, shot);
        }
        smooth_.use();
        smooth_.set("reach_m", settings_.reach * spacing_m);
        smooth_.set("narrow_m", settings_.narrow * spacing_m);
        smooth_.set("pixels_per_rad", float(shot.height_px) / shot.camera.field_of_view_rad);
        smooth_.set("depth_m", int(kInputUnit));
        for (int round = 0; round < settings_.rounds; ++round) {
            filter(depth_, between_, {1, 0}, whole);
            filter(between_, depth_, {0, 1}, whole);
        }
        to.surface.bind();
        surface_.use();
        shot.set(surface_);
        depth_.colour().bind(kInputUnit);
        surface_.set("depth_m", int(kInputUnit));
        whole.draw();
    }
    //! [screen_space]

  private:
    void draw_spheres(const ShaderProgram& p, std::size_t count, float spacing_m, const Shot& shot) const {
        const float radius_m = settings_.radius * spacing_m;
        p.use();
        shot.set(p);
        p.set("radius_m", radius_m);
        // A particle's cube of water, spread over its sphere.
        constexpr float kSphere = 4.18879f;  // volume of a sphere of radius 1
        p.set("water_per_chord", 1 / (kSphere * settings_.radius * settings_.radius * settings_.radius));
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(count));
    }
    void filter(const Framebuffer& from, const Framebuffer& to, glm::vec2 along, const WholePicture& whole) {
        to.bind();
        from.colour().bind(kInputUnit);
        smooth_.set("along", along);
        whole.draw();
    }

    ScreenSettings settings_;
    Framebuffer depth_, between_;
    ShaderProgram spheres_, chords_, smooth_, surface_;
    course::VertexArray particles_;
};

}  // namespace water
