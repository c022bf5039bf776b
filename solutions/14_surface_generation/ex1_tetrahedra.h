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
    // <solution>
    bool turned = false;
    int inside = 0;
    for (int k = 0; k < 4; ++k)
        if (corner[k].value > 0) {
            if (k != inside) {
                std::swap(corner[k], corner[inside]);
                turned = !turned;
            }
            ++inside;
        }
    // A swap that leaves who is inside and who is not: of the first two, or of the last two.
    if (turned) inside >= 2 ? std::swap(corner[0], corner[1]) : std::swap(corner[2], corner[3]);
    const auto cut = [&](int a, int b) {
        const double part = corner[a].value / (corner[a].value - corner[b].value);
        return corner[a].place_m + part * (corner[b].place_m - corner[a].place_m);
    };
    if (inside == 1) return {{cut(0, 1), cut(0, 2), cut(0, 3)}};
    if (inside == 2) {
        const glm::dvec3 start = cut(0, 2), across = cut(1, 3);
        return {{start, cut(0, 3), across}, {start, across, cut(1, 2)}};
    }
    if (inside == 3) return {{cut(3, 0), cut(3, 1), cut(3, 2)}};
    return {};
    // <stub>
    //| (void)corner;
    //| const glm::dvec3 nowhere(course::kTodo);
    //| return std::vector<TetTriangle>(3, {nowhere, nowhere, nowhere});
    // </solution>
}

}  // namespace surface
