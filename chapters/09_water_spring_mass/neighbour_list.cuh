/// @file
/// Who can touch whom in the next steps: a list made once for many steps (Verlet's list).
#pragma once
#include "05_spatial_grid/counting_sort.cuh"

namespace spring_mass {

//! [NeighbourList]
/// For each marble the others within diameter + skin of it at the time the list was made. As long as none
/// has moved by more than half a skin since, no two marbles touch that are not in each other's lists.
///
/// Each list has 32 words to itself: whole cache lines, on a CPU two of 64 bytes and on a GPU one of 128.
struct NeighbourList {
    static constexpr std::uint32_t kCapacity = 32;  ///< longest list. Marbles in a heap: 13 at a skin of 0.4

    const std::uint32_t* neighbour;
    const std::uint32_t* count;     ///< of each marble; above kCapacity: its list is not complete
    const float4* listed_position;  ///< where marbles were when the list was made, in cell order
    grid::CellRanges ranges;        ///< and their cells at that time
    grid::CellGrid cells;

    static __host__ __device__ std::size_t place(std::uint32_t i) { return std::size_t(i) * kCapacity; }

    /// Calls visit(j) for each marble of which is_near(j) is true.
    ///
    /// First a look at all of the list, which leaves one bit per entry; then only those whose bit is set. A
    /// look is short and the same for all, while one in five entries is near and nobody can guess which: an
    /// `if` around the visit would make a CPU guess wrong, and the threads of a warp wait for each other.
    template <class IsNear, class Visit>
    __device__ void for_each_near(std::uint32_t i, IsNear is_near, Visit visit) const {
        const std::uint32_t length = count[i];
        const std::uint32_t* entry = neighbour + place(i);
        if (length <= kCapacity) {
            std::uint32_t near = 0;
            for (std::uint32_t k = 0; k < length; ++k) near |= std::uint32_t(is_near(entry[k])) << k;
            for (; near != 0; near &= near - 1) visit(entry[__ffs(int(near)) - 1]);
        } else {
            // So many crowd together that the list had no room: ask all marbles of the cells around. More
            // work, the same contacts.
            grid::for_each_row(cells, grid::xyz(listed_position[i]),
                               [&](std::uint32_t first_cell, std::uint32_t last_cell) {
                                   for (std::uint32_t j = ranges.cell_first[first_cell];
                                        j < ranges.cell_last[last_cell]; ++j)
                                       if (j != i && is_near(j)) visit(j);
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
    std::uint32_t* entry = neighbour + NeighbourList::place(i);
    std::uint32_t found = 0;
    if (grid::is_finite(x))
        grid::for_each_row(cells, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::uint32_t last = ranges.cell_last[last_cell];
            for (std::uint32_t j = ranges.cell_first[first_cell]; j < last; ++j) {
                const glm::vec3 apart = x - grid::xyz(position[j]);
                if (found < NeighbourList::kCapacity) entry[found] = j;
                found += j != i && glm::dot(apart, apart) < reach_m * reach_m;
            }
        });
    count[i] = found;
}
//! [list_kernel]

}  // namespace spring_mass
