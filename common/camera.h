/// @file
/// Where a picture is seen from. Right-handed, y up; the camera looks along its own -z axis.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace course {

/// A perspective camera. Lengths in metres, angles in radians.
struct Camera {
    glm::vec3 eye_m{0, 0, 3};
    glm::vec3 target_m{0, 0, 0};
    float field_of_view_rad = 0.7f;  ///< of the picture's height
    float near_m = 0.02f;            ///< nothing nearer to the eye's plane is drawn
    float far_m = 100;

    /// World to camera.
    glm::mat4 view() const { return glm::lookAt(eye_m, target_m, glm::vec3(0, 1, 0)); }
    /// Camera to clip coordinates, for a picture `aspect` times as wide as high.
    glm::mat4 projection(float aspect) const {
        return glm::perspective(field_of_view_rad, aspect, near_m, far_m);
    }
};

/// A camera on a sphere around what it looks at, as a mouse moves it.
struct OrbitCamera {
    glm::vec3 target_m{0, 0, 0};
    float distance_m = 3;
    float yaw_rad = 0;    ///< 0: the eye is on the target's +z side; positive: towards +x
    float pitch_rad = 0;  ///< positive: the eye is above the target

    void orbit(float yaw_change_rad, float pitch_change_rad) {
        constexpr float kMaxPitch = 1.55f;  // radians; at pi/2 "up" would be along the line of sight
        yaw_rad += yaw_change_rad;
        pitch_rad = std::clamp(pitch_rad + pitch_change_rad, -kMaxPitch, kMaxPitch);
    }
    /// One wheel click nearer (positive) or farther, by a constant factor, so that the target is never
    /// passed.
    void zoom(float clicks) { distance_m *= std::pow(0.9f, clicks); }
    /// Moves camera and target in the plane of the picture, by fractions of the picture's height.
    void pan(float right, float up, const Camera& lens = {}) {
        const glm::mat4 view = camera(lens).view();
        const float height_m = 2 * distance_m * std::tan(lens.field_of_view_rad / 2);
        const glm::vec3 x(view[0][0], view[1][0], view[2][0]), y(view[0][1], view[1][1], view[2][1]);
        target_m += height_m * (right * x + up * y);
    }
    /// The camera itself; field of view and clipping distances are those of `lens`.
    Camera camera(Camera lens = {}) const {
        const glm::vec3 direction(std::cos(pitch_rad) * std::sin(yaw_rad), std::sin(pitch_rad),
                                  std::cos(pitch_rad) * std::cos(yaw_rad));
        lens.target_m = target_m;
        lens.eye_m = target_m + distance_m * direction;
        return lens;
    }
};

}  // namespace course
