/// @file
/// Exclusive prefix sum: element i becomes the sum of all elements before it. It turns counts into offsets.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "04_parallel_patterns/blocks.h"
#include "common/device_buffer.h"

namespace patterns {

/// CPU reference. @returns the total.
inline std::uint32_t exclusive_scan_cpu(std::vector<std::uint32_t>& values) {
    std::uint32_t sum = 0;
    for (std::uint32_t& value : values) {
        const std::uint32_t count = value;
        value = sum;
        sum += count;
    }
    return sum;
}

//! [scan_doubling]
/// One thread per element: adds what stands `step` places before it. After steps of 1, 2, 4, ... each element
/// holds everything up to itself. Each step reads all elements and writes all of them, to another array,
/// since the old values are still wanted by others.
inline __global__ void scan_doubling_kernel(std::uint32_t* to, const std::uint32_t* from, std::uint32_t step,
                                            std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    std::uint32_t sum = from[i];
    if (i >= step) sum += from[i - step];
    to[i] = sum;
}

/// One thread per element: from inclusive to exclusive, each sum moves up by one place.
inline __global__ void shift_kernel(std::uint32_t* to, const std::uint32_t* from, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    std::uint32_t before = 0;
    if (i > 0) before = from[i - 1];
    to[i] = before;
}
//! [scan_doubling]

//! [scan_shared]
/// Only the difference: the doubling steps happen inside a block, in shared memory, so global memory is read
/// and written once. A block knows nothing of those before it; it hands its total on.
inline __global__ void scan_shared_kernel(std::uint32_t* values, std::uint32_t* totals, std::uint32_t n) {
    __shared__ std::uint32_t sums[2][kThreads];
    const std::uint32_t t = threadIdx.x, i = blockIdx.x * kThreads + t;
    std::uint32_t mine = 0;  // beyond n there is nothing to add
    if (i < n) mine = values[i];
    std::uint32_t sum = mine, from = 0;
    for (std::uint32_t step = 1; step < kThreads; step *= 2) {
        sums[from][t] = sum;
        __syncthreads();
        if (t >= step) sum += sums[from][t - step];
        from = 1 - from;  // the next step writes where nobody reads any more
    }
    if (i < n) values[i] = sum - mine;
    if (t == kThreads - 1) totals[blockIdx.x] = sum;
}
//! [scan_shared]

//! [scan_warp]
/// Sum of this lane's value and of those of all lanes below.
inline __device__ std::uint32_t warp_inclusive_sum(std::uint32_t value) {
    const std::uint32_t lane = threadIdx.x % kWarp;
    for (std::uint32_t step = 1; step < kWarp; step *= 2) {
        const std::uint32_t below = __shfl_up_sync(kAllLanes, value, step);  // all lanes call it...
        if (lane >= step) value += below;                                    // ...and some use it
    }
    return value;
}

/// Only the difference: doubling inside warps, by shuffles; then the first warp scans the totals of the
/// warps.
inline __global__ void scan_warp_kernel(std::uint32_t* values, std::uint32_t* totals, std::uint32_t n) {
    __shared__ std::uint32_t warp_totals[kWarps];
    const std::uint32_t warp = threadIdx.x / kWarp, lane = threadIdx.x % kWarp;
    const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
    std::uint32_t mine = 0;
    if (i < n) mine = values[i];
    std::uint32_t sum = warp_inclusive_sum(mine);
    if (lane == kWarp - 1) warp_totals[warp] = sum;
    __syncthreads();
    if (warp == 0) {
        std::uint32_t total = 0;
        if (lane < kWarps) total = warp_totals[lane];
        total = warp_inclusive_sum(total);
        if (lane < kWarps) warp_totals[lane] = total;
    }
    __syncthreads();
    if (warp > 0) sum += warp_totals[warp - 1];
    if (i < n) values[i] = sum - mine;
    if (threadIdx.x == kThreads - 1) totals[blockIdx.x] = sum;
}
//! [scan_warp]

/// One thread per element: adds what all blocks before its own hold.
inline __global__ void add_before_kernel(std::uint32_t* values, const std::uint32_t* before,
                                         std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] += before[blockIdx.x];
}

constexpr std::uint32_t kScanChunk =
    64;  ///< elements a thread adds up alone; long enough to make the recursion shallow

//! [scan_chunks]
/// One thread per chunk: adds the chunk up.
inline __global__ void chunk_sums_kernel(std::uint32_t* sums, const std::uint32_t* values, std::uint32_t n) {
    const std::uint32_t chunk = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t first = chunk * kScanChunk;
    if (first >= n) return;
    const std::uint32_t last = min(n, first + kScanChunk);
    std::uint32_t sum = 0;
    for (std::uint32_t i = first; i < last; ++i) sum += values[i];
    sums[chunk] = sum;
}

/// One thread per chunk: the running sum inside the chunk, starting from what all chunks before it hold.
inline __global__ void scan_chunks_kernel(std::uint32_t* values, const std::uint32_t* sum_before,
                                          std::uint32_t n) {
    const std::uint32_t chunk = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t first = chunk * kScanChunk;
    if (first >= n) return;
    const std::uint32_t last = min(n, first + kScanChunk);
    std::uint32_t sum = sum_before[chunk];
    for (std::uint32_t i = first; i < last; ++i) {
        const std::uint32_t count = values[i];
        values[i] = sum;
        sum += count;
    }
}
//! [scan_chunks]

enum class ScanMethod { shared, warp, chunks };

//! [ExclusiveScan]
/// Scan of up to 2^31 elements, in place: the sums of the parts are scanned by the same function, much
/// shorter each time, until one part is left. A part is a chunk, or what a block takes. The scratch memory is
/// made once, for a largest length.
class ExclusiveScan {
  public:
    explicit ExclusiveScan(std::uint32_t max_length, ScanMethod method = ScanMethod::chunks)
        : method_(method) {
        // The last level has one element: the zero before the first part.
        for (std::uint32_t length = max_length; length > 1; length = parts(length, method))
            levels_.emplace_back(parts(length, method));
    }
    void operator()(std::uint32_t* values, std::uint32_t n) { scan(values, n, 0); }

    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const auto& level : levels_) sum += level.bytes();
        return sum;
    }
    /// How often a scan of n elements launches each of its two kernels.
    static int levels(std::uint32_t n, ScanMethod method = ScanMethod::chunks) {
        return n > 1 ? 1 + levels(parts(n, method), method) : 0;
    }
    static std::uint32_t parts(std::uint32_t n, ScanMethod method) {
        return blocks_for(n, method == ScanMethod::chunks ? kScanChunk : kThreads);
    }

  private:
    void scan(std::uint32_t* values, std::uint32_t n, std::size_t level) {
        if (n <= 1) {  // nothing stands before the only element
            if (n == 1) CUDA_CHECK(cudaMemset(values, 0, sizeof *values));
            return;
        }
        std::uint32_t* sums = levels_[level].data();
        const std::uint32_t count = parts(n, method_);
        if (method_ == ScanMethod::chunks) {
            const std::uint32_t threads = 64;  // small blocks: a chunk each leaves few threads
            chunk_sums_kernel<<<blocks_for(count, threads), threads>>>(sums, values, n);
            CUDA_CHECK(cudaGetLastError());
            scan(sums, count, level + 1);
            scan_chunks_kernel<<<blocks_for(count, threads), threads>>>(values, sums, n);
        } else {
            if (method_ == ScanMethod::shared)
                scan_shared_kernel<<<count, kThreads>>>(values, sums, n);
            else
                scan_warp_kernel<<<count, kThreads>>>(values, sums, n);
            CUDA_CHECK(cudaGetLastError());
            scan(sums, count, level + 1);
            add_before_kernel<<<count, kThreads>>>(values, sums, n);
        }
        CUDA_CHECK(cudaGetLastError());
    }

    ScanMethod method_;
    std::vector<course::DeviceBuffer<std::uint32_t>> levels_;
};
//! [ExclusiveScan]

/// The naive scan: a launch for each doubling, between two arrays.
class DoublingScan {
  public:
    explicit DoublingScan(std::uint32_t max_length) : scratch_(max_length) {}

    void operator()(std::uint32_t* values, std::uint32_t n) {
        if (n == 0) return;
        std::uint32_t *from = values, *to = scratch_.data();
        for (std::uint64_t step = 1; step < n; step *= 2) {
            scan_doubling_kernel<<<blocks_for(n), kThreads>>>(to, from, std::uint32_t(step), n);
            CUDA_CHECK(cudaGetLastError());
            std::swap(from, to);
        }
        shift_kernel<<<blocks_for(n), kThreads>>>(to, from, n);
        CUDA_CHECK(cudaGetLastError());
        if (to != values) CUDA_CHECK(cudaMemcpy(values, to, n * sizeof *values, cudaMemcpyDeviceToDevice));
    }
    /// Launches of scan_doubling_kernel.
    static int doublings(std::uint32_t n) {
        int count = 0;
        for (std::uint64_t step = 1; step < n; step *= 2) ++count;
        return count;
    }

  private:
    course::DeviceBuffer<std::uint32_t> scratch_;
};

}  // namespace patterns
