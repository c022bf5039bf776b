/// @file
/// The shapes of obstacles as signed distances: how far a point is from the surface, and which way out.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

/// Chapter 12: spheres and boxes that particles bounce off, and that particles push.
namespace obstacles {

enum class Shape { sphere, box };

/// A shape around the origin: points are given relative to its middle.
struct Solid {
    Shape shape = Shape::sphere;
    glm::vec3 half_size_m{0.1f};  ///< half the edges of the box; a sphere's radius in all three
};

inline Solid sphere(float radius_m) {
    return {Shape::sphere, glm::vec3(radius_m)};
}
inline Solid box(glm::vec3 half_size_m) {
    return {Shape::box, half_size_m};
}

/// The same shape, larger by `gap_m` on every side. (A box keeps its sharp edges, so that off them its
/// surface is up to sqrt(3) gaps away.)
inline __host__ __device__ Solid inflated(Solid solid, float gap_m) {
    solid.half_size_m += gap_m;
    return solid;
}

/// Volume that it takes from the water.
inline double volume_m3(const Solid& solid) {
    const glm::dvec3 a = solid.half_size_m;
    return (solid.shape == Shape::sphere ? 4.1887902047863905 : 8.0) * a.x * a.y * a.z;
}

//! [signed_distance]
/// Distance in m from r to the surface, exact inside and out; below 0 inside.
inline __host__ __device__ float signed_distance(const Solid& solid, glm::vec3 r) {
    if (solid.shape == Shape::sphere) return glm::length(r) - solid.half_size_m.x;
    // By how much r is beyond the faces. Outside, the components above 0 lead to the nearest point of the
    // box; inside, the nearest face is the one that lacks least.
    const glm::vec3 beyond = glm::abs(r) - solid.half_size_m;
    const float inside = fmaxf(beyond.x, fmaxf(beyond.y, beyond.z));
    return inside > 0 ? glm::length(glm::max(beyond, glm::vec3(0))) : inside;
}
//! [signed_distance]

//! [outward]
/// The way in which the signed distance grows fastest; length 1. Where several ways are as good (the middle
/// of a sphere, a box's planes of symmetry) one is chosen, up before all others, so that every run and every
/// machine chooses the same.
inline __host__ __device__ glm::vec3 outward(const Solid& solid, glm::vec3 r) {
    const glm::vec3 side(r.x < 0 ? -1 : 1, r.y < 0 ? -1 : 1, r.z < 0 ? -1 : 1);
    if (solid.shape == Shape::sphere) {
        const float away = glm::length(r);
        return away > 0 ? r / away : glm::vec3(0, 1, 0);
    }
    const glm::vec3 beyond = glm::abs(r) - solid.half_size_m;
    const float inside = fmaxf(beyond.x, fmaxf(beyond.y, beyond.z));
    if (inside > 0) return glm::normalize(side * glm::max(beyond, glm::vec3(0)));
    if (beyond.y == inside) return {0, side.y, 0};
    return beyond.x == inside ? glm::vec3(side.x, 0, 0) : glm::vec3(0, 0, side.z);
}
//! [outward]

/// A point of the line that crosses the surface, and the surface's normal there.
struct Crossing {
    float fraction;  ///< of the way from `from` to `to`: 0 to 1
    glm::vec3 normal;
};

//! [crossing]
/// Where a point on its way straight from `from` to `to`, both relative to the solid's middle, first enters
/// the solid.
/// @param from  outside
/// @returns whether it enters
inline __host__ __device__ bool find_crossing(const Solid& solid, glm::vec3 from, glm::vec3 to,
                                              Crossing& found) {
    const glm::vec3 way = to - from;
    if (solid.shape == Shape::sphere) {
        // Through the point of the line nearest to the middle, which keeps the digits (chapter 06's
        // impostors).
        const float way2 = glm::dot(way, way);
        if (!(way2 > 0)) return false;
        const float nearest = -glm::dot(from, way) / way2;
        if (nearest < 0) return false;  // it moves away
        const float radius = solid.half_size_m.x;
        const glm::vec3 off_middle = from + nearest * way;
        const float half_chord2 = radius * radius - glm::dot(off_middle, off_middle);
        if (!(half_chord2 > 0)) return false;
        const float fraction = nearest - sqrtf(half_chord2 / way2);
        if (fraction > 1) return false;
        found.fraction = fmaxf(0.0f, fraction);
        found.normal = (from + found.fraction * way) / radius;
        return true;
    }
    // A box is where three slabs overlap: it is entered with the last of them, before the first is left.
    float enter = -1, leave = 2;
    int last = -1;
    for (int axis = 0; axis < 3; ++axis) {
        const float half = solid.half_size_m[axis];
        if (way[axis] == 0) {
            if (fabsf(from[axis]) >= half) return false;
            continue;
        }
        const float side = way[axis] > 0 ? -1.0f : 1.0f;  // of the slab's face where it goes in
        const float in = (side * half - from[axis]) / way[axis],
                    out = (-side * half - from[axis]) / way[axis];
        if (in > enter) {
            enter = in;
            last = axis;
        }
        leave = fminf(leave, out);
    }
    if (last < 0 || enter < 0 || enter > 1 || enter >= leave) return false;
    found.fraction = enter;
    found.normal = glm::vec3(0);
    found.normal[last] = way[last] > 0 ? -1.0f : 1.0f;
    return true;
}
//! [crossing]

}  // namespace obstacles
