/// @file
/// Reduction: one number from many. Here it is the sum; any operation will do for which the order does not
/// matter.
#pragma once
#include <cuda_runtime.h>

#include <vector>

#include "04_parallel_patterns/blocks.h"
#include "common/device_buffer.h"

namespace patterns {

/// CPU reference: one loop.
template <class T>
T reduce_cpu(const std::vector<T>& values) {
    T sum = 0;
    for (const T value : values) sum += value;
    return sum;
}

//! [reduce_atomic]
/// One thread per element: adds it to the one sum. Right, and a queue: all n additions happen at one address,
/// one after the other.
/// @param sum  starts at 0
template <class T>
__global__ void reduce_atomic_kernel(T* sum, const T* values, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) atomicAdd(sum, values[i]);
}
//! [reduce_atomic]

/// Sum of every element whose number is the calling thread's plus a multiple of the grid's threads.
/// Neighbouring threads read neighbouring elements, in each step.
template <class T>
__device__ T walk(const T* values, std::uint32_t n) {
    T sum = 0;
    const std::uint32_t stride = gridDim.x * blockDim.x;
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += stride) sum += values[i];
    return sum;
}

//! [reduce_shared]
/// Only the difference: each thread first adds up many elements in a register; then the block's threads meet
/// in shared memory, where half of them add what the other half brought, again and again. No atomics, so also
/// a sum of floats repeats bit for bit.
/// @param sums  one per block
template <class T>
__global__ void reduce_shared_kernel(T* sums, const T* values, std::uint32_t n) {
    __shared__ T partial[kThreads];
    const std::uint32_t t = threadIdx.x;
    partial[t] = walk(values, n);
    for (std::uint32_t half = kThreads / 2; half > 0; half /= 2) {
        __syncthreads();  // what is read here was written by another thread
        if (t < half) partial[t] += partial[t + half];
    }
    if (t == 0) sums[blockIdx.x] = partial[0];
}
//! [reduce_shared]

//! [reduce_warp]
/// Sum over the 32 lanes of a warp, in lane 0: each lane reads a register of the lane `offset` above it.
template <class T>
__device__ T warp_sum(T value) {
    for (std::uint32_t offset = kWarp / 2; offset > 0; offset /= 2)
        value += __shfl_down_sync(kAllLanes, value, offset);
    return value;
}

/// Only the difference: the tree climbs inside warps first, register to register, with no barrier. Shared
/// memory holds one number per warp, and one barrier is left.
template <class T>
__global__ void reduce_warp_kernel(T* sums, const T* values, std::uint32_t n) {
    __shared__ T partial[kWarps];
    const std::uint32_t warp = threadIdx.x / kWarp, lane = threadIdx.x % kWarp;
    const T sum = warp_sum(walk(values, n));
    if (lane == 0) partial[warp] = sum;
    __syncthreads();
    if (warp > 0) return;  // whole warps leave, so the first one is complete below
    T total = 0;
    if (lane < kWarps) total = partial[lane];
    total = warp_sum(total);
    if (lane == 0) sums[blockIdx.x] = total;
}
//! [reduce_warp]

enum class ReduceMethod { atomic, shared, warp };

//! [Reduction]
/// Adds up to `max_n` elements, again and again, in memory made once. The trees run twice: once for the sum
/// of each block, and a single block for the sum of those.
template <class T>
class Reduction {
  public:
    Reduction(ReduceMethod method, std::uint32_t max_n)
        : method_(method), sums_(method == ReduceMethod::atomic ? 0 : walking_blocks(max_n)), total_(1) {}

    /// The sum is on the device, at total(); nobody waits.
    void operator()(const T* values, std::uint32_t n) {
        if (n == 0 || method_ == ReduceMethod::atomic)
            CUDA_CHECK(cudaMemset(total_.data(), 0, sizeof(T)));  // all bits 0 is 0 for floats, too
        if (n == 0) return;                                       // a launch of zero blocks is an error
        const std::uint32_t blocks = walking_blocks(n);
        switch (method_) {
            case ReduceMethod::atomic:
                reduce_atomic_kernel<<<blocks_for(n), kThreads>>>(total_.data(), values, n);
                break;
            case ReduceMethod::shared:
                reduce_shared_kernel<<<blocks, kThreads>>>(sums_.data(), values, n);
                CUDA_CHECK(cudaGetLastError());
                reduce_shared_kernel<<<1, kThreads>>>(total_.data(), sums_.data(), blocks);
                break;
            case ReduceMethod::warp:
                reduce_warp_kernel<<<blocks, kThreads>>>(sums_.data(), values, n);
                CUDA_CHECK(cudaGetLastError());
                reduce_warp_kernel<<<1, kThreads>>>(total_.data(), sums_.data(), blocks);
                break;
        }
        CUDA_CHECK(cudaGetLastError());
    }
    const T* total() const { return total_.data(); }
    T download() const { return total_.download()[0]; }

  private:
    ReduceMethod method_;
    course::DeviceBuffer<T> sums_, total_;
};
//! [Reduction]

}  // namespace patterns
