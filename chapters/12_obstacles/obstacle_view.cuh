/// @file
/// Particles and obstacles on screen: chapter 06's spheres, and over them a picture of the solids.
#pragma once
#include "06_gl_interop/tank_view.cuh"
#include "12_obstacles/obstacle_set.cuh"
#include "common/gl_window.h"

namespace obstacles {

/// From higher up than a tank without obstacles: what the water does behind them is to be seen.
inline course::OrbitCamera obstacle_view(const interop::Box& tank) {
    course::OrbitCamera orbit = interop::first_view(tank);
    orbit.target_m.y = tank.low_m.y + 0.26f * (tank.high_m.y - tank.low_m.y);
    orbit.distance_m = 2.35f * tank.half_diagonal_m();
    orbit.yaw_rad = 0.72f;
    orbit.pitch_rad = 0.46f;
    return orbit;
}

//! [hand]
/// Where the mouse takes an obstacle: in the plane through it that faces the eye, it stays under the pointer.
inline glm::dvec3 dragged(glm::dvec3 from_m, const course::WindowEvents& events, const course::Camera& camera,
                          int height_px) {
    const glm::mat4 view = camera.view();
    const glm::dvec3 right(view[0][0], view[1][0], view[2][0]), up(view[0][1], view[1][1], view[2][1]);
    const double depth_m = -(view * glm::vec4(glm::vec3(from_m), 1)).z;
    const double pixel_m = 2 * depth_m * std::tan(camera.field_of_view_rad / 2) / height_px;
    return from_m + pixel_m * (events.drag_x_px * right - events.drag_y_px * up);
}
//! [hand]

/// Draws particles in a tank with obstacles. Needs a current OpenGL context.
class ObstacleView {
  public:
    ObstacleView(const interop::TankScene& scene, std::size_t max_particles, int width_px, int height_px)
        : tank_(scene.tank),
          particles_(without_edges(scene), max_particles, width_px, height_px),
          picture_(width_px, height_px, GL_SRGB8_ALPHA8, course::Framebuffer::Depth::float32),
          solids_({"fullscreen.vert", "obstacles.frag", "backdrop.frag"}),
          edges_({"box_edges.vert", "box_edges.frag"}) {
        light_.towards = glm::normalize(light_.towards);
    }

    void draw(const float4* position, const float4* velocity, std::size_t count, const ObstacleSet& obstacles,
              const course::Camera& camera) {
        particles_.draw(position, velocity, count, camera);
        const float aspect = float(picture_.width()) / float(picture_.height());
        const glm::mat4 view = camera.view(), projection = camera.projection(aspect);
        glEnable(GL_FRAMEBUFFER_SRGB);
        picture_.bind();
        draw_solids(obstacles, view, projection);
        draw_edges(camera, view, projection);
        course::check_gl("drawing obstacles");
    }
    course::Image image() const { return course::read_image(picture_); }
    const course::Framebuffer& picture() const { return picture_; }
    std::string handover() const { return particles_.handover(); }

  private:
    static interop::TankScene without_edges(interop::TankScene scene) {
        scene.edges = false;  // solids may be behind the near ones
        return scene;
    }

    //! [draw_solids]
    /// One triangle over the whole picture; its shader asks each pixel's ray which solid it meets.
    void draw_solids(const ObstacleSet& obstacles, const glm::mat4& view, const glm::mat4& projection) {
        solids_.use();
        particles_.picture().colour().bind(0);
        particles_.picture().depth().bind(1);
        solids_.set("scene", 0);
        solids_.set("scene_depth", 1);
        solids_.set("projection", projection);
        solids_.set("camera_to_world", glm::inverse(view));
        solids_.set("to_light", light_.towards);
        solids_.set("key_light", light_.key);
        solids_.set("sky_colour", light_.sky);
        solids_.set("horizon_colour", light_.horizon);
        solids_.set("ground_colour", light_.ground);
        solids_.set("floor_centre_m", glm::vec3(tank_.centre_m().x, tank_.low_m.y, tank_.centre_m().z));
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
        edges_.set("low_m", tank_.low_m);
        edges_.set("high_m", tank_.high_m);
        edges_.set("picture_px", glm::vec2(picture_.width(), picture_.height()));
        edges_.set("strength", 0.75f);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, 12);
        glDepthMask(GL_TRUE);
        glDisable(GL_BLEND);
    }

    interop::Box tank_;
    interop::Light light_;
    interop::TankView particles_;
    course::Framebuffer picture_;
    course::ShaderProgram solids_, edges_;
    course::VertexArray no_vertices_;
};

}  // namespace obstacles
