/// @file
/// What the rewriter makes of `__shared__` declarations.
///
///     __shared__ float tile[256];
///
/// becomes, on one line,
///
///     CUDASIM_SHARED_BEGIN(tile) float tile[256]; CUDASIM_SHARED_END(tile) auto& tile =
///     cudasim_memory_tile.tile;
///
/// that is a structure with one copy for each worker. The first thread of a block that comes by fills it with
/// poison: a kernel that reads what nobody wrote gets NaN, not the values of the block before. In a build
/// with AddressSanitizer the structure has a forbidden zone at both ends.
#pragma once
#include <cstddef>

#include "cudasim/thread_index.h"

namespace cudasim {

/// Number of the block that this worker runs: each block that it ever ran has its own.
inline thread_local unsigned long block_serial = 0;

constexpr std::size_t kSharedLimit = 48 * 1024;  ///< bytes of shared memory a block may use

#if defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kRedZone = 64;
#else
constexpr std::size_t kRedZone = 0;
#endif

/// Fills `bytes` of memory with poison, and forbids the zones of kRedZone bytes before and behind them.
void poison_shared(void* begin, std::size_t bytes);

template <class Memory>
inline void begin_shared(Memory& memory) {
    constexpr std::size_t bytes = offsetof(Memory, cudasim_after) - kRedZone;
    static_assert(bytes <= kSharedLimit, "a block has 48 KiB of shared memory");
    if (__builtin_expect(memory.cudasim_block == block_serial, 1)) return;
    memory.cudasim_block = block_serial;
    poison_shared(reinterpret_cast<char*>(&memory) + kRedZone, bytes);
}

/// Start of the dynamic shared memory, whose size the launch gave. The byte behind its end cannot be touched.
void* dynamic_shared();

}  // namespace cudasim

// clang-format off
#define CUDASIM_SHARED_BEGIN(name) struct cudasim_shared_##name { char cudasim_before[::cudasim::kRedZone];
#define CUDASIM_SHARED_END(name)                                                        \
    char cudasim_after[::cudasim::kRedZone]; unsigned long cudasim_block; };            \
    static thread_local cudasim_shared_##name cudasim_memory_##name;                    \
    ::cudasim::begin_shared(cudasim_memory_##name);
// clang-format on
