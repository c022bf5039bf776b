/// @file
/// The loop that runs the threads of a block. It is compiled with each kernel, so that the kernel becomes its
/// body.
#pragma once
#include "cudasim/thread_index.h"

namespace cudasim {

/// The block a worker runs, as the thread loop and the scheduler both see it. Threads start in a certain
/// order; a position in that order is a thread's turn.
struct RunningBlock {
    unsigned size = 0;                ///< threads of the block
    unsigned next = 0;                ///< turn of the first thread that has not started
    const unsigned* order = nullptr;  ///< thread number by turn; nullptr: ascending
};

/// Threads that are started one after the other: they differ in x only.
struct Row {
    unsigned begin, end, y, z;
};

/// Takes the next threads of the block: the rest of a row, or a single one where the order is not ascending.
inline Row take_row(RunningBlock& block) {
    const unsigned thread = block.order ? block.order[block.next] : block.next;
    if (thread == 0 && !block.order) {  // most blocks are one row: spare them the divisions
        block.next = blockDim.x;
        return {0, blockDim.x, 0, 0};
    }
    const unsigned x = thread % blockDim.x, row = thread / blockDim.x;
    const unsigned end = block.order ? x + 1 : blockDim.x;
    block.next += end - x;
    return {x, end, row % blockDim.y, row / blockDim.y};
}

/// Runs threads of the block that have not started yet, until there are none, or until a thread ends that had
/// to wait in between (`waited`): others have run meanwhile, so the scheduler decides what comes next.
///
/// Three things make it as fast as a loop written by hand: the copy of the call, which keeps the arguments in
/// registers; the last line, which shows the compiler that nobody reads threadIdx after a thread, so that it
/// need not be stored where the kernel is small; and unrolling, which GCC does for small kernels only.
template <class Call>
void run_fresh_threads(RunningBlock& block, bool& waited, const void* call) {
    const Call kernel = *static_cast<const Call*>(call);
    while (block.next < block.size && !waited) {
        const Row row = take_row(block);
        threadIdx = {row.begin, row.y, row.z};
#pragma GCC unroll 4
        for (unsigned x = row.begin; x < row.end; ++x) {
            threadIdx.x = x;
            kernel();
            if (__builtin_expect(waited, 0)) break;
        }
        threadIdx.x = 0;
    }
}

}  // namespace cudasim
