/// @file
/// The triangles of marching cubes, case by case, worked out from one rule instead of copied from a table.
#pragma once
#include <array>
#include <cstdint>
#include <stdexcept>

/// Chapter 14: a surface from particles.
namespace surface {

//! [cube]
// A cell's corner c lies at x = c & 1, y = c >> 1 & 1, z = c >> 2. Its edge e runs along axis e / 4 from its
// lower corner; the two low bits of e are that corner's place along the next two axes.
constexpr int kCorners = 8, kEdges = 12;

constexpr int edge_axis(int edge) {
    return edge / 4;
}
constexpr int lower_corner(int edge) {
    const int axis = edge / 4;
    return (edge & 1) << (axis + 1) % 3 | (edge >> 1 & 1) << (axis + 2) % 3;
}
/// The edge between two neighbouring corners.
constexpr int edge_between(int corner, int other) {
    const int along = corner ^ other, low = corner & other;
    const int axis = along == 1 ? 0 : along == 2 ? 1 : 2;
    return 4 * axis + (low >> (axis + 1) % 3 & 1) + 2 * (low >> (axis + 2) % 3 & 1);
}
/// The corners of face 0 to 5 (axis face / 2, its lower or upper side), counter-clockwise as seen from
/// outside.
constexpr std::array<int, 4> face_corners(int face) {
    const int axis = face / 2, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    if (face % 2) return {1 << axis, (1 << axis) + u, (1 << axis) + u + v, (1 << axis) + v};
    return {0, v, u + v, u};
}
//! [cube]

constexpr int kMaxTriangles = 5;  ///< of one cell; make_case_table() would notice if it were not enough

/// What is cut out of a cell, for each of the 256 ways in which its corners are inside or outside. Corner c
/// is inside if bit c of the case is set.
struct CaseTable {
    std::uint8_t triangles[256]{};
    std::uint8_t edge[256][3 * kMaxTriangles]{};  ///< three edges a triangle, one vertex on each
};

/// For each edge that the surface crosses, the one that follows on the outline of its polygon.
using Outline = std::array<int, kEdges>;

//! [outline]
/// The rule. Walk around each face, seen from outside: whenever a run of inside corners ends, a line of the
/// surface leads from where the run began to where it ends. Each run is cut off by a line of its own, so on a
/// face with two inside corners across from each other these are *separated*. The cell on the other side of
/// the face sees the same four corners and draws the same lines, the other way around: no holes, whatever the
/// rest of the two cells looks like.
inline Outline outline_of(int inside) {
    Outline next;
    next.fill(-1);
    const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
    for (int face = 0; face < 6; ++face) {
        const std::array<int, 4> corner = face_corners(face);
        for (int last = 0; last < 4; ++last) {
            if (!is_inside(corner[last]) || is_inside(corner[(last + 1) % 4])) continue;  // no run ends here
            int first = last;
            while (is_inside(corner[(first + 3) % 4])) first = (first + 3) % 4;
            next[edge_between(corner[(first + 3) % 4], corner[first])] =
                edge_between(corner[last], corner[(last + 1) % 4]);
        }
    }
    return next;
}
//! [outline]

/// Do two edges lie in one face of the cube?
inline bool share_face(int edge, int other) {
    for (int face = 0; face < 6; ++face) {
        int found = 0;
        const std::array<int, 4> corner = face_corners(face);
        for (int k = 0; k < 4; ++k) {
            const int side = edge_between(corner[k], corner[(k + 1) % 4]);
            found += (side == edge) + (side == other);
        }
        if (found == 2) return true;
    }
    return false;
}

//! [triangulate]
/// Cuts the polygon into triangles and adds them to the case. A cut that runs across a face of the cube is
/// not allowed: the cell on the other side might make the same one, and four triangles would meet there.
/// @param polygon, size  crossed edges in order; @param from, to  the part between these two is to be cut
/// @returns false, with the case as it was, if that can't be done
inline bool triangulate(CaseTable& table, int inside, const int* polygon, int size, int from, int to) {
    if (to - from < 2) return true;
    const auto allowed = [&](int a, int b) {
        return b - a == 1 || b - a == size - 1 || !share_face(polygon[a], polygon[b]);
    };
    const std::uint8_t before = table.triangles[inside];
    for (int tip = from + 1; tip < to; ++tip) {
        if (!allowed(from, tip) || !allowed(tip, to)) continue;
        if (triangulate(table, inside, polygon, size, from, tip) &&
            triangulate(table, inside, polygon, size, tip, to) && table.triangles[inside] < kMaxTriangles) {
            std::uint8_t* edge = table.edge[inside] + 3 * table.triangles[inside]++;
            edge[0] = std::uint8_t(polygon[from]);
            edge[1] = std::uint8_t(polygon[tip]);
            edge[2] = std::uint8_t(polygon[to]);
            return true;
        }
        table.triangles[inside] = before;
    }
    return false;
}
//! [triangulate]

//! [make_case_table]
/// All 256 cases: outlines, then triangles. Counter-clockwise as seen from outside.
inline CaseTable make_case_table() {
    CaseTable table;
    for (int inside = 0; inside < 256; ++inside) {
        Outline next = outline_of(inside);
        for (int start = 0; start < kEdges; ++start) {
            int polygon[kEdges], size = 0;
            for (int edge = start; next[edge] >= 0;) {  // around one polygon, once
                polygon[size++] = edge;
                const int following = next[edge];
                next[edge] = -1;
                edge = following;
            }
            if (!triangulate(table, inside, polygon, size, 0, size - 1))
                throw std::logic_error("a case of marching cubes can't be cut into triangles");
        }
    }
    return table;
}
//! [make_case_table]

}  // namespace surface
