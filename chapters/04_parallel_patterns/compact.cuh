/// @file
/// Stream compaction: keeps the elements that somebody wants, without gaps. Here those are the ones that are
/// not 0: the living among the particles, the occupied among the cells.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <vector>

#include "04_parallel_patterns/scan.cuh"

namespace patterns {

/// CPU reference: keeps the order.
inline std::vector<std::uint32_t> compact_cpu(const std::vector<std::uint32_t>& values) {
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t value : values)
        if (value != 0) kept.push_back(value);
    return kept;
}

//! [compact_atomic]
/// One thread per element: who is kept draws the next free place. The order of the kept is a matter of luck.
/// @param count  starts at 0 and ends as the number of kept elements, here and in the kernels below
inline __global__ void compact_atomic_kernel(std::uint32_t* kept, std::uint32_t* count,
                                             const std::uint32_t* values, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const std::uint32_t value = values[i];
    if (value != 0) kept[atomicAdd(count, 1u)] = value;
}
//! [compact_atomic]

//! [compact_shared]
/// Only the difference: places are drawn inside the block, in shared memory; one thread draws as many in
/// global memory.
inline __global__ void compact_shared_kernel(std::uint32_t* kept, std::uint32_t* count,
                                             const std::uint32_t* values, std::uint32_t n) {
    __shared__ std::uint32_t block_count, block_first;
    if (threadIdx.x == 0) block_count = 0;
    __syncthreads();
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    std::uint32_t value = 0, place = 0;
    if (i < n) value = values[i];
    if (value != 0) place = atomicAdd(&block_count, 1u);
    __syncthreads();
    if (threadIdx.x == 0) block_first = atomicAdd(count, block_count);
    __syncthreads();
    if (value != 0) kept[block_first + place] = value;
}
//! [compact_shared]

//! [compact_warp]
/// Only the difference: a vote tells every lane who else of its warp is kept, so its place is the number of
/// kept lanes below. One atomic per warp, no shared memory and no barrier.
inline __global__ void compact_warp_kernel(std::uint32_t* kept, std::uint32_t* count,
                                           const std::uint32_t* values, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x, lane = threadIdx.x % kWarp;
    std::uint32_t value = 0, first = 0;
    if (i < n) value = values[i];
    const unsigned keepers = __ballot_sync(kAllLanes, value != 0);  // a bit for each lane
    if (lane == 0) first = atomicAdd(count, __popc(keepers));
    first = __shfl_sync(kAllLanes, first, 0);
    if (value != 0) kept[first + __popc(keepers & ((1u << lane) - 1))] = value;
}
//! [compact_warp]

//! [compact_scan]
/// One thread per element: 1 for those that are kept.
inline __global__ void flag_kernel(std::uint32_t* flag, const std::uint32_t* values, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) flag[i] = values[i] != 0;
}

/// Only the difference: nobody draws. Scanned flags are places, so the order is kept and luck plays no part.
inline __global__ void compact_scan_kernel(std::uint32_t* kept, std::uint32_t* count,
                                           const std::uint32_t* values, const std::uint32_t* place,
                                           std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const std::uint32_t value = values[i], mine = place[i];
    if (value != 0) kept[mine] = value;
    if (i == n - 1) *count = mine + (value != 0);
}
//! [compact_scan]

enum class CompactMethod { atomic, shared, warp, scan };

/// Compacts up to `max_n` elements, again and again, in memory made once.
class Compaction {
  public:
    Compaction(CompactMethod method, std::uint32_t max_n)
        : method_(method),
          kept_(max_n),
          count_(1),
          place_(method == CompactMethod::scan ? max_n : 0),
          scan_(method == CompactMethod::scan ? max_n : 0) {}

    void operator()(const std::uint32_t* values, std::uint32_t n) {
        CUDA_CHECK(cudaMemset(count_.data(), 0, sizeof(std::uint32_t)));
        if (n == 0) return;
        const std::uint32_t blocks = blocks_for(n);
        switch (method_) {
            case CompactMethod::atomic:
                compact_atomic_kernel<<<blocks, kThreads>>>(kept_.data(), count_.data(), values, n);
                break;
            case CompactMethod::shared:
                compact_shared_kernel<<<blocks, kThreads>>>(kept_.data(), count_.data(), values, n);
                break;
            case CompactMethod::warp:
                compact_warp_kernel<<<blocks, kThreads>>>(kept_.data(), count_.data(), values, n);
                break;
            case CompactMethod::scan:
                flag_kernel<<<blocks, kThreads>>>(place_.data(), values, n);
                CUDA_CHECK(cudaGetLastError());
                scan_(place_.data(), n);
                compact_scan_kernel<<<blocks, kThreads>>>(kept_.data(), count_.data(), values, place_.data(),
                                                          n);
                break;
        }
        CUDA_CHECK(cudaGetLastError());
    }
    /// What was kept, copied to the host.
    std::vector<std::uint32_t> download() const {
        std::vector<std::uint32_t> kept = kept_.download();
        kept.resize(count_.download()[0]);
        return kept;
    }

  private:
    CompactMethod method_;
    course::DeviceBuffer<std::uint32_t> kept_, count_, place_;
    ExclusiveScan scan_;
};

}  // namespace patterns
