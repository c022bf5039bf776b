// The patterns of parallel programming that need threads to meet: reduction, scan, histogram, shuffle. All in
// integers, so that any order of additions gives the same result and comparisons are exact.
#include <cuda_runtime.h>

#include <numeric>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

constexpr unsigned kAllLanes = 0xffffffffu;
constexpr int kBlockSizes[] = {1, 31, 32, 33, 256, 1024};
constexpr int kLengths[] = {1, 1000, 4096, 10007};

std::vector<int> test_data(int n) {
    std::vector<int> values(n);
    for (int i = 0; i < n; ++i) values[i] = (i * 37) % 101 - 20;
    return values;
}

int blocks_for(int n, int block) {
    return (n + block - 1) / block;
}

/// Sum of each block's values, in dynamic shared memory. Halves what is left until one value is; works for
/// any block size.
__global__ void block_sums_kernel(int* sums, const int* values, int n) {
    extern __shared__ int partial[];
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    partial[threadIdx.x] = i < n ? values[i] : 0;
    for (unsigned left = blockDim.x; left > 1; left = (left + 1) / 2) {
        __syncthreads();
        const unsigned half = (left + 1) / 2;
        if (threadIdx.x < left / 2) partial[threadIdx.x] += partial[threadIdx.x + half];
    }
    if (threadIdx.x == 0) sums[blockIdx.x] = partial[0];
}

/// Inclusive prefix sum of each block's values (Hillis and Steele), between two halves of shared memory.
__global__ void block_scan_kernel(int* sums, const int* values, int n) {
    __shared__ int buffer[2][1024];
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    const unsigned t = threadIdx.x;
    int from = 0;
    buffer[from][t] = i < n ? values[i] : 0;
    for (unsigned step = 1; step < blockDim.x; step *= 2) {
        __syncthreads();
        buffer[1 - from][t] = buffer[from][t] + (t >= step ? buffer[from][t - step] : 0);
        from = 1 - from;
    }
    if (i < n) sums[i] = buffer[from][t];
}

constexpr int kBins = 64;

/// Each block counts in shared memory, then adds its counts to the whole.
__global__ void histogram_kernel(unsigned* counts, const int* values, int n) {
    __shared__ unsigned mine[kBins];
    for (int bin = threadIdx.x; bin < kBins; bin += blockDim.x) mine[bin] = 0;
    __syncthreads();
    for (int i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x)
        atomicAdd(&mine[(values[i] + kBins) % kBins], 1u);
    __syncthreads();
    for (int bin = threadIdx.x; bin < kBins; bin += blockDim.x) atomicAdd(&counts[bin], mine[bin]);
}

/// Sum over the lanes of a warp; lanes of threads that do not exist bring nothing.
__device__ int warp_sum(int value, int lanes) {
    const int lane = threadIdx.x % 32;
    for (int offset = 16; offset > 0; offset /= 2) {
        const int other = __shfl_down_sync(kAllLanes, value, offset);
        if (lane + offset < lanes) value += other;
    }
    return value;
}

/// Sum of all values: shuffles within a warp, shared memory between warps, an atomic between blocks.
__global__ void shuffle_sum_kernel(int* sum, const int* values, int n) {
    __shared__ int warp_sums[32];
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    const int warp = threadIdx.x / 32, warps = (blockDim.x + 31) / 32;
    const int lanes = min(32, static_cast<int>(blockDim.x) - warp * 32);
    const int mine = warp_sum(i < n ? values[i] : 0, lanes);
    if (threadIdx.x % 32 == 0) warp_sums[warp] = mine;
    __syncthreads();
    if (threadIdx.x != 0) return;
    int block_sum = 0;
    for (int w = 0; w < warps; ++w) block_sum += warp_sums[w];
    atomicAdd(sum, block_sum);
}

}  // namespace

TEST_CASE("reduction: block sums for many block sizes and lengths") {
    for (const int block : kBlockSizes)
        for (const int n : kLengths) {
            CAPTURE(block);
            CAPTURE(n);
            const std::vector<int> values = test_data(n);
            const int blocks = blocks_for(n, block);
            const DeviceBuffer<int> on_device(values);
            DeviceBuffer<int> sums(blocks);
            block_sums_kernel<<<blocks, block, block * sizeof(int)>>>(sums.data(), on_device.data(), n);
            CUDA_CHECK(cudaGetLastError());
            std::vector<int> expected(blocks, 0);
            for (int i = 0; i < n; ++i) expected[i / block] += values[i];
            course::check_equal(sums.download(), expected, "sum", "block");
        }
}

TEST_CASE("scan: prefix sums of each block") {
    for (const int block : kBlockSizes)
        for (const int n : kLengths) {
            CAPTURE(block);
            CAPTURE(n);
            const std::vector<int> values = test_data(n);
            const DeviceBuffer<int> on_device(values);
            DeviceBuffer<int> sums(n);
            block_scan_kernel<<<blocks_for(n, block), block>>>(sums.data(), on_device.data(), n);
            CUDA_CHECK(cudaGetLastError());
            std::vector<int> expected(n);
            for (int i = 0; i < n; ++i) expected[i] = values[i] + (i % block ? expected[i - 1] : 0);
            course::check_equal(sums.download(), expected, "prefix sum", "element");
        }
}

TEST_CASE("histogram: shared and global atomics") {
    for (const int block : kBlockSizes)
        for (const int n : kLengths) {
            CAPTURE(block);
            CAPTURE(n);
            const std::vector<int> values = test_data(n);
            const DeviceBuffer<int> on_device(values);
            DeviceBuffer<unsigned> counts(kBins);
            CUDA_CHECK(cudaMemset(counts.data(), 0, counts.bytes()));
            histogram_kernel<<<7, block>>>(counts.data(), on_device.data(), n);
            CUDA_CHECK(cudaGetLastError());
            std::vector<unsigned> expected(kBins, 0);
            for (const int value : values) ++expected[(value + kBins) % kBins];
            course::check_equal(counts.download(), expected, "count", "bin");
        }
}

TEST_CASE("shuffle: sum of everything") {
    for (const int block : kBlockSizes)
        for (const int n : kLengths) {
            CAPTURE(block);
            CAPTURE(n);
            const std::vector<int> values = test_data(n);
            const DeviceBuffer<int> on_device(values);
            DeviceBuffer<int> sum(1);
            CUDA_CHECK(cudaMemset(sum.data(), 0, sum.bytes()));
            shuffle_sum_kernel<<<blocks_for(n, block), block>>>(sum.data(), on_device.data(), n);
            CUDA_CHECK(cudaGetLastError());
            CHECK(sum.download()[0] == std::accumulate(values.begin(), values.end(), 0));
        }
}
