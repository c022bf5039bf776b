/// @file
/// The same surface on the CPU, written to be read: every particle for every node, every cell one by one.
#pragma once
#include <vector>

#include "14_surface_generation/case_table.h"
#include "14_surface_generation/field.cuh"
#include "14_surface_generation/marching_cubes.cuh"
#include "14_surface_generation/mesh.h"

namespace surface {

/// Blobs as blob_kernel makes them, in double but for the eigenvalues. One for each particle.
struct BlobsCpu {
    std::vector<float4> blob;
    std::vector<Stretch> stretch;
};

inline BlobsCpu blobs_cpu(const std::vector<float4>& position, const BlobShape& shape) {
    BlobsCpu blobs;
    for (const float4& p : position) {
        const glm::dvec3 x(p.x, p.y, p.z);
        double near = 0, sum = 0;
        glm::dvec3 mean(0);
        glm::dmat3 square(0);
        for (const float4& other : position) {
            const glm::dvec3 d = glm::dvec3(other.x, other.y, other.z) - x;
            const double q = glm::length(d) / shape.neighbour_reach_m;
            if (!(q < 1)) continue;
            const double w = 1 - q * q * q;
            ++near;
            sum += w;
            mean += w * d;
            square += w * glm::outerProduct(d, d);
        }
        mean /= sum;
        Eigen eigen{glm::vec3(0), glm::mat3(1)};
        glm::vec3 axes(shape.lonely);
        if (near > double(shape.few) * shape.full_ball) {
            eigen = eigen_of(glm::mat3(square / sum - glm::outerProduct(mean, mean)));
            axes = stretches(shape, eigen.value);
        }
        const glm::dvec3 centre = x + double(shape.pull) * mean;
        blobs.blob.push_back(make_float4(float(centre.x), float(centre.y), float(centre.z),
                                         shape.radius_m * glm::max(axes.x, glm::max(axes.y, axes.z))));
        blobs.stretch.push_back(make_stretch(shape, eigen, axes));
    }
    return blobs;
}

//! [field_cpu]
/// The field at x_m: the sums of the chapter as they stand in the text, in double.
inline double field_cpu(FieldKind kind, glm::dvec3 x_m, const std::vector<float4>& blob,
                        const std::vector<Stretch>& stretch, const FieldShape& shape) {
    const double pi = 3.14159265358979323846, radius = shape.radius_m;
    double sum = 0;
    glm::dvec3 place(0);
    for (std::size_t k = 0; k < blob.size(); ++k) {
        const glm::dvec3 d = x_m - glm::dvec3(blob[k].x, blob[k].y, blob[k].z);
        double q_squared = glm::dot(d, d) / (radius * radius), height = 1;
        if (kind == FieldKind::anisotropic) {
            const Stretch& m = stretch[k];
            q_squared = m.xx * d.x * d.x + m.yy * d.y * d.y + m.zz * d.z * d.z +
                        2 * (m.xy * d.x * d.y + m.xz * d.x * d.z + m.yz * d.y * d.z);
            height = m.height;
        }
        if (!(q_squared < 1)) continue;
        const double w = std::pow(1 - q_squared, 3);
        sum += height * w;
        place += w * d;
    }
    if (kind != FieldKind::zhu_bridson)
        return sum * shape.volume_m3 * 315 / (64 * pi * radius * radius * radius);
    return sum > 0 ? 1 - glm::length(place) / (sum * radius) : 0;
}
//! [field_cpu]

/// A field on a dense box of nodes, x fastest.
struct DenseField {
    glm::ivec3 nodes;
    glm::vec3 origin_m;
    float spacing_m;
    std::vector<float> value;

    std::size_t at(int x, int y, int z) const { return (std::size_t(z) * nodes.y + y) * nodes.x + x; }
};

//! [cubes_cpu]
/// Marching cubes, cell after cell. A vertex is made by the first cell that needs it; the others find its
/// number where its edge's lower node keeps it, one for each axis.
inline Mesh cubes_cpu(const DenseField& field, float iso, const CaseTable& table) {
    Mesh mesh;
    std::vector<std::uint32_t> number(3 * field.value.size(), kNone);
    std::size_t offset[kCorners], edge_at[kEdges];
    for (int c = 0; c < kCorners; ++c) offset[c] = field.at(c & 1, c >> 1 & 1, c >> 2);
    for (int e = 0; e < kEdges; ++e) edge_at[e] = 3 * offset[lower_corner(e)] + edge_axis(e);
    for (int z = 0; z + 1 < field.nodes.z; ++z)
        for (int y = 0; y + 1 < field.nodes.y; ++y)
            for (int x = 0; x + 1 < field.nodes.x; ++x) {
                const std::size_t node = field.at(x, y, z);
                int inside = 0;
                for (int c = 0; c < kCorners; ++c) inside |= int(field.value[node + offset[c]] > iso) << c;
                for (int k = 0; k < 3 * table.triangles[inside]; ++k) {
                    const int edge = table.edge[inside][k];
                    std::uint32_t& vertex = number[3 * node + edge_at[edge]];
                    if (vertex == kNone) {
                        vertex = std::uint32_t(mesh.position.size());
                        const int low = lower_corner(edge), axis = edge_axis(edge);
                        glm::vec3 place(x + (low & 1), y + (low >> 1 & 1), z + (low >> 2));
                        place[axis] += crossing(field.value[node + offset[low]],
                                                field.value[node + offset[low | 1 << axis]], iso);
                        const glm::vec3 at = field.origin_m + field.spacing_m * place;
                        mesh.position.push_back(make_float4(at.x, at.y, at.z, 1));
                    }
                    mesh.index.push_back(vertex);
                }
            }
    return mesh;
}
//! [cubes_cpu]

}  // namespace surface
