/// @file
/// How the chapter's kernels share their work: numbers that kernels, costs and pictures agree on.
#pragma once
#include <cstdint>

/// Chapter 04: reduction, scan, histogram, compaction, bounds.
namespace patterns {

constexpr std::uint32_t kThreads = 256;  ///< in a block: a power of two, which the trees rely on
constexpr std::uint32_t kWarp = 32;      ///< threads in a warp, on every GPU so far
constexpr std::uint32_t kWarps = kThreads / kWarp;
constexpr std::uint32_t kMaxBlocks = 1024;   ///< of kernels whose threads walk over many elements
constexpr unsigned kAllLanes = 0xffffffffu;  ///< mask of a warp operation: nobody is left out

/// Blocks of one thread per element.
inline std::uint32_t blocks_for(std::uint32_t n, std::uint32_t threads = kThreads) {
    return n / threads + (n % threads != 0);
}

/// Blocks of threads that walk over the elements in strides of the whole grid: enough for any GPU, and so few
/// that what each block leaves behind is next to nothing.
inline std::uint32_t walking_blocks(std::uint32_t n) {
    return blocks_for(n) < kMaxBlocks ? blocks_for(n) : kMaxBlocks;
}

}  // namespace patterns
