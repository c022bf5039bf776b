/// @file
/// Particles and obstacles on screen: chapter 06's spheres, and over them a picture of the solids.
#pragma once
#include "06_gl_interop/interop_buffer.cuh"
#include "06_gl_interop/particle_renderer.h"
#include "12_obstacles/obstacle_set.cuh"

namespace obstacles {

/// A tank as the first picture shows it: from the front, a little above the water.
inline course::OrbitCamera first_view(glm::vec3 low_m, glm::vec3 high_m) {
    course::OrbitCamera orbit;
    orbit.target_m = glm::vec3(0.5f * (low_m.x + high_m.x), low_m.y + 0.33f * (high_m.y - low_m.y),
                               0.5f * (low_m.z + high_m.z));
    orbit.distance_m = 1.08f * glm::length(high_m - low_m);
    orbit.yaw_rad = 0.72f;
    orbit.pitch_rad = 0.46f;
    return orbit;
}

/// Draws particles in a tank with obstacles. Needs a current OpenGL context.
class ObstacleView {
  public:
    /// @param fastest_m_per_s  particles of that speed and above are white
    ObstacleView(std::uint32_t particles, float radius_m, glm::vec3 low_m, glm::vec3 high_m,
                 float fastest_m_per_s, int width_px, int height_px)
        : position_(particles),
          velocity_(particles),
          radius_m_(radius_m),
          look_(tank_look(low_m, high_m, fastest_m_per_s)),
          renderer_(width_px, height_px, look_),
          picture_(width_px, height_px, GL_SRGB8_ALPHA8, course::Framebuffer::Depth::float32),
          solids_({"fullscreen.vert", "obstacles.frag", "backdrop.frag"}),
          edges_({"box_edges.vert", "box_edges.frag"}) {}

    /// @param position, velocity  device memory, as many as the view was made for
    void draw(const float4* position, const float4* velocity, const ObstacleSet& obstacles,
              const course::Camera& camera) {
        copy(position_, position);
        copy(velocity_, velocity);
        renderer_.draw(position_.gl_buffer(), &velocity_.gl_buffer(), position_.size(), radius_m_, camera);
        const float aspect = float(picture_.width()) / float(picture_.height());
        const glm::mat4 view = camera.view(), projection = camera.projection(aspect);
        glEnable(GL_FRAMEBUFFER_SRGB);
        picture_.bind();
        draw_solids(obstacles, camera, view, projection);
        draw_edges(camera, view, projection);
        course::check_gl("drawing obstacles");
    }
    course::Image image() const { return course::read_image(picture_); }
    const course::Framebuffer& picture() const { return picture_; }
    std::string handover() const { return position_.why(); }

  private:
    static void copy(interop::InteropBuffer<float4>& to, const float4* from) {
        CUDA_CHECK(cudaMemcpy(to.map(), from, to.size() * sizeof(float4), cudaMemcpyDeviceToDevice));
        to.unmap();
    }
    static interop::Look tank_look(glm::vec3 low_m, glm::vec3 high_m, float fastest_m_per_s) {
        interop::Look look;
        look.palette = interop::water_palette(fastest_m_per_s);
        look.region = {low_m, high_m};
        look.floor_tile_m = 0.1f;
        look.light.towards = glm::normalize(look.light.towards);
        return look;
    }

    //! [draw_solids]
    /// One triangle over the whole picture; its shader asks each pixel's ray which solid it meets.
    void draw_solids(const ObstacleSet& obstacles, const course::Camera& camera, const glm::mat4& view,
                     const glm::mat4& projection) {
        solids_.use();
        renderer_.picture().colour().bind(0);
        renderer_.picture().depth().bind(1);
        solids_.set("scene", 0);
        solids_.set("scene_depth", 1);
        solids_.set("projection", projection);
        solids_.set("camera_to_world", glm::inverse(view));
        solids_.set("to_light", look_.light.towards);
        solids_.set("key_light", look_.light.key);
        solids_.set("sky_colour", look_.light.sky);
        solids_.set("horizon_colour", look_.light.horizon);
        solids_.set("ground_colour", look_.light.ground);
        solids_.set("floor_centre_m",
                    glm::vec3(look_.region.centre_m().x, look_.region.low_m.y, look_.region.centre_m().z));
        solids_.set("paint", glm::vec3(0.46f, 0.085f, 0.030f));  // a warm colour: water has none of it
        solids_.set("count", obstacles.size());
        for (int k = 0; k < obstacles.size(); ++k) {
            const std::string index = "[" + std::to_string(k) + "]";
            const Solid& solid = obstacles.obstacle(k).solid;
            solids_.set(("is_box" + index).c_str(), solid.shape == Shape::box ? 1 : 0);
            solids_.set(("middle_m" + index).c_str(), obstacles.now().obstacle[k].to_m);
            solids_.set(("half_size_m" + index).c_str(), solid.half_size_m);
        }
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_ALWAYS);
        glBindVertexArray(no_vertices_.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glDepthFunc(GL_LESS);
    }
    //! [draw_solids]

    /// The tank, after the solids: its near edges are in front of them.
    void draw_edges(const course::Camera& camera, const glm::mat4& view, const glm::mat4& projection) {
        edges_.use();
        edges_.set("view", view);
        edges_.set("projection", projection);
        edges_.set("near_m", camera.near_m);
        edges_.set("low_m", look_.region.low_m);
        edges_.set("high_m", look_.region.high_m);
        edges_.set("picture_px", glm::vec2(picture_.width(), picture_.height()));
        edges_.set("strength", 0.75f);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 12);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }

    interop::InteropBuffer<float4> position_, velocity_;
    float radius_m_;
    interop::Look look_;
    interop::ParticleRenderer renderer_;
    course::Framebuffer picture_;
    course::ShaderProgram solids_, edges_;
    course::VertexArray no_vertices_;
};

}  // namespace obstacles
