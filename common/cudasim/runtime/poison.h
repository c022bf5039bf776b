/// @file
/// What memory holds that nobody has written.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>

namespace cudasim {

/// Fills memory with kPoison, word by word. `begin` must be aligned to a word.
inline void fill_with_poison(void* begin, std::size_t bytes) {
    const std::size_t words = bytes / sizeof kPoison;
    std::fill_n(static_cast<unsigned*>(begin), words, kPoison);
    std::memcpy(static_cast<unsigned*>(begin) + words, &kPoison,
                bytes % sizeof kPoison);  // the rest of the last
}

}  // namespace cudasim
