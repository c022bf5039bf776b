/// @file
/// A launch that is being run by the workers together.
#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>

#include "cudasim.h"

namespace cudasim {

struct Grid {
    const LaunchRequest& request;
    Order order;
    std::uint64_t blocks;  ///< number of blocks
    std::uint64_t chunk;   ///< blocks that a worker takes at a time
    std::atomic<std::uint64_t> next_turn{0};
    std::atomic<bool> failed{false};  ///< a worker met an error: no further block starts

    std::mutex counts_mutex;
    Counts counts;  ///< of all workers that have finished

    Grid(const LaunchRequest& launch, Order launch_order, unsigned workers)
        : request(launch),
          order(launch_order),
          blocks(std::uint64_t{launch.grid.x} * launch.grid.y * launch.grid.z),
          chunk(blocks / (workers * 8) + 1) {}
};

}  // namespace cudasim
