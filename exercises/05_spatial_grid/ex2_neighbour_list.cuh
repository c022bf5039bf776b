// Exercise 05.2: neighbours as a list.
//
// A model that walks over its neighbours twice a step (SPH does) can look for them once and keep them. Lists
// of different lengths go into one array without gaps by what you know from the sort: count, scan, fill.
#pragma once
#include "05_spatial_grid/neighbours.cuh"
#include "common/todo.h"

namespace grid {

// The neighbours of the particle at place p of the sorted order stand in `neighbour` from number first[p] to
// first[p + 1] - 1: as places, ascending, without p itself.
struct NeighbourList {
    course::DeviceBuffer<std::uint32_t> first;  // n + 1 numbers; the last is the number of all entries
    course::DeviceBuffer<std::uint32_t> neighbour;
};

// One thread per place: writes one particle's list.
inline __global__ void fill_list_kernel(std::uint32_t* neighbour, const std::uint32_t* first,
                                        const float4* sorted_position, CellRanges ranges, CellGrid grid,
                                        float radius_m, std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place >= n) return;
    // TODO(5.2): walk over the rows as neighbours_coherent_kernel does, and write instead of counting. A
    // particle at NaN has no neighbours and stays out of the cells. About 8 lines.
    const auto todo = std::uint32_t(course::kTodo);
    for (std::uint32_t k = first[place]; k < first[place + 1]; ++k) neighbour[k] = todo;
}

// Lists of all n particles, n > 0, for positions sorted by CountingSort.
inline NeighbourList list_neighbours(const float4* sorted_position, CellRanges ranges, const CellGrid& grid,
                                     float radius_m, std::uint32_t n) {
    const std::uint32_t threads = 128, blocks = blocks_for(n, threads);
    NeighbourList list;
    // TODO(5.2): make list.first from the counts, then list.neighbour as long as it has to be, then fill it.
    // neighbours_coherent_kernel counts, an ExclusiveScan sums up. One number comes to the host: how many
    // entries there are. About 12 lines.
    (void)blocks, (void)sorted_position, (void)ranges, (void)grid, (void)radius_m;
    const std::vector<std::uint32_t> todo(n + 1, std::uint32_t(course::kTodo));
    list.first = course::DeviceBuffer<std::uint32_t>(todo);
    return list;
}

}  // namespace grid
