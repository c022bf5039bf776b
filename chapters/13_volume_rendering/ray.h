/// @file
/// Rays, the boxes they pass through, and the camera they come from.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/glm.hpp>

#include "common/camera.h"

/// Chapter 13: fire and smoke as a volume.
namespace volume {

/// Half a line. Real: float on the device, double in references.
template <class Real = float>
struct Ray {
    glm::vec<3, Real> origin_m;
    glm::vec<3, Real> direction;  ///< of length 1
    __host__ __device__ glm::vec<3, Real> at(Real t_m) const { return origin_m + t_m * direction; }
};

/// The part of a ray from near_m to far_m. Empty if far_m is not above near_m.
template <class Real = float>
struct Span {
    Real near_m, far_m;
    __host__ __device__ bool empty() const { return !(far_m > near_m); }
};

//! [box_span]
/// Where the ray is inside the box. From a point inside, the span starts at the point itself. A ray along a
/// face of the box counts as inside.
template <class Real>
__host__ __device__ inline Span<Real> box_span(const Ray<Real>& ray, glm::vec<3, Real> low_m,
                                               glm::vec<3, Real> high_m) {
    Span<Real> span{0, Real(1e30)};
    for (int axis = 0; axis < 3; ++axis) {
        const Real x = ray.origin_m[axis], d = ray.direction[axis];
        if (x - x != 0 || d - d != 0) return {0, 0};  // not finite: no ray
        if (d == 0) {                                 // 0 / 0 would be no number: never in, or never out
            if (x < low_m[axis] || x > high_m[axis]) return {0, 0};
            continue;
        }
        const Real a = (low_m[axis] - x) / d, b = (high_m[axis] - x) / d;
        span.near_m = std::fmax(span.near_m, std::fmin(a, b));
        span.far_m = std::fmin(span.far_m, std::fmax(a, b));
    }
    return span;
}
//! [box_span]

//! [lens]
/// A camera as a kernel wants it: one ray per pixel.
struct Lens {
    glm::vec3 eye_m, forward, right, up;  ///< right and up: from the middle of the picture to its edge
    int width = 0, height = 0;
    float shift_x = 0, shift_y = 0;  ///< of all rays, in pixels: several rays a pixel make edges soft

    /// The ray through the middle of a pixel, or beside it; row 0 is the top one.
    __host__ __device__ Ray<float> ray(int x, int y) const {
        const float across = 2 * (float(x) + 0.5f + shift_x) / float(width) - 1;
        const float upward = 1 - 2 * (float(y) + 0.5f + shift_y) / float(height);
        return {eye_m, glm::normalize(forward + across * right + upward * up)};
    }
};

inline Lens make_lens(const course::Camera& camera, int width, int height) {
    Lens lens;
    lens.eye_m = camera.eye_m;
    lens.forward = glm::normalize(camera.target_m - camera.eye_m);
    const float half_height = std::tan(camera.field_of_view_rad / 2);
    const glm::vec3 right = glm::normalize(glm::cross(lens.forward, glm::vec3(0, 1, 0)));
    lens.up = half_height * glm::cross(right, lens.forward);
    lens.right = half_height * float(width) / float(height) * right;
    lens.width = width;
    lens.height = height;
    return lens;
}
//! [lens]

}  // namespace volume
