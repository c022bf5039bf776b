/// @file
/// The contact pass for reading: in double, and with no formula for where a line meets a solid.
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "12_obstacles/contact.cuh"

namespace obstacles {

//! [signed_distance_cpu]
inline double signed_distance_cpu(const Solid& solid, glm::dvec3 r) {
    if (solid.shape == Shape::sphere) return glm::length(r) - solid.half_size_m.x;
    const glm::dvec3 beyond = glm::abs(r) - glm::dvec3(solid.half_size_m);
    const double inside = glm::max(beyond.x, glm::max(beyond.y, beyond.z));
    return inside > 0 ? glm::length(glm::max(beyond, glm::dvec3(0))) : inside;
}
//! [signed_distance_cpu]

/// Its gradient, by differences.
inline glm::dvec3 outward_cpu(const Solid& solid, glm::dvec3 r) {
    constexpr double kStep_m = 1e-7;
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 more = r, less = r;
        more[axis] += kStep_m;
        less[axis] -= kStep_m;
        gradient[axis] = signed_distance_cpu(solid, more) - signed_distance_cpu(solid, less);
    }
    return glm::normalize(gradient);
}

//! [resolve_cpu]
/// The particle's step in `pieces` pieces. As soon as one ends inside an obstacle, the particle bounces. Its
/// error is one piece long.
inline void resolve_cpu(const Obstacles& all, int pieces, glm::dvec3& x, glm::dvec3& v) {
    const double piece_s = double(all.dt_s) / pieces;
    x -= double(all.dt_s) * v;
    for (int piece = 1; piece <= pieces; ++piece) {
        x += piece_s * v;
        for (int k = 0; k < all.count; ++k) {
            const Moving& o = all.obstacle[k];
            const double done = double(piece) / pieces;
            const glm::dvec3 middle = glm::mix(glm::dvec3(o.from_m), glm::dvec3(o.to_m), done);
            const double depth = signed_distance_cpu(o.solid, x - middle);
            if (depth >= 0) continue;
            const glm::dvec3 n = outward_cpu(o.solid, x - middle);
            const glm::dvec3 u = glm::mix(glm::dvec3(o.from_m_per_s), glm::dvec3(o.to_m_per_s), done);
            const double approach = -glm::dot(v - u, n);
            x -= depth * n;
            if (!(approach > 0)) continue;
            const double push = (1 + o.surface.restitution) * approach;
            const glm::dvec3 sliding = v - u + approach * n;
            const double speed = glm::length(sliding);
            v += push * n;
            if (speed > 0) v -= glm::min(o.surface.friction * push / speed, 1.0) * sliding;
        }
    }
}
//! [resolve_cpu]

}  // namespace obstacles
