/// @file
/// A mesh on the host: its measures, and what is wrong with it.
#pragma once
#include <vector_types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <tuple>
#include <utility>
#include <vector>

namespace surface {

/// Shared vertices, and three of them a triangle, counter-clockwise as seen from outside.
struct Mesh {
    std::vector<float4> position;      ///< x, y, z in m, and 1
    std::vector<float4> normal;        ///< length 1, or empty
    std::vector<std::uint32_t> index;  ///< three a triangle

    std::size_t triangles() const { return index.size() / 3; }
    glm::dvec3 corner(std::size_t triangle, int k) const {
        const float4& p = position[index[3 * triangle + k]];
        return {p.x, p.y, p.z};
    }
};

//! [measures]
struct Measures {
    double area_m2 = 0, volume_m3 = 0;
};

/// The volume by the divergence theorem: tetrahedra from one point to each triangle, those that face it
/// counted negative. The point is a corner of the mesh, so that nothing cancels far from the origin.
inline Measures measure(const Mesh& mesh) {
    Measures sum;
    if (mesh.triangles() == 0) return sum;
    const glm::dvec3 origin = mesh.corner(0, 0);
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        const glm::dvec3 a = mesh.corner(t, 0) - origin, b = mesh.corner(t, 1) - origin,
                         c = mesh.corner(t, 2) - origin;
        sum.area_m2 += 0.5 * glm::length(glm::cross(b - a, c - a));
        sum.volume_m3 += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}
//! [measures]

//! [Soundness]
/// A sound mesh is closed and has no flaw: everything but euler, parts and largest is 0.
struct Soundness {
    std::size_t bad_indices = 0;           ///< beyond the vertices
    std::size_t unpaired_edges = 0;        ///< directed edges that don't occur once each way
    std::size_t degenerate_triangles = 0;  ///< two corners are one vertex
    std::size_t flat_triangles = 0;        ///< no area, as the float positions have it
    std::size_t duplicate_triangles = 0;   ///< same three vertices as another one
    std::size_t unused_vertices = 0;
    std::size_t pinched_vertices = 0;  ///< triangles around it form more than one fan
    long euler = 0;                    ///< vertices - edges + triangles: 2 for a ball, 0 for a torus
    std::size_t parts = 0;             ///< pieces that are not connected

    bool closed() const { return bad_indices == 0 && unpaired_edges == 0; }
    bool sound() const {
        return closed() && degenerate_triangles == 0 && duplicate_triangles == 0 && unused_vertices == 0 &&
               pinched_vertices == 0;
    }
};
Soundness inspect(const Mesh& mesh);
//! [Soundness]

namespace detail {

/// Who belongs together: each item points towards the one that stands for its group.
struct Groups {
    std::vector<std::size_t> parent;
    explicit Groups(std::size_t n) : parent(n) {
        for (std::size_t i = 0; i < n; ++i) parent[i] = i;
    }
    std::size_t find(std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) { parent[find(a)] = find(b); }
};

}  // namespace detail

inline Soundness inspect(const Mesh& mesh) {
    Soundness found;
    const std::size_t vertices = mesh.position.size(), triangles = mesh.triangles();
    for (std::uint32_t i : mesh.index) found.bad_indices += i >= vertices;
    if (found.bad_indices > 0) return found;

    struct Side {
        std::uint32_t from, to, triangle;
    };
    std::vector<Side> sides;
    std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> sorted_corners;
    std::vector<std::uint32_t> uses(vertices);
    for (std::uint32_t t = 0; t < triangles; ++t) {
        std::uint32_t v[3] = {mesh.index[3 * t], mesh.index[3 * t + 1], mesh.index[3 * t + 2]};
        for (int k = 0; k < 3; ++k) {
            sides.push_back({v[k], v[(k + 1) % 3], t});
            ++uses[v[k]];
        }
        found.degenerate_triangles += v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        const glm::dvec3 a = mesh.corner(t, 0);
        found.flat_triangles += !(glm::length(glm::cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a)) > 0);
        std::sort(v, v + 3);
        sorted_corners.push_back({v[0], v[1], v[2]});
    }
    std::sort(sorted_corners.begin(), sorted_corners.end());
    for (std::size_t t = 1; t < triangles; ++t)
        found.duplicate_triangles += sorted_corners[t] == sorted_corners[t - 1];
    found.unused_vertices = std::size_t(std::count(uses.begin(), uses.end(), 0u));

    // Edges: the sides of either direction side by side. Each edge has one of each.
    const auto low = [](const Side& s) { return std::min(s.from, s.to); };
    const auto high = [](const Side& s) { return std::max(s.from, s.to); };
    std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) {
        return std::make_tuple(low(a), high(a), a.from) < std::make_tuple(low(b), high(b), b.from);
    });
    detail::Groups part(vertices), fan(3 * triangles);  // a fan is made of corners of triangles
    const auto corner_at = [&](std::uint32_t triangle, std::uint32_t vertex) {
        std::size_t k = 3 * std::size_t(triangle);
        while (mesh.index[k] != vertex) ++k;
        return k;
    };
    std::size_t edges = 0;
    for (std::size_t first = 0, end; first < sides.size(); first = end) {
        for (end = first; end < sides.size() && low(sides[end]) == low(sides[first]) &&
                          high(sides[end]) == high(sides[first]);)
            ++end;
        ++edges;
        part.join(sides[first].from, sides[first].to);
        if (end - first != 2 || sides[first].from == sides[first + 1].from) {
            found.unpaired_edges += end - first;
            continue;
        }
        for (const std::uint32_t vertex : {sides[first].from, sides[first].to})
            fan.join(corner_at(sides[first].triangle, vertex), corner_at(sides[first + 1].triangle, vertex));
    }
    std::vector<std::uint32_t> fans(vertices);
    for (std::size_t corner = 0; corner < 3 * triangles; ++corner)
        if (fan.find(corner) == corner) ++fans[mesh.index[corner]];
    for (std::size_t v = 0; v < vertices; ++v) {
        found.pinched_vertices += fans[v] > 1;
        found.parts += uses[v] > 0 && part.find(v) == v;
    }
    found.euler = long(vertices - found.unused_vertices) - long(edges) + long(triangles);
    return found;
}

}  // namespace surface
