/// @file
/// Draws particles whose positions lie in an OpenGL buffer: as points, or as lit spheres.
#pragma once
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <stdexcept>

#include "06_gl_interop/look.h"
#include "common/camera.h"
#include "common/gl_target.h"
#include "common/shader.h"

namespace interop {

/// Owns the shaders and the framebuffers of one look at one picture size. Needs a current context.
class ParticleRenderer {
  public:
    /// @throws course::BadInput if a shader does not compile or the picture is too large for the driver
    ParticleRenderer(int width_px, int height_px, const Look& look);

    /// Draws `count` particles.
    /// @param position float4 each: xyz in metres, w not used
    /// @param velocity float4 each: xyz in m/s, gives the colour; nullptr: all have the colour of rest
    /// @throws std::logic_error if a buffer is too small, or if OpenGL knows it to be mapped
    /// @throws std::runtime_error naming the OpenGL error
    void draw(const course::GlBuffer& position, const course::GlBuffer* velocity, std::size_t count,
              float radius_m, const course::Camera& camera);

    /// What draw() left: sRGB colours and a depth.
    const course::Framebuffer& picture() const { return picture_; }
    course::Image image() const { return course::read_image(picture_); }
    /// Spheres only: normal and speed as colour, and depth, with samples_per_axis texels a pixel and axis.
    const course::Framebuffer& surface() const { return surface_.value(); }

  private:
    using Program = course::ShaderProgram;
    void bind_particles(const course::GlBuffer& position, const course::GlBuffer* velocity);
    void bind_float4(GLuint input, const course::GlBuffer& buffer);
    void draw_shadow_map(GLsizei count, float radius_m);
    void draw_surface(GLsizei count, float radius_m);
    void light_surface(float radius_m);
    void draw_backdrop();
    void draw_points(GLsizei count, float radius_m);
    void draw_edges();
    void draw_whole_picture(const Program& program);

    Look look_;
    glm::mat4 view_{1}, projection_{1}, world_to_shadow_{1};
    float near_m_ = 0, pixel_rad_ = 0;
    course::VertexArray particles_, no_vertices_;
    course::Framebuffer picture_;
    // Only what the look needs is made.
    std::optional<course::Framebuffer> surface_, shadow_map_;
    std::optional<Program> spheres_, lighting_, shadow_, points_, backdrop_, edges_;
};

// ------------------------------------------------------------------------------------------------- making

constexpr int kShadowMapSize = 1024;  // texels; a sphere of 1/100 of the region still gets 5 of them

//! [make]
inline ParticleRenderer::ParticleRenderer(int width_px, int height_px, const Look& look)
    : look_(look), picture_(width_px, height_px, GL_SRGB8_ALPHA8, course::Framebuffer::Depth::float32) {
    using course::Framebuffer;
    using Files = std::vector<std::string>;
    look_.light.towards = glm::normalize(look.light.towards);
    if (look.drawing == Drawing::spheres) {
        const int samples = look.samples_per_axis;
        surface_.emplace(samples * width_px, samples * height_px, GL_RGBA16F, Framebuffer::Depth::float32);
        spheres_.emplace(look.mesh_rings ? Files{"sphere_mesh.vert", "sphere_mesh.frag"}
                                         : Files{"sphere_impostor.vert", "sphere_impostor.frag"});
        lighting_.emplace(
            Files{"fullscreen.vert", "lighting.frag", "openness.frag", "palette.frag", "backdrop.frag"});
        if (look.shadows) {
            shadow_map_.emplace(kShadowMapSize, kShadowMapSize, 0, Framebuffer::Depth::float32);
            shadow_.emplace(Files{"shadow.vert", "shadow.frag"});
        }
    } else {
        points_.emplace(Files{"points.vert", "points.frag", "palette.frag"});
        backdrop_.emplace(Files{"fullscreen.vert", "empty_scene.frag", "backdrop.frag"});
    }
    if (look.region_edges) edges_.emplace(Files{"box_edges.vert", "box_edges.frag"});
    course::check_gl("making the renderer");
}
//! [make]

// ------------------------------------------------------------------------------------------------ drawing

//! [draw]
inline void ParticleRenderer::draw(const course::GlBuffer& position, const course::GlBuffer* velocity,
                                   std::size_t count, float radius_m, const course::Camera& camera) {
    if (16 * count > position.bytes() || (velocity && 16 * count > velocity->bytes()))
        throw std::logic_error("more particles to draw than the buffers hold");
    view_ = camera.view();
    projection_ = camera.projection(float(picture_.width()) / float(picture_.height()));
    near_m_ = camera.near_m;
    pixel_rad_ = camera.field_of_view_rad / float(picture_.height());
    glEnable(GL_PROGRAM_POINT_SIZE);
    glEnable(GL_FRAMEBUFFER_SRGB);  // shaders compute in linear light, the picture stores sRGB

    if (look_.drawing == Drawing::spheres) {
        bind_particles(position, velocity);
        if (look_.shadows) draw_shadow_map(GLsizei(count), radius_m);
        draw_surface(GLsizei(count), radius_m);  // which sphere is seen where?
        light_surface(radius_m);                 // what colour has it?
    } else {
        draw_backdrop();
        bind_particles(position, velocity);
        draw_points(GLsizei(count), radius_m);
    }
    if (look_.region_edges) draw_edges();
    course::check_gl("drawing particles");
}
//! [draw]

//! [bind_particles]
inline void ParticleRenderer::bind_particles(const course::GlBuffer& position,
                                             const course::GlBuffer* velocity) {
    glBindVertexArray(particles_.id());
    bind_float4(0, position);
    if (velocity) {
        bind_float4(1, *velocity);
    } else {
        glDisableVertexAttribArray(1);
        glVertexAttrib4f(1, 0, 0, 0, 0);  // one value for all particles
    }
}

/// Shader input number `input` (layout(location = ...)) is read from `buffer`: a float4 for each particle.
inline void ParticleRenderer::bind_float4(GLuint input, const course::GlBuffer& buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
    GLint mapped = GL_FALSE;
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_MAPPED, &mapped);
    if (mapped) throw std::logic_error("a buffer to draw from is mapped: unmap it first");
    glVertexAttribPointer(input, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(input);
}
//! [bind_particles]

inline void ParticleRenderer::draw_shadow_map(GLsizei count, float radius_m) {
    // The light sees the whole region through a box that just holds the region's bounding sphere.
    const float r = look_.region.half_diagonal_m();
    const glm::vec3 centre = look_.region.centre_m(), to_light = look_.light.towards;
    const glm::vec3 up = std::abs(to_light.y) < 0.99f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    world_to_shadow_ = glm::ortho(-r, r, -r, r, 0.0f, 2 * r) * glm::lookAt(centre + r * to_light, centre, up);

    shadow_map_->bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    shadow_->use();
    shadow_->set("world_to_light", world_to_shadow_);
    shadow_->set("diameter_px", radius_m / r * kShadowMapSize);
    shadow_->set("radius_depth", radius_m / (2 * r));
    glVertexAttribDivisor(0, 0);  // a new position with each vertex
    glDrawArrays(GL_POINTS, 0, count);
}

//! [draw_surface]
inline void ParticleRenderer::draw_surface(GLsizei count, float radius_m) {
    surface_->bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    spheres_->use();
    spheres_->set("view", view_);
    spheres_->set("projection", projection_);
    spheres_->set("radius_m", radius_m);
    glVertexAttribDivisor(0, 1);  // a new position with each instance, that is, each sphere
    glVertexAttribDivisor(1, 1);
    if (look_.mesh_rings == 0) {
        spheres_->set("near_m", near_m_);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
        return;
    }
    spheres_->set("rings", look_.mesh_rings);
    glEnable(GL_CULL_FACE);  // the far side is not drawn
    glDrawArraysInstanced(GL_TRIANGLES, 0, 12 * look_.mesh_rings * look_.mesh_rings, count);
    glDisable(GL_CULL_FACE);
}
//! [draw_surface]

inline void ParticleRenderer::light_surface(float radius_m) {
    const glm::mat4 to_unit = glm::scale(glm::translate(glm::mat4(1), glm::vec3(0.5f)), glm::vec3(0.5f));
    lighting_->use();
    surface_->colour().bind(0);
    surface_->depth().bind(1);
    lighting_->set("surface", 0);
    lighting_->set("depth_map", 1);
    lighting_->set("shadow_map", 2);
    if (look_.shadows) shadow_map_->depth().bind(2);
    lighting_->set("shadows", look_.shadows ? 1 : 0);
    lighting_->set("samples", look_.samples_per_axis);
    lighting_->set("occlusion_m", look_.occlusion_radii * radius_m);
    lighting_->set("world_to_shadow", to_unit * world_to_shadow_);
    // A shadow's edge is as soft as a sphere is wide; that softness also hides the map's texels.
    const float edge_m = 1.2f * radius_m;
    lighting_->set("shadow_edge", edge_m / (2 * look_.region.half_diagonal_m()));
    lighting_->set("to_light", look_.light.towards);
    lighting_->set("key_light", look_.light.key);
    lighting_->set("palette_colour", look_.palette.colours);
    lighting_->set("palette_top_m_per_s", look_.palette.top_m_per_s);
    draw_whole_picture(*lighting_);
}

inline void ParticleRenderer::draw_backdrop() {
    backdrop_->use();
    backdrop_->set("floor_light", look_.light.sky + look_.light.towards.y * look_.light.key);
    draw_whole_picture(*backdrop_);
}

inline void ParticleRenderer::draw_whole_picture(const Program& program) {
    program.set("projection", projection_);
    program.set("camera_to_world", glm::inverse(view_));
    program.set("sky_colour", look_.light.sky);
    program.set("horizon_colour", look_.light.horizon);
    program.set("ground_colour", look_.light.ground);
    program.set("floor_centre_m",
                glm::vec3(look_.region.centre_m().x, look_.region.low_m.y, look_.region.centre_m().z));
    program.set("floor_tile_m", look_.floor_tile_m);
    program.set("floor_fade_m", 2.8f * look_.region.half_diagonal_m());
    program.set("pixel_rad", pixel_rad_);
    program.set("picture_px", glm::vec2(picture_.width(), picture_.height()));
    picture_.bind();
    glEnable(GL_DEPTH_TEST);  // without it no depth is written either
    glDepthFunc(GL_ALWAYS);
    glBindVertexArray(no_vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
}

inline void ParticleRenderer::draw_points(GLsizei count, float radius_m) {
    points_->use();
    points_->set("view", view_);
    points_->set("projection", projection_);
    points_->set("pixels_per_rad", 0.5f * projection_[1][1] * float(picture_.height()));
    points_->set("radius_m", radius_m);
    points_->set("palette_colour", look_.palette.colours);
    points_->set("palette_top_m_per_s", look_.palette.top_m_per_s);
    glVertexAttribDivisor(0, 0);
    glVertexAttribDivisor(1, 0);
    glDrawArrays(GL_POINTS, 0, count);
}

inline void ParticleRenderer::draw_edges() {
    edges_->use();
    edges_->set("view", view_);
    edges_->set("projection", projection_);
    edges_->set("near_m", near_m_);
    edges_->set("low_m", look_.region.low_m);
    edges_->set("high_m", look_.region.high_m);
    edges_->set("picture_px", glm::vec2(picture_.width(), picture_.height()));
    glBindVertexArray(no_vertices_.id());
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    const auto draw_where = [&](GLenum depth, float strength) {
        glDepthFunc(depth);
        edges_->set("strength", strength);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 12);
    };
    draw_where(GL_LESS, 0.75f);
    draw_where(GL_GEQUAL, 0.12f);  // behind the particles: faint
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

}  // namespace interop
