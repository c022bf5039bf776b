/// @file
/// What each way of finding neighbours launches and stores, said before it runs (--explain). The chapter's
/// test holds it against the simulator's launch log.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "04_parallel_patterns/scan.cuh"
#include "05_spatial_grid/lanes.cuh"

namespace grid {

using patterns::ExclusiveScan;

/// Price of one method.
struct Cost {
    std::string method;
    std::vector<std::string> build;  ///< kernels, in the order of their launches
    std::vector<std::string> query;
    std::size_t bytes;  ///< device memory: particles, counts and everything the method adds
};

constexpr const char* kThrustSort = "thrust::stable_sort_by_key";  // as many kernels as Thrust thinks fit

/// The five methods on n particles in a grid of `cells` cells.
inline std::vector<Cost> costs(std::size_t n, std::uint32_t cells) {
    const std::uint32_t offsets = cells + 2;  // with the limbo, and the end of the last cell
    const int levels = ExclusiveScan::levels(offsets);
    std::vector<std::string> by_counting{"count_kernel"};
    by_counting.insert(by_counting.end(), levels, "chunk_sums_kernel");
    by_counting.insert(by_counting.end(), levels, "scan_chunks_kernel");
    by_counting.insert(by_counting.end(), {"scatter_kernel", "sort_cells_kernel"});
    std::vector<std::string> and_gather = by_counting, and_gather_columns = by_counting;
    and_gather.push_back("gather_kernel");
    and_gather_columns.push_back("gather_columns_kernel");

    const std::size_t particles = n * (16 + 4);  // float4 position, count
    const std::size_t sorted = n * (4 + 4);      // cell, order
    const std::size_t counting = particles + sorted + 2 * 4 * offsets + ExclusiveScan(offsets).bytes();
    return {
        {"brute force", {}, {"neighbours_brute_force_kernel"}, particles},
        {"sorted grid",
         {"key_kernel", kThrustSort, "find_ranges_kernel"},
         {"neighbours_scattered_kernel"},
         particles + sorted + 2 * 4 * (cells + 1)},
        {"counting sort", by_counting, {"neighbours_scattered_kernel"}, counting},
        {"reordered", and_gather, {"neighbours_coherent_kernel"}, counting + 16 * n},
        {"whole vectors", and_gather_columns, {"neighbours_in_lanes_kernel"}, counting + 12 * (n + kLanes)}};
}

}  // namespace grid
