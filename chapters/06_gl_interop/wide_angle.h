/// @file
/// A picture that shows what a sphere shader must get right: outlines far from the middle, and intersections.
#pragma once
#include <vector>

#include "06_gl_interop/particle_renderer.h"

namespace interop {

/// Pairs of spheres that cut into each other, seen through a very wide lens. Nothing moves, and no kernel
/// runs: the positions are written by the host.
inline course::Image wide_angle_picture(int width_px, int height_px) {
    constexpr float kSpacing_m = 1.6f, kRadius_m = 0.5f;
    const glm::vec4 to_partner_m(0.42f, 0.3f, 0.25f, 0);
    std::vector<glm::vec4> position, velocity;
    for (int x = -4; x <= 4; ++x)
        for (int y = -2; y <= 2; ++y) {
            const glm::vec4 p(kSpacing_m * x, kSpacing_m * y, 0, 0);
            position.push_back(p - 0.5f * to_partner_m);
            velocity.push_back({1, 0, 0, 0});
            position.push_back(p + 0.5f * to_partner_m);
            velocity.push_back({2.4f, 0, 0, 0});
        }
    course::GlBuffer positions(position.size() * sizeof(glm::vec4)), velocities(positions.bytes());
    const auto fill = [](const course::GlBuffer& buffer, const std::vector<glm::vec4>& values) {
        glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
        glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(buffer.bytes()), values.data());
    };
    fill(positions, position);
    fill(velocities, velocity);

    Look look;
    look.palette = water_palette(3.4f);
    look.region = {{-6.8f, -3.8f, -0.8f}, {6.8f, 3.8f, 0.8f}};
    look.shadows = false;
    look.occlusion_radii = 0;
    course::Camera camera;
    camera.eye_m = {0, 0, 2.6f};
    camera.field_of_view_rad = 1.83f;  // 105 degrees
    ParticleRenderer renderer(width_px, height_px, look);
    renderer.draw(positions, &velocities, position.size(), kRadius_m, camera);
    return renderer.image();
}

}  // namespace interop
