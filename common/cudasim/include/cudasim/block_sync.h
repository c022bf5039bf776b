/// @file
/// Barriers of a block.
#pragma once
#include "cudasim/device_memory.h"  // CUDASIM_CALLER

namespace cudasim {

/// What the threads of a block told each other at a barrier.
struct Votes {
    int count;  ///< threads whose predicate was not 0
    bool all;   ///< every thread's was not 0
};
/// Waits for all threads of the block. `file` and `line` are for the report when they do not all come.
Votes wait_for_block(bool predicate, const char* name, const char* file, int line);

}  // namespace cudasim

inline void __syncthreads(CUDASIM_CALLER) {
    cudasim::wait_for_block(false, "__syncthreads()", file, line);
}
inline int __syncthreads_count(int predicate, CUDASIM_CALLER) {
    return cudasim::wait_for_block(predicate != 0, "__syncthreads_count()", file, line).count;
}
inline int __syncthreads_and(int predicate, CUDASIM_CALLER) {
    return cudasim::wait_for_block(predicate != 0, "__syncthreads_and()", file, line).all;
}
inline int __syncthreads_or(int predicate, CUDASIM_CALLER) {
    return cudasim::wait_for_block(predicate != 0, "__syncthreads_or()", file, line).count != 0;
}
