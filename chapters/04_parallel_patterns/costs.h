/// @file
/// What each kernel of this chapter does, by formula. A test holds the formulas against the simulator's exact
/// counts.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "04_parallel_patterns/blocks.h"

namespace patterns {

/// Work of one or more launches. Accesses are counted as the source says them, thread by thread, so an
/// element that all threads of a block read counts once for each.
struct Cost {
    std::uint64_t launches = 0;
    std::uint64_t loads = 0, stores = 0;  ///< of global memory
    std::uint64_t bytes = 0;              ///< of these loads and stores
    std::uint64_t atomics = 0;            ///< on global memory
    std::uint64_t shared_loads = 0, shared_stores = 0, shared_atomics = 0;
    std::uint64_t barriers = 0;         ///< of blocks
    std::uint64_t warp_operations = 0;  ///< of warps: shuffles and votes

    Cost& operator+=(const Cost& other) {
        launches += other.launches;
        loads += other.loads;
        stores += other.stores;
        bytes += other.bytes;
        atomics += other.atomics;
        shared_loads += other.shared_loads;
        shared_stores += other.shared_stores;
        shared_atomics += other.shared_atomics;
        barriers += other.barriers;
        warp_operations += other.warp_operations;
        return *this;
    }
};

/// A launch whose loads and stores are all of 4 bytes.
inline Cost launch_of(std::uint64_t loads, std::uint64_t stores, std::uint64_t atomics = 0) {
    return {1, loads, stores, 4 * (loads + stores), atomics, 0, 0, 0, 0, 0};
}

constexpr std::uint64_t kTreeSteps = 8, kWarpSteps = 5;  ///< log2 of kThreads and of kWarp
static_assert(1u << kTreeSteps == kThreads && 1u << kWarpSteps == kWarp);

/// Adds to `cost` what the blocks of a tree in shared memory do, for `values` trees at once.
inline void add_shared_trees(Cost& cost, std::uint64_t blocks, std::uint64_t values) {
    cost.shared_stores += blocks * values * (kThreads + (kThreads - 1));  // own value, then each addition
    cost.shared_loads += blocks * values * (2 * (kThreads - 1) + 1);  // two each addition, then the result
    cost.barriers += blocks * kTreeSteps;
}
/// The same of shuffles inside warps, then inside the first warp.
inline void add_warp_trees(Cost& cost, std::uint64_t blocks, std::uint64_t values) {
    cost.shared_stores += blocks * values * kWarps;
    cost.shared_loads += blocks * values * kWarps;
    cost.barriers += blocks;
    cost.warp_operations += blocks * values * (kWarps + 1) * kWarpSteps;
}

//! [reduce_costs]
inline Cost cost_of_reduce_atomic(std::uint32_t n) {
    return n ? launch_of(n, 0, n) : Cost{};
}
/// @param add_trees  add_shared_trees or add_warp_trees
inline Cost cost_of_reduce_tree(std::uint32_t n, void (*add_trees)(Cost&, std::uint64_t, std::uint64_t)) {
    if (n == 0) return {};
    const std::uint32_t blocks = walking_blocks(n);
    Cost cost = launch_of(n, blocks);
    cost += launch_of(blocks, 1);
    add_trees(cost, blocks + 1, 1);
    return cost;
}
//! [reduce_costs]

inline Cost cost_of_scan_doubling(std::uint32_t n) {
    Cost cost;
    if (n == 0) return cost;
    for (std::uint64_t step = 1; step < n; step *= 2) cost += launch_of(n + (n - step), n);
    cost += launch_of(n - 1, n);  // from inclusive to exclusive
    return cost;
}
/// What one level of the block-wise scans has in common: the scan, and the pass that adds what stands before.
inline Cost cost_of_scan_level(std::uint32_t n) {
    Cost cost = launch_of(n, n + blocks_for(n));
    cost += launch_of(2ull * n, n);
    return cost;
}
inline Cost cost_of_scan_shared(std::uint32_t n) {
    if (n <= 1) return {};
    const std::uint64_t blocks = blocks_for(n);
    Cost cost = cost_of_scan_level(n);
    cost.shared_stores += blocks * kTreeSteps * kThreads;
    cost.shared_loads += blocks * (kTreeSteps * kThreads - (kThreads - 1));
    cost.barriers += blocks * kTreeSteps;
    cost += cost_of_scan_shared(blocks_for(n));
    return cost;
}
inline Cost cost_of_scan_warp(std::uint32_t n) {
    if (n <= 1) return {};
    const std::uint64_t blocks = blocks_for(n);
    Cost cost = cost_of_scan_level(n);
    cost.shared_stores += blocks * 2 * kWarps;
    cost.shared_loads += blocks * (kWarps + (kThreads - kWarp));
    cost.barriers += blocks * 2;
    cost.warp_operations += blocks * (kWarps + 1) * kWarpSteps;
    cost += cost_of_scan_warp(blocks_for(n));
    return cost;
}
/// @param chunk  elements a thread adds up alone
inline Cost cost_of_scan_chunks(std::uint32_t n, std::uint32_t chunk) {
    if (n <= 1) return {};
    const std::uint32_t chunks = blocks_for(n, chunk);
    Cost cost = launch_of(n, chunks);
    cost += launch_of(std::uint64_t(n) + chunks, n);
    cost += cost_of_scan_chunks(chunks, chunk);
    return cost;
}

inline Cost cost_of_histogram_atomic(std::uint32_t n) {
    return n ? launch_of(n, 0, n) : Cost{};
}
/// @param copies  histograms in a block: 1, or one for each warp
inline Cost cost_of_histogram_shared(std::uint32_t n, std::uint64_t copies, std::uint32_t bins) {
    if (n == 0) return {};
    const std::uint64_t blocks = walking_blocks(n);
    Cost cost = launch_of(n, 0, blocks * bins);
    cost.shared_stores = cost.shared_loads = blocks * copies * bins;
    cost.shared_atomics = n;
    cost.barriers = blocks * 2;
    return cost;
}

inline Cost cost_of_compact_atomic(std::uint32_t n, std::uint32_t kept) {
    return n ? launch_of(n, kept, kept) : Cost{};
}
inline Cost cost_of_compact_shared(std::uint32_t n, std::uint32_t kept) {
    if (n == 0) return {};
    const std::uint64_t blocks = blocks_for(n);
    Cost cost = launch_of(n, kept, blocks);
    cost.shared_stores = 2 * blocks;
    cost.shared_loads = blocks + kept;
    cost.shared_atomics = kept;
    cost.barriers = 3 * blocks;
    return cost;
}
inline Cost cost_of_compact_warp(std::uint32_t n, std::uint32_t kept) {
    if (n == 0) return {};
    const std::uint64_t warps = std::uint64_t(blocks_for(n)) * kWarps;
    Cost cost = launch_of(n, kept, warps);
    cost.warp_operations = 2 * warps;  // a vote, and the place of the first
    return cost;
}
inline Cost cost_of_compact_scan(std::uint32_t n, std::uint32_t kept, std::uint32_t chunk) {
    if (n == 0) return {};
    Cost cost = launch_of(n, n);
    cost += cost_of_scan_chunks(n, chunk);
    cost += launch_of(2ull * n, kept + 1ull);
    return cost;
}

/// A launch that reads n positions of 16 bytes.
inline Cost cost_of_reading_positions(std::uint64_t n) {
    return {1, n, 0, 16 * n, 0, 0, 0, 0, 0, 0};
}
/// If no two threads get in each other's way. Each time two do, one of them has to ask again.
/// @param improvements  how often a particle moves one of the six extremes, when they come one after the
/// other
inline Cost cost_of_bounds_cas(std::uint32_t n, std::uint64_t improvements) {
    if (n == 0) return {};
    Cost cost = cost_of_reading_positions(n);
    cost.atomics = 6ull * n + improvements;
    return cost;
}
inline Cost cost_of_bounds_ordered(std::uint32_t n) {
    if (n == 0) return {};
    Cost cost = cost_of_reading_positions(n);
    cost.atomics = 6ull * n;
    return cost;
}
/// @param threads  of the whole grid
inline Cost cost_of_bounds_walk(std::uint32_t n, std::uint32_t threads) {
    if (n == 0) return {};
    Cost cost = cost_of_reading_positions(n);
    cost.atomics = 6ull * threads;
    return cost;
}
/// @param add_trees  add_shared_trees or add_warp_trees
inline Cost cost_of_bounds_tree(std::uint32_t n, void (*add_trees)(Cost&, std::uint64_t, std::uint64_t)) {
    if (n == 0) return {};
    Cost cost = cost_of_reading_positions(n);
    cost.atomics = 6ull * walking_blocks(n);
    add_trees(cost, walking_blocks(n), 6);
    return cost;
}

}  // namespace patterns
