// Shared memory that nobody wrote reads as NaN, in every block, and each worker has its own.
#include <cmath>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/cudasim/simulator.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

/// Reads before it writes; what it writes must not be there for the next block.
__global__ void read_then_write_kernel(float* seen) {
    __shared__ float tile[32];
    seen[blockIdx.x * 32 + threadIdx.x] = tile[threadIdx.x];
    __syncthreads();
    tile[threadIdx.x] = 1.0f;
    __syncthreads();
}

__global__ void read_dynamic_kernel(float* seen) {
    extern __shared__ float tile[];
    seen[blockIdx.x * 32 + threadIdx.x] = tile[threadIdx.x];
    __syncthreads();
    tile[threadIdx.x] = 1.0f;
}

__device__ float sum_in_shared(float value) {
    __shared__ float slots[32];
    slots[threadIdx.x] = value;
    __syncthreads();
    float sum = 0;
    for (const float slot : slots) sum += slot;
    __syncthreads();
    return sum;
}

/// The same declaration is reached twice in a block: the second time nothing may be lost.
__global__ void reached_twice_kernel(float* sums) {
    const float once = sum_in_shared(1.0f);
    const float twice = sum_in_shared(once);
    sums[blockIdx.x * 32 + threadIdx.x] = twice;
}

}  // namespace

TEST_CASE("static shared memory starts as NaN in every block") {
    DeviceBuffer<float> seen(40 * 32);
    read_then_write_kernel<<<40, 32>>>(seen.data());
    CUDA_CHECK(cudaGetLastError());
    for (const float value : seen.download()) CHECK(std::isnan(value));
}

TEST_CASE("dynamic shared memory starts as NaN in every block") {
    DeviceBuffer<float> seen(40 * 32);
    read_dynamic_kernel<<<40, 32, 32 * sizeof(float)>>>(seen.data());
    CUDA_CHECK(cudaGetLastError());
    for (const float value : seen.download()) CHECK(std::isnan(value));
}

TEST_CASE("shared memory keeps its values within a block") {
    DeviceBuffer<float> sums(40 * 32);
    reached_twice_kernel<<<40, 32>>>(sums.data());
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(sums.download(), std::vector<float>(40 * 32, 1024.0f), "sum", "thread");
}
