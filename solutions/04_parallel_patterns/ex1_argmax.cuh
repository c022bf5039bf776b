// Exercise 04.1: the largest number, and where it stands.
//
// Is any particle too fast, and which one? A program asks this at each step, so the answer must be cheap. It
// is a reduction whose numbers are pairs: a value, and its place.
#pragma once
#include <climits>
#include <cmath>

#include "04_parallel_patterns/reduce.cuh"
#include "common/todo.h"

namespace patterns {

struct Best {
    float value;
    int place;
};

// What is there before the first number: it beats nothing.
inline __host__ __device__ Best nothing() {
    return {-INFINITY, INT_MAX};
}

// A number that is none (NaN) beats all numbers: it is what such a search is for. Of equal ones the first
// wins, so that the answer does not depend on who came first.
inline __host__ __device__ bool beats(Best a, Best b) {
    const bool a_is_nan = !(a.value == a.value), b_is_nan = !(b.value == b.value);
    if (a_is_nan != b_is_nan) return a_is_nan;
    if (!a_is_nan && a.value != b.value) return a.value > b.value;
    return a.place < b.place;
}

// The best of the 32 lanes, in lane 0.
inline __device__ Best warp_best(Best mine) {
    // TODO(4.1): as warp_sum() in reduce.cuh, but a pair needs two shuffles: both of them by all lanes, and
    // before anybody decides. About 5 lines.
    // <solution>
    for (std::uint32_t offset = kWarp / 2; offset > 0; offset /= 2) {
        Best other;
        other.value = __shfl_down_sync(kAllLanes, mine.value, offset);
        other.place = __shfl_down_sync(kAllLanes, mine.place, offset);
        if (beats(other, mine)) mine = other;
    }
    return mine;
    // <stub>
    //| (void)mine;
    //| return {float(course::kTodo), course::kTodo};
    // </solution>
}

// One best of each block of kThreads threads. Threads walk over the values in strides of the whole grid.
inline __global__ void argmax_kernel(Best* bests, const float* values, std::uint32_t n) {
    __shared__ Best of_warp[kWarps];
    const std::uint32_t warp = threadIdx.x / kWarp, lane = threadIdx.x % kWarp;
    Best mine = nothing();
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x)
        if (const Best candidate = {values[i], int(i)}; beats(candidate, mine)) mine = candidate;
    mine = warp_best(mine);
    // TODO(4.1): the bests of the warps meet in of_warp; the first warp finds the best of them, and one
    // thread writes bests[blockIdx.x]. Lanes without a warp bring nothing(). About 7 lines.
    // <solution>
    if (lane == 0) of_warp[warp] = mine;
    __syncthreads();
    if (warp > 0) return;
    mine = nothing();
    if (lane < kWarps) mine = of_warp[lane];
    mine = warp_best(mine);
    if (lane == 0) bests[blockIdx.x] = mine;
    // <stub>
    //| of_warp[warp] = mine;
    //| if (lane == 0 && warp == 0) bests[blockIdx.x] = {float(course::kTodo), course::kTodo};
    // </solution>
}

// The largest of n values on the device; nothing() if there are none. Blocks are few, so the host compares
// their bests.
inline Best argmax(const float* values, std::uint32_t n) {
    Best best = nothing();
    if (n == 0) return best;
    const std::uint32_t blocks = blocks_for(n) < 8 ? blocks_for(n) : 8;
    course::DeviceBuffer<Best> bests(blocks);
    argmax_kernel<<<blocks, kThreads>>>(bests.data(), values, n);
    CUDA_CHECK(cudaGetLastError());
    for (const Best candidate : bests.download())
        if (beats(candidate, best)) best = candidate;
    return best;
}

}  // namespace patterns
