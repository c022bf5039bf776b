/// @file
/// Empty-space skipping: the grid in blocks of cells, and the largest extinction in each.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>
#include <vector>

#include "05_spatial_grid/cell_grid.cuh"
#include "05_spatial_grid/counting_sort.cuh"
#include "13_volume_rendering/ray.h"
#include "common/device_buffer.h"
#include "common/errors.h"

namespace volume {

/// Blocks of `edge` x `edge` x `edge` cells. edge 0: there are none, nothing is skipped.
struct Blocks {
    int edge = 0;
    glm::ivec3 size{0};
    const float* largest_per_m = nullptr;  ///< extinction, in the block and `apron` cells around it
    float clear_per_m = 0;  ///< a block up to here counts as empty; 0: only if nothing is there
};

inline glm::ivec3 block_counts(const grid::CellGrid& cells, int edge) {
    return (cells.size + edge - 1) / edge;
}

/// Cells that a sample inside a block can read: the block's own, and `apron` more on each side. Interpolation
/// alone wants one; where the place of reading is shifted (detail.cuh), the shift comes on top.
struct CellBox {
    glm::ivec3 low, high;  ///< first and last cell
};
__host__ __device__ inline CellBox cells_of_block(const grid::CellGrid& cells, int edge, int apron,
                                                  glm::ivec3 block) {
    return {glm::max(block * edge - apron, glm::ivec3(0)),
            glm::min((block + 1) * edge - 1 + apron, cells.size - 1)};
}

//! [block_kernel]
/// One thread per block. The cells around it count as well: between the outermost cell's centre and the
/// block's face the field is a mixture with the neighbour.
inline __global__ void block_kernel(float* largest_per_m, const float2* field, grid::CellGrid cells, int edge,
                                    int apron, glm::ivec3 blocks) {
    const int b = int(blockIdx.x * blockDim.x + threadIdx.x);
    if (b >= blocks.x * blocks.y * blocks.z) return;
    const CellBox box = cells_of_block(cells, edge, apron,
                                       {b % blocks.x, b / blocks.x % blocks.y, b / (blocks.x * blocks.y)});
    float largest = 0;
    for (int z = box.low.z; z <= box.high.z; ++z)
        for (int y = box.low.y; y <= box.high.y; ++y)
            for (int x = box.low.x; x <= box.high.x; ++x)
                largest = fmaxf(largest, field[grid::cell_number(cells, {x, y, z})].x);
    largest_per_m[b] = largest;
}
//! [block_kernel]

/// CPU reference.
inline std::vector<float> blocks_cpu(const std::vector<float2>& field, const grid::CellGrid& cells, int edge,
                                     int apron = 1) {
    const glm::ivec3 blocks = block_counts(cells, edge);
    std::vector<float> largest(std::size_t(blocks.x) * blocks.y * blocks.z, 0.0f);
    for (int z = 0; z < cells.size.z; ++z)
        for (int y = 0; y < cells.size.y; ++y)
            for (int x = 0; x < cells.size.x; ++x) {
                // This cell counts for every block that it or a cell up to `apron` from it lies in.
                const glm::ivec3 low = glm::max(glm::ivec3(x, y, z) - apron, glm::ivec3(0)) / edge;
                const glm::ivec3 high = glm::min(glm::ivec3(x, y, z) + apron, cells.size - 1) / edge;
                for (int k = low.z; k <= high.z; ++k)
                    for (int j = low.y; j <= high.y; ++j)
                        for (int i = low.x; i <= high.x; ++i) {
                            float& value = largest[(std::size_t(k) * blocks.y + j) * blocks.x + i];
                            value = std::max(value, field[grid::cell_number(cells, {x, y, z})].x);
                        }
            }
    return largest;
}

//! [clear_until]
/// How far along the ray from t_m on there is nothing: to the face where it leaves the block that t_m is in;
/// t_m itself if that block holds something.
__host__ __device__ inline float clear_until(const Blocks& blocks, const grid::CellGrid& cells,
                                             const Ray<float>& ray, float t_m) {
    const float blocks_per_m = cells.cells_per_m / float(blocks.edge);
    const glm::vec3 place = (ray.at(t_m) - cells.origin_m) * blocks_per_m;
    const glm::ivec3 block(glm::clamp(place, glm::vec3(0), glm::vec3(blocks.size - 1)));
    const int number = (block.z * blocks.size.y + block.y) * blocks.size.x + block.x;
    if (blocks.largest_per_m[number] > blocks.clear_per_m) return t_m;
    float leave_blocks = 1e30f;  // of the block, measured in blocks along the ray
    for (int axis = 0; axis < 3; ++axis) {
        const float d = ray.direction[axis];
        if (d == 0) continue;
        const float face = float(d > 0 ? block[axis] + 1 : block[axis]);
        leave_blocks = fminf(leave_blocks, (face - place[axis]) / d);
    }
    return t_m + leave_blocks / blocks_per_m;
}
//! [clear_until]

/// Owns the blocks of one grid.
class BlockMap {
  public:
    /// @param edge cells along a block, 1 to 64. @throws course::BadInput if it is not
    /// @param apron cells around a block that count as well
    BlockMap(const grid::CellGrid& cells, int edge, int apron = 1)
        : cells_(cells), edge_(edge), apron_(apron) {
        if (edge < 1 || edge > 64)
            throw course::BadInput("blocks are 1 to 64 cells long, not " + std::to_string(edge));
        size_ = block_counts(cells, edge);
        largest_ = course::DeviceBuffer<float>(std::size_t(size_.x) * size_.y * size_.z);
    }
    void build(const float2* field) {
        const std::uint32_t n = std::uint32_t(largest_.size());
        block_kernel<<<grid::blocks_for(n, 64), 64>>>(largest_.data(), field, cells_, edge_, apron_, size_);
        CUDA_CHECK(cudaGetLastError());
    }
    Blocks view(float clear_per_m = 0) const { return {edge_, size_, largest_.data(), clear_per_m}; }
    const course::DeviceBuffer<float>& largest() const { return largest_; }

  private:
    grid::CellGrid cells_;
    int edge_, apron_;
    glm::ivec3 size_;
    course::DeviceBuffer<float> largest_;
};

}  // namespace volume
