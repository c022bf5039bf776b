/// @file
/// The grid by a general sort of (cell, particle) pairs: less to write than the counting sort.
#pragma once
#include <cuda_runtime.h>
#include <thrust/execution_policy.h>
#include <thrust/sort.h>

#include "05_spatial_grid/counting_sort.cuh"

namespace grid {

//! [key_kernel]
/// One thread per particle: the pair (cell, particle) to be sorted.
inline __global__ void key_kernel(std::uint32_t* cell, std::uint32_t* order, const float4* position,
                                  CellGrid grid, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    cell[i] = cell_or_limbo(grid, position[i]);
    order[i] = i;
}
//! [key_kernel]

//! [find_ranges_kernel]
/// One thread per place of the sorted order: where the cell changes, one cell ends and another begins. Empty
/// cells are never written: they keep the first = last = 0 they were set to.
inline __global__ void find_ranges_kernel(std::uint32_t* cell_first, std::uint32_t* cell_last,
                                          const std::uint32_t* sorted_cell, std::uint32_t n) {
    const std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x;
    if (k >= n) return;
    const std::uint32_t cell = sorted_cell[k];
    if (k == 0 || sorted_cell[k - 1] != cell) cell_first[cell] = k;
    if (k == n - 1 || sorted_cell[k + 1] != cell) cell_last[cell] = k + 1;
}
//! [find_ranges_kernel]

/// Same results as CountingSort (ranges of empty cells aside), by Thrust's stable sort.
class SortedGrid {
  public:
    SortedGrid(std::uint32_t max_particles, std::uint32_t max_cells)
        : cell_(max_particles),
          order_(max_particles),
          cell_first_(max_cells + 1),
          cell_last_(max_cells + 1) {}

    void build(const float4* position, const CellGrid& grid, std::uint32_t n) {
        const std::size_t bytes = (grid.cell_count() + 1) * sizeof(std::uint32_t);
        CUDA_CHECK(cudaMemset(cell_first_.data(), 0, bytes));
        CUDA_CHECK(cudaMemset(cell_last_.data(), 0, bytes));
        if (n == 0) return;
        const std::uint32_t threads = CountingSort::kThreads, blocks = blocks_for(n, threads);
        key_kernel<<<blocks, threads>>>(cell_.data(), order_.data(), position, grid, n);
        CUDA_CHECK(cudaGetLastError());
        thrust::stable_sort_by_key(thrust::device, cell_.data(), cell_.data() + n, order_.data());
        find_ranges_kernel<<<blocks, threads>>>(cell_first_.data(), cell_last_.data(), cell_.data(), n);
        CUDA_CHECK(cudaGetLastError());
    }
    CellRanges ranges() const { return {cell_first_.data(), cell_last_.data()}; }
    const std::uint32_t* order() const { return order_.data(); }

  private:
    course::DeviceBuffer<std::uint32_t> cell_, order_, cell_first_, cell_last_;
};

}  // namespace grid
