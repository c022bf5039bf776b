/// @file
/// The sparse grid: bricks of 8^3 nodes, made only where particles are. Found by marking, scan and
/// compaction, twice: first the regions, then the bricks in those regions.
#pragma once
#include <cuda_runtime.h>

#include <cstdio>
#include <optional>
#include <string>

#include "04_parallel_patterns/bounds.cuh"
#include "04_parallel_patterns/scan.cuh"
#include "14_surface_generation/lattice.cuh"
#include "common/errors.h"

namespace surface {

using patterns::blocks_for;
using patterns::is_finite;
using patterns::xyz;

constexpr std::uint32_t kThreads = 128;

/// Makes room for at least n elements; what the buffer held is lost if it had to grow.
template <class T>
void make_room(course::DeviceBuffer<T>& buffer, std::size_t n) {
    if (buffer.size() >= n) return;
    buffer = course::DeviceBuffer<T>();  // free before asking for more
    buffer = course::DeviceBuffer<T>(n + n / 4);
}

//! [mark]
/// One thread per particle: marks the regions it needs. Many threads write the same 1, hence the atomic.
inline __global__ void mark_regions_kernel(std::uint32_t* mark, const float4* blob, Lattice lattice,
                                           std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n || !is_finite(xyz(blob[i]))) return;
    const BrickBox bricks = bricks_around(lattice, xyz(blob[i]), blob[i].w);
    for_each({bricks.low / kRegion, bricks.high / kRegion},
             [&](glm::ivec3 region) { atomicExch(&mark[number_of(region, lattice.regions())], 1u); });
}

/// Only the difference: bricks, in regions that have a place by now.
inline __global__ void mark_bricks_kernel(std::uint32_t* mark, const std::uint32_t* region_place,
                                          const float4* blob, Lattice lattice, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n || !is_finite(xyz(blob[i]))) return;
    for_each(bricks_around(lattice, xyz(blob[i]), blob[i].w), [&](glm::ivec3 brick) {
        const std::uint32_t region = region_place[number_of(brick / kRegion, lattice.regions())];
        atomicExch(&mark[region * kRegionBricks + number_of(brick % kRegion, glm::ivec3(kRegion))], 1u);
    });
}

/// One thread per brick of a region: for the dense grid, all that the lattice has.
inline __global__ void mark_all_bricks_kernel(std::uint32_t* mark, Lattice lattice, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::ivec3 brick = kRegion * item_of(i / kRegionBricks, lattice.regions()) +
                             item_of(i % kRegionBricks, glm::ivec3(kRegion));
    mark[i] = brick.x < lattice.bricks.x && brick.y < lattice.bricks.y && brick.z < lattice.bricks.z;
}
inline __global__ void mark_all_regions_kernel(std::uint32_t* mark, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) mark[i] = 1;
}
//! [mark]

//! [keep_marked]
/// One thread per mark: puts the marked ones into a list without gaps, and turns each mark into the place
/// there.
inline __global__ void keep_marked_kernel(std::uint32_t* list, std::uint32_t* mark_to_place,
                                          const std::uint32_t* marks_before, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const std::uint32_t place = marks_before[i];
    const bool marked = mark_to_place[i] != 0;
    if (marked) list[place] = i;
    mark_to_place[i] = marked ? place : kNone;
}
//! [keep_marked]

/// Counts that a scan turns into offsets. The memory grows as needed and is kept.
class Offsets {
  public:
    /// Room for n counts, and a zero behind them: after the scan it holds their sum.
    std::uint32_t* resize(std::uint32_t n) {
        n_ = n;
        make_room(values_, std::size_t(n) + 1);
        if (!scan_ || scan_length_ < n + 1) {
            scan_length_ = std::uint32_t(values_.size());
            scan_.emplace(scan_length_);
        }
        CUDA_CHECK(cudaMemset(values_.data() + n, 0, sizeof(std::uint32_t)));
        return values_.data();
    }
    /// Waits for the device. @returns the sum of all counts
    std::uint32_t scan() {
        (*scan_)(values_.data(), n_ + 1);
        std::uint32_t sum = 0;
        CUDA_CHECK(cudaMemcpy(&sum, values_.data() + n_, sizeof sum, cudaMemcpyDeviceToHost));
        return sum;
    }
    std::uint32_t* data() { return values_.data(); }
    const std::uint32_t* data() const { return values_.data(); }
    std::uint32_t size() const { return n_; }
    std::size_t bytes() const { return values_.bytes() + (scan_ ? scan_->bytes() : 0); }

  private:
    std::uint32_t n_ = 0, scan_length_ = 0;
    course::DeviceBuffer<std::uint32_t> values_;
    std::optional<patterns::ExclusiveScan> scan_;
};

//! [MarkedList]
/// Marks, a scan over them, and the list of what was marked.
class MarkedList {
  public:
    /// n marks, to be written by a kernel: all of them...
    std::uint32_t* resize(std::uint32_t n) {
        make_room(mark_, n);
        before_.resize(n);
        return mark_.data();
    }
    /// ...or only those that are not 0.
    std::uint32_t* clear(std::uint32_t n) {
        resize(n);
        CUDA_CHECK(cudaMemset(mark_.data(), 0, n * sizeof(std::uint32_t)));
        return mark_.data();
    }
    /// Waits for the device. @returns how many were marked
    std::uint32_t finish() {
        const std::uint32_t n = before_.size();
        CUDA_CHECK(
            cudaMemcpy(before_.data(), mark_.data(), n * sizeof(std::uint32_t), cudaMemcpyDeviceToDevice));
        count_ = before_.scan();
        make_room(list_, count_);
        if (n == 0) return 0;
        keep_marked_kernel<<<blocks_for(n, kThreads), kThreads>>>(list_.data(), mark_.data(), before_.data(),
                                                                  n);
        CUDA_CHECK(cudaGetLastError());
        return count_;
    }
    std::uint32_t count() const { return count_; }
    const std::uint32_t* list() const { return list_.data(); }
    const std::uint32_t* place() const { return mark_.data(); }  ///< of each item in the list, or kNone
    std::size_t bytes() const { return mark_.bytes() + before_.bytes() + list_.bytes(); }

  private:
    std::uint32_t count_ = 0;
    course::DeviceBuffer<std::uint32_t> mark_, list_;
    Offsets before_;
};
//! [MarkedList]

//! [locate]
/// One thread per brick: its first node.
inline __global__ void locate_kernel(int4* corner, const std::uint32_t* brick_list,
                                     const std::uint32_t* region_list, Lattice lattice, std::uint32_t n) {
    const std::uint32_t b = blockIdx.x * blockDim.x + threadIdx.x;
    if (b >= n) return;
    const std::uint32_t in_regions = brick_list[b];
    const glm::ivec3 region = item_of(region_list[in_regions / kRegionBricks], lattice.regions());
    const glm::ivec3 node =
        kBrick * (kRegion * region + item_of(in_regions % kRegionBricks, glm::ivec3(kRegion)));
    corner[b] = make_int4(node.x, node.y, node.z, 0);
}

constexpr int kAround = 27;  ///< a brick and its neighbours: (x + 1) + 3 (y + 1) + 9 (z + 1), each -1 to 1

/// One thread per brick: the numbers of the bricks around it, kNone where there is none.
inline __global__ void neighbours_kernel(std::uint32_t* around, const int4* corner,
                                         const std::uint32_t* region_place, const std::uint32_t* brick_place,
                                         Lattice lattice, std::uint32_t n) {
    const std::uint32_t b = blockIdx.x * blockDim.x + threadIdx.x;
    if (b >= n) return;
    const glm::ivec3 centre = glm::ivec3(corner[b].x, corner[b].y, corner[b].z) / kBrick;
    for (int k = 0; k < kAround; ++k) {
        const glm::ivec3 brick = centre + item_of(k, glm::ivec3(3)) - 1;
        std::uint32_t number = kNone;
        if (brick.x >= 0 && brick.y >= 0 && brick.z >= 0 && brick.x < lattice.bricks.x &&
            brick.y < lattice.bricks.y && brick.z < lattice.bricks.z) {
            const std::uint32_t region = region_place[number_of(brick / kRegion, lattice.regions())];
            if (region != kNone)
                number =
                    brick_place[region * kRegionBricks + number_of(brick % kRegion, glm::ivec3(kRegion))];
        }
        around[kAround * b + k] = number;
    }
}
//! [locate]

/// The bricks as kernels see them. Node (x, y, z) of brick b is element 512 b + 64 z + 8 y + x of a field.
struct BrickView {
    const int4* corner;           ///< first node of each brick
    const std::uint32_t* around;  ///< kAround for each brick
    std::uint32_t count;
};

//! [node_value]
/// The field at node (x, y, z) of brick b, each from -8 to 15: beyond the brick its neighbours are asked, and
/// where there is none the field is 0.
inline __device__ float node_value(const float* field, const std::uint32_t* around, std::uint32_t b,
                                   glm::ivec3 node) {
    const glm::ivec3 side = (node + kBrick) / kBrick;  // 0, 1 or 2; 1 is the brick itself
    const std::uint32_t brick = around[kAround * b + side.x + 3 * side.y + 9 * side.z];
    if (brick == kNone) return 0;
    const glm::ivec3 at = node + kBrick * (1 - side);
    return field[brick * std::size_t(kBrickNodes) + kBrickRows * at.z + kBrick * at.y + at.x];
}
//! [node_value]

/// What a brick costs: its values, the bits and marks of its rows (twice, and the list of them), who is
/// around it, where it is, its own mark.
constexpr std::size_t kBytesPerBrick =
    kBrickNodes * sizeof(float) + kBrickRows * (1 + 3 * sizeof(std::uint32_t)) +
    kAround * sizeof(std::uint32_t) + sizeof(int4) + 3 * sizeof(std::uint32_t);

/// @throws course::BadInput if the device has less than that altogether, or rows of bricks could no longer be
/// counted in 32 bits
inline void require_device_memory(double bytes, const std::string& what) {
    std::size_t free_bytes = 0, total_bytes = 0;
    CUDA_CHECK(cudaMemGetInfo(&free_bytes, &total_bytes));
    if (bytes < double(total_bytes) && bytes / kBytesPerBrick < 0xffffffffu / kBrickRows) return;
    char text[64];
    std::snprintf(text, sizeof text, "%.0f", bytes);
    throw course::BadInput(what + " would take " + text + " bytes, and the device has " +
                           std::to_string(total_bytes) +
                           ": take fewer nodes for each spacing, or a smaller box");
}

//! [Bricks]
/// The bricks of a lattice that exist.
class Bricks {
  public:
    /// Those that any particle needs. @param blob  x, y, z and in w the reach, in m
    void build(const Lattice& lattice, const float4* blob, std::uint32_t n) {
        set_lattice(lattice);
        std::uint32_t* region = regions_.clear(region_count());
        mark_regions_kernel<<<blocks_for(n, kThreads), kThreads>>>(region, blob, lattice, n);
        CUDA_CHECK(cudaGetLastError());
        std::uint32_t* brick = bricks_.clear(kRegionBricks * regions_.finish());
        mark_bricks_kernel<<<blocks_for(n, kThreads), kThreads>>>(brick, regions_.place(), blob, lattice, n);
        CUDA_CHECK(cudaGetLastError());
        finish();
    }
    /// All of them: the dense grid.
    void build_all(const Lattice& lattice) {
        const glm::dvec3 all(lattice.bricks);
        check_bricks(all.x * all.y * all.z);
        set_lattice(lattice);
        const std::uint32_t regions = region_count(), bricks = kRegionBricks * regions;
        mark_all_regions_kernel<<<blocks_for(regions, kThreads), kThreads>>>(regions_.resize(regions),
                                                                             regions);
        CUDA_CHECK(cudaGetLastError());
        regions_.finish();
        mark_all_bricks_kernel<<<blocks_for(bricks, kThreads), kThreads>>>(bricks_.resize(bricks), lattice,
                                                                           bricks);
        CUDA_CHECK(cudaGetLastError());
        finish();
    }

    BrickView view() const { return {corner_.data(), around_.data(), count()}; }
    const course::DeviceBuffer<int4>& corners() const { return corner_; }
    const Lattice& lattice() const { return lattice_; }
    std::uint32_t count() const { return bricks_.count(); }
    std::uint32_t region_count() const {  ///< that the lattice could have
        const glm::ivec3 r = lattice_.regions();
        return std::uint32_t(r.x) * r.y * r.z;
    }
    std::uint32_t regions() const { return regions_.count(); }  ///< that exist
    std::size_t bytes() const {
        return regions_.bytes() + bricks_.bytes() + corner_.bytes() + around_.bytes();
    }

  private:
    /// @throws course::BadInput if the table of regions, which covers the whole box, particles or not, is too
    /// large
    void set_lattice(const Lattice& lattice) {
        const glm::dvec3 regions(lattice.regions());
        require_device_memory(3.0 * sizeof(std::uint32_t) * regions.x * regions.y * regions.z,
                              "a table of the regions of this box");
        lattice_ = lattice;
    }
    static void check_bricks(double count) {
        require_device_memory(double(kBytesPerBrick) * count, "a field on bricks");
    }
    void finish() {
        check_bricks(bricks_.finish());
        make_room(corner_, count());
        make_room(around_, std::size_t(kAround) * count());
        if (count() == 0) return;
        const std::uint32_t blocks = blocks_for(count(), kThreads);
        locate_kernel<<<blocks, kThreads>>>(corner_.data(), bricks_.list(), regions_.list(), lattice_,
                                            count());
        CUDA_CHECK(cudaGetLastError());
        neighbours_kernel<<<blocks, kThreads>>>(around_.data(), corner_.data(), regions_.place(),
                                                bricks_.place(), lattice_, count());
        CUDA_CHECK(cudaGetLastError());
    }
    Lattice lattice_;
    MarkedList regions_, bricks_;
    course::DeviceBuffer<int4> corner_;
    course::DeviceBuffer<std::uint32_t> around_;
};
//! [Bricks]

}  // namespace surface
