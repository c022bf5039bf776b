/// @file
/// Histogram: how many elements fall into each bin. Many threads count at few places.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <vector>

#include "04_parallel_patterns/blocks.h"
#include "common/device_buffer.h"

namespace patterns {

constexpr std::uint32_t kBins = 256;

/// CPU reference. @pre every element of `bin` is below kBins, here and in the kernels
inline std::vector<std::uint32_t> histogram_cpu(const std::vector<std::uint32_t>& bin) {
    std::vector<std::uint32_t> counts(kBins, 0);
    for (const std::uint32_t b : bin) ++counts[b];
    return counts;
}

//! [histogram_atomic]
/// One thread per element: counts it in global memory. Threads that meet in a bin wait for each other.
/// @param counts  kBins numbers that start at 0
inline __global__ void histogram_atomic_kernel(std::uint32_t* counts, const std::uint32_t* bin,
                                               std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) atomicAdd(&counts[bin[i]], 1u);
}
//! [histogram_atomic]

//! [histogram_shared]
/// Only the difference: each block counts its share in a histogram of its own, in shared memory, where an
/// atomic is near and only the block's own threads are in the way. Global memory gets one addition per block
/// and bin.
inline __global__ void histogram_shared_kernel(std::uint32_t* counts, const std::uint32_t* bin,
                                               std::uint32_t n) {
    __shared__ std::uint32_t mine[kBins];
    for (std::uint32_t b = threadIdx.x; b < kBins; b += kThreads) mine[b] = 0;
    __syncthreads();
    for (std::uint32_t i = blockIdx.x * kThreads + threadIdx.x; i < n; i += gridDim.x * kThreads)
        atomicAdd(&mine[bin[i]], 1u);
    __syncthreads();
    for (std::uint32_t b = threadIdx.x; b < kBins; b += kThreads) atomicAdd(&counts[b], mine[b]);
}
//! [histogram_shared]

//! [histogram_warp]
/// Only the difference: a histogram for each warp, so that at most 32 threads meet in a bin. It takes 8 times
/// the shared memory, and the copies have to be added up.
inline __global__ void histogram_warp_kernel(std::uint32_t* counts, const std::uint32_t* bin,
                                             std::uint32_t n) {
    __shared__ std::uint32_t mine[kWarps][kBins];
    const std::uint32_t warp = threadIdx.x / kWarp;
    for (std::uint32_t b = threadIdx.x; b < kWarps * kBins; b += kThreads) mine[b / kBins][b % kBins] = 0;
    __syncthreads();
    for (std::uint32_t i = blockIdx.x * kThreads + threadIdx.x; i < n; i += gridDim.x * kThreads)
        atomicAdd(&mine[warp][bin[i]], 1u);
    __syncthreads();
    for (std::uint32_t b = threadIdx.x; b < kBins; b += kThreads) {
        std::uint32_t sum = 0;
        for (std::uint32_t w = 0; w < kWarps; ++w) sum += mine[w][b];
        atomicAdd(&counts[b], sum);
    }
}
//! [histogram_warp]

enum class HistogramMethod { atomic, shared, warp };

/// Sets `counts` (kBins numbers) to the histogram of n elements.
inline void histogram(HistogramMethod method, std::uint32_t* counts, const std::uint32_t* bin,
                      std::uint32_t n) {
    CUDA_CHECK(cudaMemset(counts, 0, kBins * sizeof *counts));
    if (n == 0) return;
    switch (method) {
        case HistogramMethod::atomic:
            histogram_atomic_kernel<<<blocks_for(n), kThreads>>>(counts, bin, n);
            break;
        case HistogramMethod::shared:
            histogram_shared_kernel<<<walking_blocks(n), kThreads>>>(counts, bin, n);
            break;
        case HistogramMethod::warp:
            histogram_warp_kernel<<<walking_blocks(n), kThreads>>>(counts, bin, n);
            break;
    }
    CUDA_CHECK(cudaGetLastError());
}

}  // namespace patterns
