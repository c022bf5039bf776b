/// @file
/// From particles to a surface: the whole way, with all its memory.
#pragma once
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "14_surface_generation/blob_field.cuh"
#include "14_surface_generation/marching_cubes.cuh"

namespace surface {

//! [lattice_around]
/// A lattice that holds every brick the particles need. Its nodes stay where they are when the box moves, or
/// the surface of water at rest would flicker with each splash elsewhere.
/// @throws course::BadInput if it has more nodes along an axis than can be counted
inline Lattice lattice_around(const patterns::Bounds& box, float reach_m, float spacing_m) {
    const glm::dvec3 h(spacing_m), rim(double(reach_m) + 3 * double(spacing_m));
    const glm::dvec3 low = glm::floor((glm::dvec3(box.low_m) - rim) / h);
    const glm::dvec3 nodes = glm::ceil((glm::dvec3(box.high_m) + rim) / h) - low + 1.0;
    const double longest = glm::max(nodes.x, glm::max(nodes.y, nodes.z));
    if (!(longest < 1 << 24))  // where a float can no longer tell one node from the next
        throw course::BadInput(
            "the particles' box is " + std::to_string(longest) +
            " nodes long, and 16777216 is the most: take a coarser field or a smaller box");
    return {glm::vec3(low * h), spacing_m, glm::ivec3(glm::ceil(nodes / double(kBrick)))};
}
//! [lattice_around]

//! [Surface]
/// Makes surfaces, one after the other. Memory grows to what the largest one needed and is kept.
class Surface {
  public:
    /// @throws course::BadInput
    explicit Surface(const SurfaceSettings& settings) : settings_(complete(settings)), blobs_(settings_) {}

    /// Field and sizes for n particles in device memory. Those at NaN or infinity are left out. Waits for the
    /// device. @throws course::BadInput if the field does not fit into its memory
    MeshSize build(const float4* position, std::uint32_t n) {
        size_ = {};
        find_bounds_.launch(position, n);
        const patterns::Bounds box = find_bounds_.download();
        empty_ = !(box.low_m.x <= box.high_m.x);  // nobody, or nobody at a finite place
        if (empty_) return size_;
        blobs_.build(position, n, box);
        const float node_m = settings_.particle_spacing_m / settings_.nodes_per_spacing;
        const Lattice lattice = lattice_around(box, blobs_.reach_m(), node_m);
        if (settings_.sparse)
            bricks_.build(lattice, blobs_.blob(), n);
        else
            bricks_.build_all(lattice);
        make_room(field_, std::size_t(kBrickNodes) * bricks_.count());
        blobs_.fill(field_.data(), bricks_);
        size_ = marching_cubes_.count(field_.data(), bricks_.view(), settings_.iso);
        return size_;
    }

    /// Writes the mesh of the last build(): size().vertices positions and normals, 3 size().triangles
    /// indices.
    void write(const MeshOut& out) const {
        if (size_.triangles > 0) marching_cubes_.write(out, field_.data(), bricks_.view(), bricks_.lattice());
    }

    MeshSize size() const { return size_; }
    const SurfaceSettings& settings() const { return settings_; }
    std::uint32_t brick_count() const { return empty_ ? 0 : bricks_.count(); }
    const Blobs& blobs() const { return blobs_; }
    const Bricks& bricks() const { return bricks_; }
    const course::DeviceBuffer<float>& field() const { return field_; }
    const MarchingCubes& marching_cubes() const { return marching_cubes_; }
    /// Device memory held now.
    std::size_t bytes() const {
        return 6 * sizeof(float) + blobs_.bytes() + bricks_.bytes() + field_.bytes() +  // six: the bounds
               marching_cubes_.bytes();
    }

  private:
    SurfaceSettings settings_;
    patterns::BoundsFinder find_bounds_{patterns::BoundsMethod::walk};
    Blobs blobs_;
    Bricks bricks_;
    course::DeviceBuffer<float> field_;
    MarchingCubes marching_cubes_;
    MeshSize size_;
    bool empty_ = true;
};
//! [Surface]

}  // namespace surface
