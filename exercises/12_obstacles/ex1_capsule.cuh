// Exercise 12.1: a third shape.
//
// A capsule is everything within a radius of a line segment: a stick with round ends. Its signed
// distance and its way out are all that the test at the end of the step needs; the swept test would need its
// crossing as well.
#pragma once
#include <cuda_runtime.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "common/todo.h"

namespace obstacles {

struct Capsule {
    glm::vec3 from_m{0}, to_m{0};  // ends of the segment; they may be the same point
    float radius_m = 0.1f;
};

// The point of the segment that is nearest to x.
inline __host__ __device__ glm::vec3 nearest_of_segment(const Capsule& capsule, glm::vec3 x) {
    // TODO(12.1): how far along the segment, as a part of it? The nearest point of a segment may be an end of
    // it, and a segment may have no length. About 4 lines.
    (void)capsule, (void)x;
    return glm::vec3(course::kTodo);
}

// Distance in m from x to the surface; below 0 inside.
inline __host__ __device__ float signed_distance(const Capsule& capsule, glm::vec3 x) {
    // TODO(12.1): 1 line.
    (void)capsule, (void)x;
    return float(course::kTodo);
}

// The way out at x, of length 1. On the segment itself all ways are as short: then it is up, unless the
// segment leads there (its direction's y is above 0.9 in size); then it is along x.
inline __host__ __device__ glm::vec3 outward(const Capsule& capsule, glm::vec3 x) {
    // TODO(12.1): about 6 lines.
    (void)capsule, (void)x;
    return glm::vec3(course::kTodo);
}

}  // namespace obstacles
