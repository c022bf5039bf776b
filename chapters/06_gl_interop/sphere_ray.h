/// @file
/// The CPU reference of the sphere shaders: the same questions answered in double precision and by the book.
#pragma once
#include <cmath>
#include <glm/glm.hpp>

namespace interop {

/// Where a ray from the eye first meets a sphere. Camera coordinates: the eye is the origin and looks along
/// -z.
struct SphereHit {
    bool hit = false;
    double depth_m = 0;    ///< distance from the eye's plane (not from the eye)
    glm::dvec3 normal{0};  ///< of the surface, length 1
};

//! [ray_sphere]
/// Solves |t ray - centre|^2 = radius^2 for the smaller t. @param ray has z = -1, so that t is the depth
inline SphereHit ray_sphere(glm::dvec3 ray, glm::dvec3 centre_m, double radius_m, double near_m) {
    const double a = glm::dot(ray, ray), b = glm::dot(ray, centre_m);
    const double c = glm::dot(centre_m, centre_m) - radius_m * radius_m;
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0)) return {};
    const double t = (b - std::sqrt(discriminant)) / a;
    if (!(t >= near_m)) return {};
    return {true, t, (t * ray - centre_m) / radius_m};
}
//! [ray_sphere]

/// The ray through the middle of pixel (x, y), y counted from the picture's lower edge.
inline glm::dvec3 pixel_ray(int x, int y, int width_px, int height_px, const glm::dmat4& projection) {
    return {(2 * (x + 0.5) / width_px - 1) / projection[0][0],
            (2 * (y + 0.5) / height_px - 1) / projection[1][1], -1};
}

/// What OpenGL stores for a depth in metres: 0 on the near plane, 1 on the far plane.
inline double window_depth(double depth_m, const glm::dmat4& projection) {
    const double clip_z = projection[3][2] - projection[2][2] * depth_m, clip_w = depth_m;
    return 0.5 + 0.5 * clip_z / clip_w;
}
/// The depth in metres that OpenGL stored so.
inline double depth_from_window(double window, const glm::dmat4& projection) {
    return projection[3][2] / (projection[2][2] + 2 * window - 1);
}

}  // namespace interop
