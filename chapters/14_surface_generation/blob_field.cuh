/// @file
/// The passes from particles to the field's values, and their memory.
#pragma once
#include <optional>

#include "14_surface_generation/field.cuh"

namespace surface {

/// Chapter 05's counting sort, for any number of particles: its memory grows as needed.
class CellSort {
  public:
    /// Sorts by cells that are at least `reach_m` wide.
    void build(const float4* position, std::uint32_t n, const patterns::Bounds& box, float reach_m) {
        if (!sort_ || n > room_) {
            room_ = n + n / 4;
            sort_.reset();  // free before asking for more
            sort_.emplace(room_, grid::max_cells_for(room_));
        }
        cells_ = grid::make_grid(box.low_m, box.high_m, reach_m, grid::max_cells_for(n));
        sort_->build(position, cells_, n);
    }
    template <class T>
    void gather(T* sorted, const T* data, std::uint32_t n) const {
        grid::gather_kernel<<<blocks_for(n, kThreads), kThreads>>>(sorted, data, sort_->order(), n);
        CUDA_CHECK(cudaGetLastError());
    }
    const CellGrid& cells() const { return cells_; }
    CellRanges ranges() const { return sort_->ranges(); }
    std::size_t bytes() const {
        return sort_ ? sort_->cell_bytes() + 2 * sizeof(std::uint32_t) * room_ : 0;  // cell and order
    }

  private:
    std::uint32_t room_ = 0;
    CellGrid cells_;
    std::optional<grid::CountingSort> sort_;
};

//! [Blobs]
/// Blobs of all particles, sorted by cell, and the field they make. A round blob has no Stretch: the kinds of
/// field that don't need it have neither the arrays nor the pass that fills them.
class Blobs {
  public:
    /// @param settings  complete()
    explicit Blobs(const SurfaceSettings& settings) : kind_(settings.kind) {
        const float spacing_m = settings.particle_spacing_m;
        shape_.radius_m = settings.radius * spacing_m;
        shape_.neighbour_reach_m = settings.neighbour_reach * spacing_m;
        shape_.pull = settings.pull;
        shape_.full_ball = 4.18879f * std::pow(settings.neighbour_reach, 3.0f);
        field_.radius_m = shape_.radius_m;
        field_.volume_m3 = spacing_m * spacing_m * spacing_m;
        field_.reach_m = shape_.radius_m * (kind_ == FieldKind::anisotropic ? shape_.longest : 1);
    }

    /// @param box  around the particles
    void build(const float4* position, std::uint32_t n, const patterns::Bounds& box) {
        make_room(unsorted_, n);
        make_room(blob_, n);
        const std::uint32_t blocks = blocks_for(n, kThreads);
        if (kind_ == FieldKind::anisotropic) {
            make_room(unsorted_stretch_, n);
            make_room(stretch_, n);
            sort_.build(position, n, box, shape_.neighbour_reach_m);
            neighbour_cells_ = sort_.cells();
            sort_.gather(blob_.data(), position, n);  // only until the blobs are made
            blob_kernel<<<blocks, kThreads>>>(unsorted_.data(), unsorted_stretch_.data(), blob_.data(),
                                              sort_.ranges(), sort_.cells(), shape_, n);
        } else {
            round_blob_kernel<<<blocks, kThreads>>>(unsorted_.data(), position, shape_.radius_m, n);
        }
        CUDA_CHECK(cudaGetLastError());
        // Blobs have moved towards their neighbours, so never out of the box; but into other cells. Half the
        // reach wide, five cells across hold what is in reach more tightly than three cells of all of it.
        sort_.build(unsorted_.data(), n, box, 0.5f * field_.reach_m);
        sort_.gather(blob_.data(), unsorted_.data(), n);
        if (kind_ == FieldKind::anisotropic) sort_.gather(stretch_.data(), unsorted_stretch_.data(), n);
    }

    /// The field at all nodes of the bricks.
    void fill(float* field, const Bricks& bricks) const {
        switch (kind_) {
            case FieldKind::colour:
                field_kernel<FieldKind::colour>
                    <<<bricks.count(), kBrickRows>>>(field, bricks.view().corner, blob_.data(), nullptr,
                                                     sort_.ranges(), sort_.cells(), bricks.lattice(), field_);
                break;
            case FieldKind::zhu_bridson:
                field_kernel<FieldKind::zhu_bridson>
                    <<<bricks.count(), kBrickRows>>>(field, bricks.view().corner, blob_.data(), nullptr,
                                                     sort_.ranges(), sort_.cells(), bricks.lattice(), field_);
                break;
            case FieldKind::anisotropic:
                field_kernel<FieldKind::anisotropic><<<bricks.count(), kBrickRows>>>(
                    field, bricks.view().corner, blob_.data(), stretch_.data(), sort_.ranges(), sort_.cells(),
                    bricks.lattice(), field_);
                break;
        }
        CUDA_CHECK(cudaGetLastError());
    }

    const CellGrid& cells() const { return sort_.cells(); }  ///< of the blobs
    const CellGrid& neighbour_cells() const {
        return neighbour_cells_;
    }  ///< of the particles, anisotropic only
    const BlobShape& shape() const { return shape_; }
    const FieldShape& field_shape() const { return field_; }
    const float4* blob() const { return blob_.data(); }
    float reach_m() const { return field_.reach_m; }
    std::size_t bytes() const {
        return sort_.bytes() + unsorted_.bytes() + blob_.bytes() + unsorted_stretch_.bytes() +
               stretch_.bytes();
    }

  private:
    FieldKind kind_;
    BlobShape shape_;
    FieldShape field_;
    CellSort sort_;
    CellGrid neighbour_cells_;
    course::DeviceBuffer<float4> unsorted_, blob_;
    course::DeviceBuffer<Stretch> unsorted_stretch_, stretch_;
};
//! [Blobs]

}  // namespace surface
