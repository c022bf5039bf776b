/// @file
/// Fields given by a formula or node by node instead of by particles: for what the right surface is known.
#pragma once
#include <vector>

#include "14_surface_generation/device_mesh.cuh"

namespace surface {

/// A field on a dense box of nodes, and its surface. Nodes beyond `nodes`, which fill up the last bricks, are
/// outside. @pre so are all nodes of the box's rim, or the surface has a hole there
class KnownField {
  public:
    /// @param value  of a node: value(ivec3 node, vec3 place_m), larger than iso inside
    template <class Value>
    KnownField(glm::ivec3 nodes, glm::vec3 origin_m, float spacing_m, float iso, Value value) : iso_(iso) {
        const Lattice lattice{origin_m, spacing_m, (nodes + (kBrick - 1)) / kBrick};
        bricks_.build_all(lattice);
        std::vector<float> field(std::size_t(kBrickNodes) * bricks_.count(), -INFINITY);
        const course::DeviceBuffer<int4>& corners = bricks_.corners();
        const std::vector<int4> corner = corners.download();
        for (std::uint32_t b = 0; b < bricks_.count(); ++b)
            for (int k = 0; k < kBrickNodes; ++k) {
                const glm::ivec3 node =
                    glm::ivec3(corner[b].x, corner[b].y, corner[b].z) + item_of(k, glm::ivec3(kBrick));
                if (node.x < nodes.x && node.y < nodes.y && node.z < nodes.z)
                    field[std::size_t(kBrickNodes) * b + k] = value(node, lattice.place_m(glm::vec3(node)));
            }
        field_ = course::DeviceBuffer<float>(field);
    }

    MeshSize build() { return size_ = cubes_.count(field_.data(), bricks_.view(), iso_); }
    MeshSize size() const { return size_; }
    void write(const MeshOut& out) const {
        cubes_.write(out, field_.data(), bricks_.view(), bricks_.lattice());
    }
    Mesh mesh(Normals normals = Normals::from_field) {
        build();
        DeviceMesh mesh(normals);
        mesh.take(*this);
        return mesh.download();
    }
    const Bricks& bricks() const { return bricks_; }
    const course::DeviceBuffer<float>& field() const { return field_; }

  private:
    float iso_;
    Bricks bricks_;
    course::DeviceBuffer<float> field_;
    MarchingCubes cubes_;
    MeshSize size_;
};

/// The ball of radius 1 that the reference meshes have: n^3 nodes over [-1.5, 1.5]^3, its centre off the
/// nodes.
enum class BallField { distance, quadratic };
inline KnownField known_ball(int n, BallField kind, glm::vec3 centre = {0.0123f, 0.0371f, -0.0217f},
                             float half_box = 1.5f) {
    return KnownField(glm::ivec3(n), glm::vec3(-half_box), 2 * half_box / float(n - 1), 0,
                      [=](glm::ivec3, glm::vec3 x) {
                          const float r2 = glm::dot(x - centre, x - centre);
                          return kind == BallField::distance ? 1 - std::sqrt(r2) : 1 - r2;
                      });
}
/// The torus of the reference meshes: radii 1 and 0.4 over [-1.7, 1.7]^3.
inline KnownField known_torus(int n) {
    const glm::vec3 centre{0.0123f, 0.0371f, -0.0217f};
    return KnownField(glm::ivec3(n), glm::vec3(-1.7f), 3.4f / float(n - 1), 0, [=](glm::ivec3, glm::vec3 x) {
        const glm::vec3 d = x - centre;
        const float ring = std::sqrt(d.x * d.x + d.y * d.y) - 1;
        return 0.4f - std::sqrt(ring * ring + d.z * d.z);
    });
}

}  // namespace surface
