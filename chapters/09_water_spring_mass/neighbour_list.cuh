/// @file
/// Who can touch whom in the next steps: a list made once for many steps (Verlet's list).
#pragma once
#include "05_spatial_grid/counting_sort.cuh"

namespace spring_mass {

//! [NeighbourList]
/// For each marble the others within diameter + skin of it at the time the list was made. As long as none
/// has moved by more than half a skin since, no two marbles touch that are not in each other's lists.
///
/// Lists lie in groups of 32 marbles: the first entries of all 32, then the second ones, and so on. The 32
/// threads of a warp read 32 successive words; on a CPU the whole group fits into the first-level cache.
struct NeighbourList {
    static constexpr std::uint32_t kWarp = 32;
    static constexpr std::uint32_t kCapacity = 32;  ///< longest list; hard spheres of 1.3 diameters: 21

    const std::uint32_t* neighbour;
    const std::uint32_t* count;     ///< of each marble; above kCapacity: its list is not complete
    const float4* listed_position;  ///< where marbles were when the list was made, in cell order
    grid::CellRanges ranges;        ///< and their cells at that time
    grid::CellGrid cells;

    static __host__ __device__ std::size_t place(std::uint32_t i, std::uint32_t k) {
        return (std::size_t(i / kWarp) * kCapacity + k) * kWarp + i % kWarp;
    }
    static std::size_t words_for(std::size_t n) { return (n + kWarp - 1) / kWarp * kWarp * kCapacity; }

    /// Calls visit(j) for each candidate of marble i. Where so many crowd together that the list had no room,
    /// for all marbles of the cells around: more work, the same contacts.
    template <class Visit>
    __host__ __device__ void for_each(std::uint32_t i, Visit visit) const {
        if (count[i] <= kCapacity) {
            const std::uint32_t* entry = neighbour + place(i, 0);
            for (std::uint32_t k = 0; k < count[i]; ++k) visit(entry[k * kWarp]);
        } else {
            grid::for_each_row(cells, grid::xyz(listed_position[i]),
                               [&](std::uint32_t first_cell, std::uint32_t last_cell) {
                                   for (std::uint32_t j = ranges.cell_first[first_cell];
                                        j < ranges.cell_last[last_cell]; ++j)
                                       if (j != i) visit(j);
                               });
        }
    }
};
//! [NeighbourList]

//! [list_kernel]
/// One thread per marble, marbles sorted by cell: writes down who is within `reach_m`. Every candidate is
/// written, and the place is kept only if it is near: no branch that a processor would have to guess.
inline __global__ void list_kernel(std::uint32_t* neighbour, std::uint32_t* count, const float4* position,
                                   grid::CellRanges ranges, grid::CellGrid cells, float reach_m,
                                   std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = grid::xyz(position[i]);
    std::uint32_t* entry = neighbour + NeighbourList::place(i, 0);
    std::uint32_t found = 0;
    if (grid::is_finite(x))
        grid::for_each_row(cells, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::uint32_t last = ranges.cell_last[last_cell];
            for (std::uint32_t j = ranges.cell_first[first_cell]; j < last; ++j) {
                const glm::vec3 apart = x - grid::xyz(position[j]);
                if (found < NeighbourList::kCapacity) entry[found * NeighbourList::kWarp] = j;
                found += j != i && glm::dot(apart, apart) < reach_m * reach_m;
            }
        });
    count[i] = found;
}
//! [list_kernel]

}  // namespace spring_mass
