/// @file
/// A mesh in device memory, and its copy on the host.
#pragma once
#include "14_surface_generation/mesh.h"
#include "14_surface_generation/surface.cuh"

namespace surface {

enum class Normals { none, from_field };

/// Room for the mesh of a surface. It grows as needed and is kept.
class DeviceMesh {
  public:
    explicit DeviceMesh(Normals normals = Normals::from_field) : normals_(normals) {}

    /// Takes over the mesh of any maker that has size() and write(): a Surface, for instance.
    template <class Maker>
    void take(const Maker& maker) {
        size_ = maker.size();
        make_room(position_, size_.vertices);
        if (normals_ != Normals::none) make_room(normal_, size_.vertices);
        make_room(index_, 3 * std::size_t(size_.triangles));
        maker.write({position_.data(), normal_.data(), index_.data()});
    }
    Mesh download() const {
        Mesh mesh{position_.download(), normal_.download(), index_.download()};
        mesh.position.resize(size_.vertices);  // without the room to spare
        if (normals_ != Normals::none) mesh.normal.resize(size_.vertices);
        mesh.index.resize(3 * std::size_t(size_.triangles));
        return mesh;
    }
    MeshSize size() const { return size_; }
    const float4* position() const { return position_.data(); }
    const float4* normal() const { return normal_.data(); }
    const std::uint32_t* index() const { return index_.data(); }
    std::size_t bytes() const { return position_.bytes() + normal_.bytes() + index_.bytes(); }

  private:
    Normals normals_;
    MeshSize size_;
    course::DeviceBuffer<float4> position_, normal_;
    course::DeviceBuffer<std::uint32_t> index_;
};

/// Particles to mesh in one call, for tests and for a single picture.
inline Mesh mesh_of(const std::vector<float4>& position, const SurfaceSettings& settings) {
    const course::DeviceBuffer<float4> particles(position);
    Surface surface(settings);
    surface.build(particles.data(), std::uint32_t(position.size()));
    DeviceMesh mesh;
    mesh.take(surface);
    return mesh.download();
}

}  // namespace surface
