// Exercise 14.1: marching tetrahedra.
//
// A cube has ambiguous faces because a face has four corners. A tetrahedron's faces have three: there is no
// choice to be made, and no table of 256 cases. Cut each cube into six tetrahedra, and 16 cases are left,
// which by symmetry are three: one corner on its own, two against two, nobody alone.
//
// Counter-clockwise is as seen from outside. Which way round that is follows from the order of the corners:
// for the corners a, b, c, d of this exercise (b - a) x (c - a) points to d's side.
#pragma once
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "common/todo.h"

namespace surface {

struct TetCorner {
    glm::dvec3 place_m;
    double value;  // inside: larger than 0
};
using TetTriangle = std::array<glm::dvec3, 3>;

// The surface value = 0 in one tetrahedron: no triangle, one or two, counter-clockwise as seen from outside.
// A vertex lies where the value, taken as linear along the edge, is 0.
inline std::vector<TetTriangle> tetrahedron_triangles(std::array<TetCorner, 4> corner) {
    // TODO(14.1): sort the corners so that those inside come first, and keep the orientation: each swap of
    // two corners turns it round, so an odd number of swaps needs one more. About 25 lines.
    (void)corner;
    const glm::dvec3 nowhere(course::kTodo);
    return std::vector<TetTriangle>(3, {nowhere, nowhere, nowhere});
}

}  // namespace surface
