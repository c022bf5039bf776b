/// @file
/// Exclusive prefix sum: element i becomes the sum of all elements before it. It turns counts into offsets.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/device_buffer.h"

namespace grid {

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

constexpr std::uint32_t kScanChunk =
    64;  // elements a thread adds up alone; long enough to make the recursion shallow

//! [scan_kernels]
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
//! [scan_kernels]

//! [exclusive_scan]
/// Scan of up to 2^31 elements: the sums of the chunks are scanned by the same function, 64 times shorter
/// each time, until one chunk is left. The scratch memory is made once, for a largest length.
class ExclusiveScan {
  public:
    explicit ExclusiveScan(std::uint32_t max_length) {
        // The last level has one element: the zero before the first chunk.
        for (std::uint32_t length = max_length; length > 1; length = chunks(length))
            levels_.emplace_back(chunks(length));
    }
    void operator()(std::uint32_t* values, std::uint32_t n) { scan(values, n, 0); }

    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const auto& level : levels_) sum += level.bytes();
        return sum;
    }
    /// How often a scan of n elements launches each of the two kernels.
    static int levels(std::uint32_t n) { return n > 1 ? 1 + levels(chunks(n)) : 0; }

  private:
    static std::uint32_t chunks(std::uint32_t n) { return n / kScanChunk + (n % kScanChunk != 0); }

    void scan(std::uint32_t* values, std::uint32_t n, std::size_t level) {
        if (n <= 1) {  // nothing stands before the only element
            if (n == 1) CUDA_CHECK(cudaMemset(values, 0, sizeof *values));
            return;
        }
        std::uint32_t* sums = levels_[level].data();
        const std::uint32_t threads = 64, blocks = (chunks(n) + threads - 1) / threads;
        chunk_sums_kernel<<<blocks, threads>>>(sums, values, n);
        CUDA_CHECK(cudaGetLastError());
        scan(sums, chunks(n), level + 1);
        scan_chunks_kernel<<<blocks, threads>>>(values, sums, n);
        CUDA_CHECK(cudaGetLastError());
    }

    std::vector<course::DeviceBuffer<std::uint32_t>> levels_;
};
//! [exclusive_scan]

}  // namespace grid
