// The simulator counts what a kernel's source says: each case was counted by hand.
#include <cuda_runtime.h>

#include "common/cuda_check.h"
#include "common/cudasim/cudasim.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;
using cudasim::Counts;

namespace {

__global__ void copy_kernel(float* to, const float* from, unsigned n) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) to[i] = from[i];
}

/// Load, work, store: a float4 is one access of 16 bytes.
__global__ void double_kernel(float4* values, unsigned n) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    float4 v = values[i];
    v.x *= 2;
    v.y *= 2;
    values[i] = v;
}

/// A kernel's own variables, also arrays, are no memory accesses of the launch.
__global__ void own_variables_kernel(int* out) {
    int table[16];
    for (int k = 0; k < 16; ++k) table[k] = k * int(threadIdx.x);
    int sum = 0;
    for (const int value : table) sum += value;
    out[threadIdx.x] += sum;
}

__global__ void reverse_kernel(int* values) {
    __shared__ int tile[64];
    tile[threadIdx.x] = values[threadIdx.x];
    __syncthreads();
    values[threadIdx.x] = tile[63 - threadIdx.x];
}

__global__ void reverse_dynamic_kernel(int* values) {
    extern __shared__ int tile[];
    tile[threadIdx.x] = values[threadIdx.x];
    __syncthreads();
    values[threadIdx.x] = tile[blockDim.x - 1 - threadIdx.x];
}

__global__ void atomics_kernel(unsigned* integer, float* real) {
    __shared__ unsigned mine;
    if (threadIdx.x == 0) mine = 0;
    __syncthreads();
    atomicAdd(&mine, 1u);
    atomicMin(integer, 7u);
    atomicCAS(integer, 7u, 8u);
    atomicAdd(real, 1.0f);
    __syncthreads();
    if (threadIdx.x == 0) atomicOr(integer, mine);
}

__global__ void shuffle_kernel(int* sums, const int* values) {
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    int sum = values[i];
    for (int offset = 16; offset > 0; offset /= 2) sum += __shfl_down_sync(0xffffffffu, sum, offset);
    if (threadIdx.x % 32 == 0) sums[i / 32] = sum;
}

__device__ float sum_of(float4 v) {
    return v.x + v.y + v.z + v.w;
}

__global__ void sum_kernel(float* sums, const float4* values) {
    const float4 loaded = values[threadIdx.x];
    sums[threadIdx.x] = sum_of(loaded) + sum_of(values[threadIdx.x]);
}

void check(const Counts& got, const Counts& expected) {
    CHECK(got.global_loads == expected.global_loads);
    CHECK(got.global_stores == expected.global_stores);
    CHECK(got.global_bytes == expected.global_bytes);
    CHECK(got.shared_loads == expected.shared_loads);
    CHECK(got.shared_stores == expected.shared_stores);
    CHECK(got.global_atomics == expected.global_atomics);
    CHECK(got.shared_atomics == expected.shared_atomics);
    CHECK(got.barriers == expected.barriers);
    CHECK(got.warp_operations == expected.warp_operations);
}

/// What the last launch of `work` did.
template <class Work>
Counts counts_of(Work work) {
    const cudasim::Recording log;
    work();
    CUDA_CHECK(cudaGetLastError());
    return log.launches().back().counts;
}

}  // namespace

TEST_CASE("a copy of n elements: n loads, n stores, whatever the block size") {
    for (const unsigned block : {1u, 32u, 100u, 256u}) {
        CAPTURE(block);
        DeviceBuffer<float> to(1000), from(std::vector<float>(1000, 1.0f));
        const Counts counts = counts_of(
            [&] { copy_kernel<<<(1000 + block - 1) / block, block>>>(to.data(), from.data(), 1000); });
        check(counts, {1000, 1000, 8000, 0, 0, 0, 0, 0, 0});
    }
}

TEST_CASE("a float4 is one load and one store of 16 bytes") {
    DeviceBuffer<float4> values(std::vector<float4>(77));
    check(counts_of([&] { double_kernel<<<2, 64>>>(values.data(), 77); }),
          {77, 77, 2 * 77 * 16, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("a kernel's own variables are not counted, and += is a load and a store") {
    DeviceBuffer<int> out(std::vector<int>(64, 0));
    check(counts_of([&] { own_variables_kernel<<<1, 64>>>(out.data()); }), {64, 64, 512, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("shared memory and barriers, static and dynamic") {
    DeviceBuffer<int> values(std::vector<int>(64, 3));
    check(counts_of([&] { reverse_kernel<<<1, 64>>>(values.data()); }), {64, 64, 512, 64, 64, 0, 0, 1, 0});
    check(counts_of([&] { reverse_dynamic_kernel<<<1, 64, 64 * sizeof(int)>>>(values.data()); }),
          {64, 64, 512, 64, 64, 0, 0, 1, 0});
}

TEST_CASE("an atomic counts once, also where the CPU needs a loop for it") {
    DeviceBuffer<unsigned> integer(std::vector<unsigned>{9});
    DeviceBuffer<float> real(std::vector<float>{0});
    // 3 blocks of 32: each thread 3 atomics in global memory and 1 in shared, each block 1 global one more.
    check(counts_of([&] { atomics_kernel<<<3, 32>>>(integer.data(), real.data()); }),
          {0, 0, 0, 3, 3, 3 * 32 * 3 + 3, 3 * 32, 6, 0});
    CHECK(real.download()[0] == 96);
    CHECK(integer.download()[0] == (8u | 32u));
}

TEST_CASE("a shuffle counts once for its warp") {
    DeviceBuffer<int> sums(6), values(std::vector<int>(192, 1));
    check(counts_of([&] { shuffle_kernel<<<2, 96>>>(sums.data(), values.data()); }),
          {192, 6, 4 * 198, 0, 0, 0, 0, 0, 6 * 5});
    course::check_equal(sums.download(), std::vector<int>(6, 32), "sum", "warp");
}

TEST_CASE("counts belong to their launch, on any number of workers and in any order") {
    DeviceBuffer<float> to(5000), from(std::vector<float>(5000, 1.0f));
    for (const unsigned workers : {1u, 2u, 5u}) {
        const cudasim::WorkerScope scope(workers);
        const cudasim::OrderScope order({cudasim::Order::kShuffled, workers});
        const cudasim::Recording log;
        copy_kernel<<<40, 128>>>(to.data(), from.data(), 5000);
        copy_kernel<<<1, 128>>>(to.data(), from.data(), 100);
        check(log.launches()[0].counts, {5000, 5000, 40000, 0, 0, 0, 0, 0, 0});
        check(log.launches()[1].counts, {100, 100, 800, 0, 0, 0, 0, 0, 0});
        CHECK(log.counts().global_loads == 5100);
    }
}

TEST_CASE("host code is not counted") {
    DeviceBuffer<float> to(10), from(std::vector<float>(10, 1.0f));
    const Counts counts = counts_of([&] {
        copy_kernel<<<1, 10>>>(to.data(), from.data(), 10);
        to.upload(from.download());
    });
    check(counts, {10, 10, 80, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("what is not seen: a structure that goes from memory straight into a function") {
    DeviceBuffer<float4> values(std::vector<float4>(32));
    DeviceBuffer<float> sums(32);
    const Counts counts = counts_of([&] { sum_kernel<<<1, 32>>>(sums.data(), values.data()); });
    CHECK(counts.global_loads == 32);  // of 64: the README says how to write it instead
    CHECK(counts.global_stores == 32);
}
