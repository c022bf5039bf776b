/// @file
/// Chapter 14's surface, calmer: what is finer than the particles is noise, and refraction shows every dent.
#pragma once
#include <utility>

#include "14_surface_generation/surface.cuh"

namespace water {

//! [smooth]
/// One block per brick, one thread per row of eight nodes: each node becomes the mean of itself (half) and
/// its two neighbours along one axis (a quarter each). Where there is no brick the field is 0.
template <int kAxis>
__global__ void smooth_kernel(float* smoothed, const float* field, const std::uint32_t* around) {
    const std::uint32_t b = blockIdx.x;
    const int y = int(threadIdx.x) % surface::kBrick, z = int(threadIdx.x) / surface::kBrick;
    const glm::ivec3 step(kAxis == 0, kAxis == 1, kAxis == 2);
    for (int x = 0; x < surface::kBrick; ++x) {
        const glm::ivec3 node(x, y, z);
        const std::size_t at = b * std::size_t(surface::kBrickNodes) + threadIdx.x * surface::kBrick + x;
        smoothed[at] = 0.5f * field[at] + 0.25f * (surface::node_value(field, around, b, node - step) +
                                                   surface::node_value(field, around, b, node + step));
    }
}
//! [smooth]

/// A field smoothed on its bricks, and the mesh of it. Memory grows as needed and is kept.
class SmoothedSurface {
  public:
    /// @param rounds  of smoothing along each axis: n of them are a Gaussian of sqrt(n / 2) nodes
    void build(const surface::Surface& from, int rounds) {
        from_ = &from;
        size_ = {};
        if (from.brick_count() == 0) return;
        const std::size_t nodes = surface::kBrickNodes * std::size_t(from.brick_count());
        surface::make_room(field_, nodes);
        surface::make_room(other_, nodes);
        CUDA_CHECK(
            cudaMemcpy(field_.data(), from.field().data(), nodes * sizeof(float), cudaMemcpyDeviceToDevice));
        for (int round = 0; round < rounds; ++round) {
            pass<0>();
            pass<1>();
            pass<2>();
        }
        size_ = marching_cubes_.count(field_.data(), from.bricks().view(), from.settings().iso);
    }
    /// As chapter 14's Surface: GlMesh::take() can't tell them apart.
    surface::MeshSize size() const { return size_; }
    void write(const surface::MeshOut& out) const {
        if (size_.triangles > 0)
            marching_cubes_.write(out, field_.data(), from_->bricks().view(), from_->bricks().lattice());
    }
    const float* field() const { return field_.data(); }
    const surface::Surface& bricks_of() const { return *from_; }

  private:
    template <int kAxis>
    void pass() {
        smooth_kernel<kAxis><<<from_->brick_count(), surface::kBrickRows>>>(other_.data(), field_.data(),
                                                                            from_->bricks().view().around);
        CUDA_CHECK(cudaGetLastError());
        std::swap(field_, other_);
    }

    const surface::Surface* from_ = nullptr;
    course::DeviceBuffer<float> field_, other_;
    surface::MarchingCubes marching_cubes_;
    surface::MeshSize size_;
};

}  // namespace water
