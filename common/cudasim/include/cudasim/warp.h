/// @file
/// Warp operations: the 32 threads of a warp exchange values. All lanes named in `mask` that have not ended
/// must call the same operation with the same mask.
#pragma once
#include <cstdint>
#include <cstring>

#include "cudasim/device_memory.h"  // CUDASIM_CALLER
#include "cudasim/thread_index.h"

namespace cudasim {

/// What the lanes of a warp brought along.
struct WarpExchange {
    const std::uint64_t* values;  ///< by lane; kPoison from lanes that took no part
    unsigned lanes;               ///< that took part
    unsigned votes;               ///< lanes whose predicate was not 0
};
/// Waits for the lanes in `mask`. The result is good until this thread's next warp operation.
WarpExchange wait_for_warp(unsigned mask, std::uint64_t value, bool predicate, const char* name,
                           const char* file, int line);

inline int lane() {
    return static_cast<int>(thread_number() % 32);
}

/// The value that `source` brought. A lane that took no part gives the poison pattern: on a GPU it is
/// undefined.
template <class T>
T shuffle(unsigned mask, T value, int source, const char* name, const char* file, int line) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8,
                  "a shuffle moves 4 or 8 bytes: shuffle a struct by members");
    std::uint64_t raw = 0;
    std::memcpy(&raw, &value, sizeof value);
    const WarpExchange exchange = wait_for_warp(mask, raw, false, name, file, line);
    std::memcpy(&value, &exchange.values[source], sizeof value);
    return value;
}

}  // namespace cudasim

// `width` cuts the warp into groups that shuffle among themselves. A source outside the group leaves a thread
// its own value, except for __shfl_sync, which wraps around.
template <class T>
T __shfl_sync(unsigned mask, T value, int source, int width = 32, CUDASIM_CALLER) {
    const int group = cudasim::lane() & ~(width - 1);
    return cudasim::shuffle(mask, value, group | (source & (width - 1)), "__shfl_sync()", file, line);
}
template <class T>
T __shfl_up_sync(unsigned mask, T value, unsigned delta, int width = 32, CUDASIM_CALLER) {
    const int lane = cudasim::lane(), source = lane - static_cast<int>(delta);
    const bool inside = source >= (lane & ~(width - 1));
    return cudasim::shuffle(mask, value, inside ? source : lane, "__shfl_up_sync()", file, line);
}
template <class T>
T __shfl_down_sync(unsigned mask, T value, unsigned delta, int width = 32, CUDASIM_CALLER) {
    const int lane = cudasim::lane(), source = lane + static_cast<int>(delta);
    const bool inside = source <= (lane | (width - 1));
    return cudasim::shuffle(mask, value, inside ? source : lane, "__shfl_down_sync()", file, line);
}
template <class T>
T __shfl_xor_sync(unsigned mask, T value, int lane_mask, int width = 32, CUDASIM_CALLER) {
    const int lane = cudasim::lane(), source = lane ^ lane_mask;
    const bool inside = source <= (lane | (width - 1));  // groups before this one may be read
    return cudasim::shuffle(mask, value, inside ? source : lane, "__shfl_xor_sync()", file, line);
}

inline void __syncwarp(unsigned mask = 0xffffffffu, CUDASIM_CALLER) {
    cudasim::wait_for_warp(mask, 0, false, "__syncwarp()", file, line);
}
inline unsigned __ballot_sync(unsigned mask, int predicate, CUDASIM_CALLER) {
    return cudasim::wait_for_warp(mask, 0, predicate != 0, "__ballot_sync()", file, line).votes;
}
inline int __any_sync(unsigned mask, int predicate, CUDASIM_CALLER) {
    return cudasim::wait_for_warp(mask, 0, predicate != 0, "__any_sync()", file, line).votes != 0;
}
inline int __all_sync(unsigned mask, int predicate, CUDASIM_CALLER) {
    const auto exchange = cudasim::wait_for_warp(mask, 0, predicate != 0, "__all_sync()", file, line);
    return exchange.votes == exchange.lanes;
}
