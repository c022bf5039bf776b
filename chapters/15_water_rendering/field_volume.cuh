/// @file
/// The field of chapter 14 as a texture that shaders can read anywhere.
#pragma once
#include <memory>

#include "06_gl_interop/interop_buffer.cuh"
#include "15_water_rendering/gl_volume.h"
#include "15_water_rendering/smoothed_surface.cuh"

namespace water {

//! [unpack]
/// One block per brick, one thread per row of eight nodes: from the brick's own memory to its place in the
/// whole box. Where there is no brick the volume stays 0, as the field is.
inline __global__ void unpack_bricks_kernel(float* volume, const float* field, const int4* corner,
                                            glm::ivec3 size) {
    const int4 first = corner[blockIdx.x];
    const int y = int(threadIdx.x) % surface::kBrick, z = int(threadIdx.x) / surface::kBrick;
    const float* row = field + blockIdx.x * std::size_t(surface::kBrickNodes) + threadIdx.x * surface::kBrick;
    float* out = volume + (std::size_t(first.z + z) * size.y + first.y + y) * size.x + first.x;
    for (int x = 0; x < surface::kBrick; ++x) out[x] = row[x];
}
//! [unpack]

constexpr int kBlock = 4;  // nodes along the edge of a block of the map of free ways

//! [free_ways]
/// One thread per block of 4^3 cells: 0 if the surface may pass through it, else a number larger than all. A
/// block looks at the nodes of its far faces too, which it shares with its neighbours.
inline __global__ void find_surface_kernel(float* blocks_free, const float* volume, float iso,
                                           glm::ivec3 size, glm::ivec3 blocks) {
    const int b = blockIdx.x * blockDim.x + threadIdx.x;
    if (b >= blocks.x * blocks.y * blocks.z) return;
    const glm::ivec3 first = kBlock * surface::item_of(b, blocks), last = glm::min(first + kBlock, size - 1);
    bool inside = false, outside = false;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const bool in = volume[(std::size_t(z) * size.y + y) * size.x + x] > iso;
                inside = inside || in;
                outside = outside || !in;
            }
    blocks_free[b] = inside && outside ? 0.0f : 1e6f;
}

/// One thread per block: from a block that has a neighbour at n, it is n + 1 blocks to the surface, or less.
inline __global__ void grow_free_kernel(float* grown, const float* blocks_free, glm::ivec3 blocks) {
    const int b = blockIdx.x * blockDim.x + threadIdx.x;
    if (b >= blocks.x * blocks.y * blocks.z) return;
    const glm::ivec3 here = surface::item_of(b, blocks);
    const glm::ivec3 low = glm::max(here - 1, glm::ivec3(0)), high = glm::min(here + 1, blocks - 1);
    float nearest = blocks_free[b];
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                nearest = fminf(nearest, 1 + blocks_free[(z * blocks.y + y) * blocks.x + x]);
    grown[b] = nearest;
}
//! [free_ways]

/// Owns the texture and the buffer it is filled from. Needs a current OpenGL context.
class FieldVolume {
  public:
    /// Takes over a smoothed field. No copy through the host where CUDA can use OpenGL's
    /// buffers. @throws course::BadInput if the box has more nodes along an axis than a texture can have
    void take(const SmoothedSurface& smoothed) {
        const surface::Surface& surface = smoothed.bricks_of();
        const bool empty = surface.brick_count() == 0;
        const surface::Lattice lattice = empty ? surface::Lattice{} : surface.bricks().lattice();
        const glm::ivec3 size = surface::kBrick * lattice.bricks;
        make_room(size);
        node_m_ = lattice.spacing_m;
        low_m_ = lattice.origin_m - 0.5f * node_m_;  // nodes are the middles of texels
        iso_ = surface.settings().iso;
        float* volume = buffer_->map();
        CUDA_CHECK(cudaMemset(volume, 0, buffer_->size() * sizeof(float)));
        if (!empty) {
            unpack_bricks_kernel<<<surface.brick_count(), surface::kBrickRows>>>(
                volume, smoothed.field(), surface.bricks().view().corner, size);
            CUDA_CHECK(cudaGetLastError());
        }
        find_free_ways(volume, size);
        buffer_->unmap();
        texture_->read_from(buffer_->gl_buffer());
        free_texture_->read_from(free_buffer_->gl_buffer());
    }

    const VolumeTexture& texture() const { return *texture_; }
    /// How many blocks from each block the surface surely is not, at least: a ray may go on so far at once.
    const VolumeTexture& free_texture() const { return *free_texture_; }
    float block_m() const { return kBlock * node_m_; }
    glm::vec3 low_m() const { return low_m_; }
    glm::vec3 size_m() const { return node_m_ * glm::vec3(texture_->size()); }
    float node_m() const { return node_m_; }
    float iso() const { return iso_; }

  private:
    void make_room(glm::ivec3 size) {
        if (texture_ && texture_->size() == size) return;
        texture_.reset();  // free before asking for more
        buffer_.reset();
        const glm::ivec3 blocks = (size + kBlock - 1) / kBlock;
        const std::size_t count = std::size_t(blocks.x) * blocks.y * blocks.z;
        free_texture_ = std::make_unique<VolumeTexture>(blocks, GL_NEAREST);
        free_buffer_ = std::make_unique<interop::InteropBuffer<float>>(count);
        growing_ = course::DeviceBuffer<float>(count);
        texture_ = std::make_unique<VolumeTexture>(size);
        buffer_ = std::make_unique<interop::InteropBuffer<float>>(std::size_t(size.x) * size.y * size.z);
    }

    void find_free_ways(const float* volume, glm::ivec3 size) {
        constexpr int kThreads = 128, kRounds = 8;  // even, so that the last one ends in OpenGL's buffer
        const glm::ivec3 blocks = free_texture_->size();
        const int launch = (blocks.x * blocks.y * blocks.z + kThreads - 1) / kThreads;
        float* free_blocks = free_buffer_->map();
        find_surface_kernel<<<launch, kThreads>>>(free_blocks, volume, iso_, size, blocks);
        CUDA_CHECK(cudaGetLastError());
        for (int round = 0; round < kRounds; round += 2) {
            grow_free_kernel<<<launch, kThreads>>>(growing_.data(), free_blocks, blocks);
            CUDA_CHECK(cudaGetLastError());
            grow_free_kernel<<<launch, kThreads>>>(free_blocks, growing_.data(), blocks);
            CUDA_CHECK(cudaGetLastError());
        }
        free_buffer_->unmap();
    }

    std::unique_ptr<VolumeTexture> texture_, free_texture_;
    std::unique_ptr<interop::InteropBuffer<float>> buffer_, free_buffer_;
    course::DeviceBuffer<float> growing_;
    glm::vec3 low_m_{0};
    float node_m_ = 1, iso_ = 0.5f;
};

}  // namespace water
