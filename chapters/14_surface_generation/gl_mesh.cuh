/// @file
/// A mesh in OpenGL's buffers, written there by kernels: no copy through the host.
#pragma once
#include <memory>

#include "06_gl_interop/interop_buffer.cuh"
#include "14_surface_generation/device_mesh.cuh"
#include "14_surface_generation/mesh_renderer.h"

namespace surface {

/// Room for the mesh of a surface. It grows as needed and is kept. Needs a current OpenGL context.
class GlMesh {
  public:
    explicit GlMesh(Normals normals = Normals::from_field,
                    interop::Handover wanted = interop::Handover::shared)
        : normals_(normals), wanted_(wanted) {}

    //! [take]
    /// Takes over the mesh of any maker that has size() and write(): a Surface, for instance. CUDA gets the
    /// buffers, the last two kernels of marching cubes write into them, OpenGL gets them back.
    template <class Maker>
    void take(const Maker& maker) {
        size_ = maker.size();
        if (size_.triangles == 0) return;  // nothing to hand over, and nothing to draw
        make_room(position_, size_.vertices);
        if (normals_ != Normals::none) make_room(normal_, size_.vertices);
        make_room(index_, 3 * std::size_t(size_.triangles));
        const MeshOut out{position_->map(), normal_ ? normal_->map() : nullptr, index_->map()};
        maker.write(out);
        position_->unmap();
        if (normal_) normal_->unmap();
        index_->unmap();
    }
    //! [take]

    MeshSize size() const { return size_; }
    bool empty() const { return size_.triangles == 0; }
    /// For a MeshRenderer, or for draw calls of one's own. All 0 while the mesh is empty.
    MeshBuffers buffers() const {
        if (empty()) return {};
        return {position_->gl_buffer().id(), normal_ ? normal_->gl_buffer().id() : 0,
                index_->gl_buffer().id(), size_.triangles};
    }
    /// How the mesh comes to OpenGL, for the user.
    std::string handover() const { return position_ ? position_->why() : "nothing has been handed over yet"; }

  private:
    template <class T>
    void make_room(std::unique_ptr<interop::InteropBuffer<T>>& buffer, std::size_t n) {
        if (buffer && buffer->size() >= n) return;
        buffer.reset();  // free before asking for more
        buffer = std::make_unique<interop::InteropBuffer<T>>(n + n / 4, wanted_);
    }

    Normals normals_;
    interop::Handover wanted_;
    MeshSize size_;
    std::unique_ptr<interop::InteropBuffer<float4>> position_, normal_;
    std::unique_ptr<interop::InteropBuffer<std::uint32_t>> index_;
};

}  // namespace surface
