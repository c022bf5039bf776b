/// @file
/// Draws a mesh that lies in OpenGL buffers, lit as chapter 06 lights its spheres. What real water does to
/// light is chapter 15's.
#pragma once
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "06_gl_interop/look.h"
#include "common/camera.h"
#include "common/gl_target.h"
#include "common/shader.h"

namespace surface {

/// Three buffers of OpenGL and how much of them is drawn.
struct MeshBuffers {
    GLuint position = 0;  ///< float4 each: x, y, z in m
    GLuint normal = 0;    ///< float4 each; 0: there are none, and each triangle is flat
    GLuint index = 0;     ///< std::uint32_t, three a triangle
    std::size_t triangles = 0;
};

/// Owns shaders and framebuffers for one picture size. Needs a current context.
class MeshRenderer {
  public:
    MeshRenderer(int width_px, int height_px, const interop::Look& look);

    /// Draws the mesh; with no triangles, the empty scene.
    void draw(const MeshBuffers& mesh, const course::Camera& camera);

    const course::Framebuffer& picture() const { return picture_; }
    course::Image image() const { return course::read_image(picture_); }

  private:
    void bind(const MeshBuffers& mesh);
    void draw_shadow_map(GLsizei corners);
    void draw_surface(GLsizei corners, bool flat);
    void light_surface();
    void draw_edges();

    interop::Look look_;
    glm::mat4 view_{1}, projection_{1}, world_to_shadow_{1};
    float near_m_ = 0, pixel_rad_ = 0;
    course::VertexArray mesh_, no_vertices_;
    course::Framebuffer picture_, surface_;
    std::optional<course::Framebuffer> shadow_map_;
    course::ShaderProgram triangles_, lighting_;
    std::optional<course::ShaderProgram> shadow_, edges_;
};

constexpr int kShadowTexels = 2048;

inline MeshRenderer::MeshRenderer(int width_px, int height_px, const interop::Look& look)
    : look_(look),
      picture_(width_px, height_px, GL_SRGB8_ALPHA8, course::Framebuffer::Depth::float32),
      surface_(look.samples_per_axis * width_px, look.samples_per_axis * height_px, GL_RGBA16F,
               course::Framebuffer::Depth::float32),
      triangles_({"surface_mesh.vert", "surface_mesh.frag"}),
      lighting_({"fullscreen.vert", "lighting.frag", "openness.frag", "palette.frag", "backdrop.frag"}) {
    look_.light.towards = glm::normalize(look.light.towards);
    if (look.shadows) {
        shadow_map_.emplace(kShadowTexels, kShadowTexels, 0, course::Framebuffer::Depth::float32);
        shadow_.emplace(std::vector<std::string>{"surface_shadow.vert", "surface_shadow.frag"});
    }
    if (look.region_edges) edges_.emplace(std::vector<std::string>{"box_edges.vert", "box_edges.frag"});
    course::check_gl("making the mesh renderer");
}

inline void MeshRenderer::draw(const MeshBuffers& mesh, const course::Camera& camera) {
    view_ = camera.view();
    projection_ = camera.projection(float(picture_.width()) / float(picture_.height()));
    near_m_ = camera.near_m;
    pixel_rad_ = camera.field_of_view_rad / float(picture_.height());
    glEnable(GL_FRAMEBUFFER_SRGB);  // shaders compute in linear light, the picture stores sRGB
    const GLsizei corners = GLsizei(3 * mesh.triangles);
    if (corners > 0) bind(mesh);
    if (shadow_map_) draw_shadow_map(corners);
    draw_surface(corners, mesh.normal == 0);
    light_surface();
    if (edges_) draw_edges();
    course::check_gl("drawing a mesh");
}

//! [bind]
/// Vertices are fetched by their index: each is stored once and used by six triangles on average.
inline void MeshRenderer::bind(const MeshBuffers& mesh) {
    glBindVertexArray(mesh_.id());
    const auto input = [](GLuint number, GLuint buffer) {
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glVertexAttribPointer(number, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(number);
    };
    input(0, mesh.position);
    if (mesh.normal)
        input(1, mesh.normal);
    else
        glDisableVertexAttribArray(1);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.index);
}
//! [bind]

inline void MeshRenderer::draw_shadow_map(GLsizei corners) {
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
    if (corners > 0) glDrawElements(GL_TRIANGLES, corners, GL_UNSIGNED_INT, nullptr);
}

inline void MeshRenderer::draw_surface(GLsizei corners, bool flat) {
    surface_.bind();
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    triangles_.use();
    triangles_.set("view", view_);
    triangles_.set("projection", projection_);
    triangles_.set("flat_triangles", int(flat));
    if (corners > 0) glDrawElements(GL_TRIANGLES, corners, GL_UNSIGNED_INT, nullptr);
}

inline void MeshRenderer::light_surface() {
    const interop::Light& light = look_.light;
    const interop::Box& region = look_.region;
    lighting_.use();
    surface_.colour().bind(0);
    surface_.depth().bind(1);
    lighting_.set("surface", 0);
    lighting_.set("depth_map", 1);
    lighting_.set("samples", look_.samples_per_axis);
    lighting_.set("occlusion_m", 0.03f * look_.region.half_diagonal_m());
    lighting_.set("shadows", int(look_.shadows));
    if (shadow_map_) {
        shadow_map_->depth().bind(2);
        lighting_.set("shadow_map", 2);
        const glm::mat4 half = glm::scale(glm::translate(glm::mat4(1), glm::vec3(0.5f)), glm::vec3(0.5f));
        lighting_.set("world_to_shadow", half * world_to_shadow_);
        lighting_.set("shadow_edge", 3.0f / kShadowTexels);
    }
    lighting_.set("to_light", light.towards);
    lighting_.set("key_light", light.key);
    lighting_.set("palette_colour", look_.palette.colours);
    lighting_.set("palette_top_m_per_s", look_.palette.top_m_per_s);
    lighting_.set("projection", projection_);
    lighting_.set("camera_to_world", glm::inverse(view_));
    lighting_.set("sky_colour", light.sky);
    lighting_.set("horizon_colour", light.horizon);
    lighting_.set("ground_colour", light.ground);
    lighting_.set("floor_centre_m", glm::vec3(region.centre_m().x, region.low_m.y, region.centre_m().z));
    lighting_.set("floor_tile_m", look_.floor_tile_m);
    lighting_.set("floor_fade_m", 2.8f * region.half_diagonal_m());
    lighting_.set("pixel_rad", pixel_rad_);
    lighting_.set("picture_px", glm::vec2(picture_.width(), picture_.height()));
    picture_.bind();
    glEnable(GL_DEPTH_TEST);  // without it no depth is written either
    glDepthFunc(GL_ALWAYS);
    glBindVertexArray(no_vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
}

inline void MeshRenderer::draw_edges() {
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
    draw_where(GL_GEQUAL, 0.12f);  // behind the water: faint
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

}  // namespace surface
