/// @file
/// Particles sorted by cell in linear time: count, scan, scatter. The order repeats exactly from run to run.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "04_parallel_patterns/scan.cuh"
#include "05_spatial_grid/cell_grid.cuh"
#include "common/device_buffer.h"

namespace grid {

using patterns::blocks_for;
using patterns::ExclusiveScan;

/// Particles of cell c: places cell_first[c] to cell_last[c] - 1 of the order sorted by cell.
struct CellRanges {
    const std::uint32_t* cell_first;
    const std::uint32_t* cell_last;
};

/// Cell number of particle i, or the limbo if its position is not finite.
inline __host__ __device__ std::uint32_t cell_or_limbo(const CellGrid& grid, float4 position) {
    return is_finite(xyz(position)) ? cell_number(grid, cell_of(grid, xyz(position))) : grid.cell_count();
}

//! [count_kernel]
/// One thread per particle: how many particles has each cell?
inline __global__ void count_kernel(std::uint32_t* cell_count, std::uint32_t* cell, const float4* position,
                                    CellGrid grid, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    cell[i] = cell_or_limbo(grid, position[i]);
    atomicAdd(&cell_count[cell[i]], 1u);
}
//! [count_kernel]

//! [scatter_kernel]
/// One thread per particle: takes the next free place of its cell. `next_place` starts as the first place of
/// each cell and ends as the last. Which thread comes first is a matter of luck, so the order inside a cell
/// is not fixed.
inline __global__ void scatter_kernel(std::uint32_t* order, std::uint32_t* next_place,
                                      const std::uint32_t* cell, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    order[atomicAdd(&next_place[cell[i]], 1u)] = i;
}
//! [scatter_kernel]

//! [sort_cells_kernel]
/// One thread per cell: puts its particles in ascending order, so that luck plays no part: sums over
/// neighbours then add in the same order in every run. Shell's sort: plain insertion for the few particles of
/// a normal cell, and no quadratic surprise when all particles sit in one (gaps of Ciura, 2001, continued by
/// the factor 2.25).
inline __global__ void sort_cells_kernel(std::uint32_t* order, CellRanges ranges, std::uint32_t cell_count) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= cell_count) return;
    std::uint32_t* item = order + ranges.cell_first[c];
    const std::uint32_t count = ranges.cell_last[c] - ranges.cell_first[c];
    std::uint32_t gap = 1;
    while (gap < count / 2) gap = gap * 9 / 4 + 1;
    for (;; gap = gap * 4 / 9) {
        for (std::uint32_t k = gap; k < count; ++k) {
            const std::uint32_t value = item[k];
            std::uint32_t hole = k;
            for (; hole >= gap && item[hole - gap] > value; hole -= gap) item[hole] = item[hole - gap];
            item[hole] = value;
        }
        if (gap <= 1) return;
    }
}
//! [sort_cells_kernel]

//! [gather_kernel]
/// One thread per place: brings the data of the particle that belongs there. Neighbours in space become
/// neighbours in memory.
template <class T>
__global__ void gather_kernel(T* sorted, const T* data, const std::uint32_t* order, std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place < n) sorted[place] = data[order[place]];
}
//! [gather_kernel]

//! [CountingSort]
/// Sorts up to `max_particles` particles into up to `max_cells` cells, again and again, in memory made once.
class CountingSort {
  public:
    CountingSort(std::uint32_t max_particles, std::uint32_t max_cells)
        : cell_(max_particles),
          order_(max_particles),
          cell_first_(max_cells + 2),
          next_place_(max_cells + 2),
          scan_(max_cells + 2) {}

    void build(const float4* position, const CellGrid& grid, std::uint32_t n) {
        const std::uint32_t cells = grid.cell_count() + 1;  // with the limbo
        // One entry more than cells: after the scan it holds n, the end of the last cell.
        CUDA_CHECK(cudaMemset(cell_first_.data(), 0, (cells + 1) * sizeof(std::uint32_t)));
        if (n == 0) return;  // a launch of zero blocks is an error
        count_kernel<<<blocks_for(n, kThreads), kThreads>>>(cell_first_.data(), cell_.data(), position, grid,
                                                            n);
        CUDA_CHECK(cudaGetLastError());
        scan_(cell_first_.data(), cells + 1);
        CUDA_CHECK(cudaMemcpy(next_place_.data(), cell_first_.data(), cells * sizeof(std::uint32_t),
                              cudaMemcpyDeviceToDevice));
        scatter_kernel<<<blocks_for(n, kThreads), kThreads>>>(order_.data(), next_place_.data(), cell_.data(),
                                                              n);
        CUDA_CHECK(cudaGetLastError());
        sort_cells_kernel<<<blocks_for(cells, kThreads), kThreads>>>(order_.data(), ranges(), cells);
        CUDA_CHECK(cudaGetLastError());
    }

    /// Cells are stored without gaps, so each one ends where the next begins.
    CellRanges ranges() const { return {cell_first_.data(), cell_first_.data() + 1}; }
    /// order()[place] is the particle at that place of the sorted order.
    const std::uint32_t* order() const { return order_.data(); }

    /// Device memory for the cells, whatever the number of particles.
    std::size_t cell_bytes() const { return cell_first_.bytes() + next_place_.bytes() + scan_.bytes(); }

    static constexpr std::uint32_t kThreads = 128;

  private:
    course::DeviceBuffer<std::uint32_t> cell_, order_, cell_first_, next_place_;
    ExclusiveScan scan_;
};
//! [CountingSort]

}  // namespace grid
