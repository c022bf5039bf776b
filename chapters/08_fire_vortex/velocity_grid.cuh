/// @file
/// The velocity grid: from the positions and strengths of n vortons to the field at all cell centres.
#pragma once
#include <cuda_runtime.h>

#include <glm/vector_relational.hpp>
#include <optional>
#include <vector>

#include "04_parallel_patterns/bounds.cuh"
#include "08_fire_vortex/field_sums.cuh"

namespace vortex {

//! [FarField]
/// What becomes of vortons that are more than `reach` cells away.
enum class Far {
    dropped,  ///< they do nothing: the thesis's sum
    cells,    ///< each far cell acts as one vorton
    pyramid,  ///< the same, with cells that grow with the distance
    direct    ///< nobody is far: every vorton is summed one by one, and `reach` means nothing
};
struct FarField {
    Far far = Far::pyramid;
    int reach = 1;  ///< cells whose vortons are summed one by one: 1 is 27 cells, 2 is 125
};
//! [FarField]

//! [fire_grid]
/// A grid over all that has to be sampled, two cells wider on each side, so that slopes at the rim are true
/// ones. The edge is `cell_m`, or as much more as `max_cells` asks for: the grid follows the fire wherever
/// wind takes it, its memory stays what it was.
inline CellGrid fire_grid(const grid::Bounds& box, float cell_m, std::uint32_t max_cells) {
    if (!glm::all(glm::lessThanEqual(box.low_m, box.high_m)))  // nobody there
        return {glm::vec3(0), 1 / cell_m, glm::ivec3(1)};
    const glm::dvec3 extent_m = glm::dvec3(box.high_m) - glm::dvec3(box.low_m);
    double edge_m = cell_m;
    for (;; edge_m *= 1.05) {
        const glm::dvec3 cells = glm::floor(extent_m / edge_m) + 5.0;
        if (cells.x * cells.y * cells.z <= max_cells)
            return {box.low_m - float(2 * edge_m), float(1 / edge_m), glm::ivec3(cells)};
    }
}
constexpr std::uint32_t kSmallestMaxCells = 125;  // five a side: what a grid round one point takes
//! [fire_grid]

/// Both boxes in one.
inline grid::Bounds around(const grid::Bounds& a, const grid::Bounds& b) {
    return {glm::min(a.low_m, b.low_m), glm::max(a.high_m, b.high_m)};
}

//! [VelocityGrid]
/// Memory for up to `max_vortons` and `max_cells`, made once; build() fills it, as often as you like.
class VelocityGrid {
  public:
    VelocityGrid(std::uint32_t max_vortons, std::uint32_t max_cells, const FarField& far_field)
        : far_field_(far_field), field_(max_cells) {
        if (far_field.far == Far::direct) return;  // no sorting where nobody asks who is near
        sort_.emplace(max_vortons, max_cells);
        sorted_position_ = course::DeviceBuffer<float4>(max_vortons);
        sorted_strength_ = course::DeviceBuffer<float4>(max_vortons);
        if (far_field.far == Far::dropped) return;
        centroid_ = course::DeviceBuffer<float4>(Pyramid::max_entries(max_cells));
        sums_ = course::DeviceBuffer<float4>(Pyramid::max_entries(max_cells));
    }

    /// The field of n vortons. Waits for nothing.
    void build(const float4* position, const float4* strength, std::uint32_t n, const CellGrid& cells,
               float core_m) {
        grid_ = cells;
        const float core2 = core_m * core_m;
        if (far_field_.far == Far::direct) {
            field_direct_kernel<<<cell_blocks(), kThreads>>>(field_.data(), position, strength, n, grid_,
                                                             core2);
            CUDA_CHECK(cudaGetLastError());
            return;
        }
        const SortedVortons vortons = sort(position, strength, n);
        if (far_field_.far == Far::dropped) {
            field_neighbours_kernel<<<cell_blocks(), kThreads>>>(field_.data(), vortons, grid_,
                                                                 far_field_.reach, core2);
        } else {
            const Pyramid pyramid = build_pyramid(vortons);
            const glm::ivec3 eights = (grid_.size + 1) / 2;
            const std::uint32_t threads = std::uint32_t(eights.x) * eights.y * eights.z;
            field_pyramid_kernel<<<grid::blocks_for(threads, kThreads), kThreads>>>(
                field_.data(), vortons, pyramid, grid_, far_field_.reach, core2);
        }
        CUDA_CHECK(cudaGetLastError());
    }

    /// One value a cell, at its centre. xyz: velocity in m/s; w: buoyancy in m/s^2
    const float4* field() const { return field_.data(); }
    std::vector<float4> download() const {
        std::vector<float4> all = field_.download();
        all.resize(grid_.cell_count());
        return all;
    }
    const CellGrid& grid() const { return grid_; }
    std::size_t bytes() const {
        return field_.bytes() + sorted_position_.bytes() + sorted_strength_.bytes() + centroid_.bytes() +
               sums_.bytes() + (sort_ ? sort_->cell_bytes() : 0);
    }

    static constexpr std::uint32_t kThreads = 64;

  private:
    std::uint32_t cell_blocks() const { return grid::blocks_for(grid_.cell_count(), kThreads); }

    SortedVortons sort(const float4* position, const float4* strength, std::uint32_t n) {
        sort_->build(position, grid_, n);
        if (n > 0) {
            const std::uint32_t blocks = grid::blocks_for(n, kThreads);
            grid::gather_kernel<<<blocks, kThreads>>>(sorted_position_.data(), position, sort_->order(), n);
            CUDA_CHECK(cudaGetLastError());
            grid::gather_kernel<<<blocks, kThreads>>>(sorted_strength_.data(), strength, sort_->order(), n);
            CUDA_CHECK(cudaGetLastError());
        }
        return {sorted_position_.data(), sorted_strength_.data(), sort_->ranges()};
    }

    Pyramid build_pyramid(const SortedVortons& vortons) {
        Pyramid pyramid{centroid_.data(), sums_.data()};
        pyramid.shape(grid_.size, far_field_.far == Far::cells ? 1 : kMaxLevels);
        monopoles_kernel<<<cell_blocks(), kThreads>>>(pyramid, vortons, grid_);
        CUDA_CHECK(cudaGetLastError());
        for (int level = 1; level < pyramid.levels; ++level) {
            const glm::ivec3 size = pyramid.size[level];
            coarsen_kernel<<<grid::blocks_for(std::uint32_t(size.x) * size.y * size.z, kThreads), kThreads>>>(
                pyramid, level);
            CUDA_CHECK(cudaGetLastError());
        }
        return pyramid;
    }

    FarField far_field_;
    CellGrid grid_;
    course::DeviceBuffer<float4> field_, sorted_position_, sorted_strength_, centroid_, sums_;
    std::optional<grid::CountingSort> sort_;
};
//! [VelocityGrid]

}  // namespace vortex
