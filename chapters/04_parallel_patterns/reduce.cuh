/// @file
/// Reduction: one value from many. The lesson is the sum of numbers; TreeReduction takes any value and any
/// operation.
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

//! [Sum]
/// An operation: how two values become one, and the value that changes nothing. A maximum, a box or a whole
/// summary of particles will do as well: whatever does not care which two values meet first.
template <class T>
struct Sum {
    using Value = T;
    static __host__ __device__ T nothing() { return 0; }
    static __host__ __device__ T combine(T a, T b) { return a + b; }
};
//! [Sum]

/// Combines every element whose number is the calling thread's plus a multiple of the grid's threads.
/// Neighbouring threads read neighbouring elements, in each step.
/// @param values  a pointer, or anything else that makes its element i when asked for values[i]
template <class Operation, class Values>
__device__ typename Operation::Value walk(Values values, std::uint32_t n) {
    typename Operation::Value mine = Operation::nothing();
    const std::uint32_t stride = gridDim.x * blockDim.x;
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += stride)
        mine = Operation::combine(mine, values[i]);
    return mine;
}

//! [reduce_shared]
/// Only the difference: each thread first adds up many elements in a register; then the block's threads meet
/// in shared memory, where half of them add what the other half brought, again and again. No atomics, so also
/// a sum of floats repeats bit for bit.
/// @param results  one per block
template <class Operation, class Values>
__global__ void reduce_shared_kernel(typename Operation::Value* results, Values values, std::uint32_t n) {
    __shared__ typename Operation::Value partial[kThreads];
    const std::uint32_t t = threadIdx.x;
    partial[t] = walk<Operation>(values, n);
    for (std::uint32_t half = kThreads / 2; half > 0; half /= 2) {
        __syncthreads();  // what is read here was written by another thread
        if (t < half) partial[t] = Operation::combine(partial[t], partial[t + half]);
    }
    if (t == 0) results[blockIdx.x] = partial[0];
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
    const T sum = warp_sum(walk<Sum<T>>(values, n));
    if (lane == 0) partial[warp] = sum;
    __syncthreads();
    if (warp > 0) return;  // whole warps leave, so the first one is complete below
    T total = 0;
    if (lane < kWarps) total = partial[lane];
    total = warp_sum(total);
    if (lane == 0) sums[blockIdx.x] = total;
}
//! [reduce_warp]

//! [TreeReduction]
/// Reduces up to `max_n` elements by any operation, again and again, in memory made once. The tree runs
/// twice: once for the result of each block, and a single block for the result of those.
template <class Operation>
class TreeReduction {
  public:
    using Value = typename Operation::Value;

    /// @param max_blocks  fewer blocks walk farther: less to do for the trees, and less of the GPU in use
    explicit TreeReduction(std::uint32_t max_n, std::uint32_t max_blocks = kMaxBlocks)
        : max_blocks_(max_blocks), of_blocks_(blocks_of(max_n)), result_(1) {}

    /// The result is on the device, at result(); nobody waits.
    template <class Values>
    void operator()(Values values, std::uint32_t n) {
        if (n == 0) {  // a launch of zero blocks is an error
            result_.upload({Operation::nothing()});
            return;
        }
        const std::uint32_t blocks = blocks_of(n);
        reduce_shared_kernel<Operation><<<blocks, kThreads>>>(of_blocks_.data(), values, n);
        CUDA_CHECK(cudaGetLastError());
        const Value* of_blocks = of_blocks_.data();
        reduce_shared_kernel<Operation><<<1, kThreads>>>(result_.data(), of_blocks, blocks);
        CUDA_CHECK(cudaGetLastError());
    }
    const Value* result() const { return result_.data(); }
    Value download() const { return result_.download()[0]; }
    std::size_t bytes() const { return of_blocks_.bytes() + result_.bytes(); }

  private:
    std::uint32_t blocks_of(std::uint32_t n) const {
        return walking_blocks(n) < max_blocks_ ? walking_blocks(n) : max_blocks_;
    }

    std::uint32_t max_blocks_;
    course::DeviceBuffer<Value> of_blocks_, result_;
};
//! [TreeReduction]

enum class ReduceMethod { atomic, shared, warp };

/// Adds up to `max_n` numbers by one of the three methods, so that they can be compared. The warps' tree runs
/// twice, too.
template <class T>
class Reduction {
  public:
    Reduction(ReduceMethod method, std::uint32_t max_n)
        : method_(method),
          tree_(method == ReduceMethod::shared ? max_n : 0),
          sums_(method == ReduceMethod::warp ? walking_blocks(max_n) : 0),
          total_(method == ReduceMethod::shared ? 0 : 1) {}

    /// The sum is on the device, at total(); nobody waits.
    void operator()(const T* values, std::uint32_t n) {
        if (method_ == ReduceMethod::shared) return tree_(values, n);
        if (n == 0 || method_ == ReduceMethod::atomic)
            CUDA_CHECK(cudaMemset(total_.data(), 0, sizeof(T)));  // all bits 0 is 0 for floats, too
        if (n == 0) return;
        if (method_ == ReduceMethod::atomic) {
            reduce_atomic_kernel<<<blocks_for(n), kThreads>>>(total_.data(), values, n);
        } else {
            const std::uint32_t blocks = walking_blocks(n);
            reduce_warp_kernel<<<blocks, kThreads>>>(sums_.data(), values, n);
            CUDA_CHECK(cudaGetLastError());
            reduce_warp_kernel<<<1, kThreads>>>(total_.data(), sums_.data(), blocks);
        }
        CUDA_CHECK(cudaGetLastError());
    }
    const T* total() const { return method_ == ReduceMethod::shared ? tree_.result() : total_.data(); }
    T download() const { return method_ == ReduceMethod::shared ? tree_.download() : total_.download()[0]; }

  private:
    ReduceMethod method_;
    TreeReduction<Sum<T>> tree_;
    course::DeviceBuffer<T> sums_, total_;
};

}  // namespace patterns
