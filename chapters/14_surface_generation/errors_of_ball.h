/// @file
/// How far a mesh is from the ball it should be.
#pragma once
#include "14_surface_generation/mesh.h"

namespace surface {

//! [BallErrors]
/// All relative: to the ball's area, volume and radius; the normal's in radians.
struct BallErrors {
    double area = 0, volume = 0;
    double hausdorff = 0;  ///< farthest vertex or middle of a triangle from the ball
    double normal = 0;     ///< root of the mean square angle between a vertex's normal and the ball's
};

inline BallErrors errors_of_ball(const Mesh& mesh, glm::dvec3 centre_m, double radius_m) {
    const double pi = 3.14159265358979323846;
    const Measures m = measure(mesh);
    BallErrors errors;
    errors.area = std::fabs(m.area_m2 / (4 * pi * radius_m * radius_m) - 1);
    errors.volume = std::fabs(m.volume_m3 / (4 * pi / 3 * radius_m * radius_m * radius_m) - 1);
    const auto visit = [&](glm::dvec3 x) {
        const double off = std::fabs(glm::length(x - centre_m) / radius_m - 1);
        errors.hausdorff = std::fmax(errors.hausdorff, off);
    };
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
        const glm::dvec3 x(mesh.position[v].x, mesh.position[v].y, mesh.position[v].z);
        visit(x);
        if (mesh.normal.empty()) continue;
        const glm::dvec3 n(mesh.normal[v].x, mesh.normal[v].y, mesh.normal[v].z);
        const double angle = std::acos(glm::clamp(glm::dot(n, glm::normalize(x - centre_m)), -1.0, 1.0));
        errors.normal += angle * angle / double(mesh.position.size());
    }
    errors.normal = std::sqrt(errors.normal);
    for (std::size_t t = 0; t < mesh.triangles(); ++t)
        visit((mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3.0);
    return errors;
}
//! [BallErrors]

}  // namespace surface
