// All the ways in which a launch may be written.
#include "tests/cudasim/launches.cuh"

#include <cstddef>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/cudasim/simulator.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

struct Offset {
    int value;
    bool negative;
};

__global__ void fill_kernel(int* values, int n, int value) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] = value;
}
template <class T>
__global__ void add_kernel(T* values, T value, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] += value;
}
template <bool kTwice>
__global__ void increment_kernel(int* values) {
    values[threadIdx.x] += kTwice ? 2 : 1;
}
__global__ void optional_kernel(int* values, const int* extra, Offset offset) {
    values[threadIdx.x] =
        (extra ? extra[threadIdx.x] : 1000) + (offset.negative ? -offset.value : offset.value);
}
__global__ void overloaded_kernel(int* values) {
    values[threadIdx.x] = 1;
}
__global__ void overloaded_kernel(float* values) {
    values[threadIdx.x] = 2.5f;
}
__global__ void dynamic_kernel(double* values) {
    extern __shared__ __align__(16) double mine[];
    mine[threadIdx.x] = 0.5 * threadIdx.x;
    __syncthreads();
    values[threadIdx.x] = mine[blockDim.x - 1 - threadIdx.x];
}
// clang-format off
__global__ void shared_forms_kernel(int* values) {
    __shared__ int first[64], second[64];
    static __shared__ float4 vectors[2][64];
    __shared__ int
        single;  // over two lines
    volatile __shared__ int watched[64];
    const unsigned t = threadIdx.x;
    first[t] = static_cast<int>(t);
    second[t] = 2 * static_cast<int>(t);
    vectors[1][t] = make_float4(1, 2, 3, 4);
    watched[t] = 5;
    if (t == 0) single = 100;
    __syncthreads();
    values[blockIdx.x * 64 + t] = first[63 - t] + second[t] + static_cast<int>(vectors[1][t].w) + single + watched[63 - t];
}
// clang-format on

__constant__ float coefficients[4];
__device__ int counter;
__global__ void symbols_kernel(float* sums) {
    sums[threadIdx.x] = coefficients[0] + coefficients[3];
    atomicAdd(&counter, 1);
}

}  // namespace

// clang-format off: these forms are what is tested.
TEST_CASE("launches: plain, over several lines, with dim3, shared memory and stream") {
    DeviceBuffer<int> values(100);
    fill_kernel<<<4, 32>>>(values.data(), 100, 7);
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(100, 7), "value", "element");
    fill_kernel<<<dim3(4),  // a comment with >>> in it
                  dim3(32, 1), 0, nullptr>>>(values.data(), 100, 8);
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(100, 8), "value", "element");
    const dim3 grid(4), block(32);
    cudaStream_t stream;
    CUDA_CHECK(cudaStreamCreate(&stream));
    fill_kernel<<<grid, block, 0, stream>>>(values.data(), 100, (1 << 3) >> 1);
    CUDA_CHECK(cudaStreamSynchronize(stream));
    CUDA_CHECK(cudaStreamDestroy(stream));
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(100, 4), "value", "element");
}
// clang-format on

TEST_CASE("launches: templates, given and deduced, in a namespace and in a header") {
    DeviceBuffer<int> values(std::vector<int>(64, 1));
    add_kernel<<<2, 32>>>(values.data(), 4, 64);
    add_kernel<int><<<2, 32>>>(values.data(), 5, 64);
    increment_kernel<(sizeof(int) > 2)><<<1, 64>>>(values.data());
    increment_kernel<false><<<1, 64>>>(values.data());
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(64, 13), "value", "element");
    ::launch_forms::inner::scale_kernel<int, -1><<<2, 32>>>(values.data(), 64);
    launch_forms::inner::scale_by_six(values.data(), 64);
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(64, -78), "value", "element");
}

TEST_CASE("launches: NULL, nullptr, braces and conversions as arguments") {
    DeviceBuffer<int> values(8);
    optional_kernel<<<1, 8>>>(values.data(), NULL, {5, true});
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(8, 995), "value", "element");
    optional_kernel<<<1, 8>>>(values.data(), nullptr, Offset{6, false});
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(8, 1006), "value", "element");
    const unsigned long n = 8;
    fill_kernel<<<1, 8>>>(values.data(), n, 2.9f);  // converted as in any call
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(values.download(), std::vector<int>(8, 2), "value", "element");
}

TEST_CASE("launches: overloaded kernels, and a kernel chosen at run time") {
    DeviceBuffer<int> integers(8);
    DeviceBuffer<float> floats(8);
    overloaded_kernel<<<1, 8>>>(integers.data());
    overloaded_kernel<<<1, 8>>>(floats.data());
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(integers.download(), std::vector<int>(8, 1), "value", "element");
    course::check_equal(floats.download(), std::vector<float>(8, 2.5f), "value", "element");
    const auto kernel = &increment_kernel<true>;
    kernel<<<1, 8>>>(integers.data());
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(integers.download(), std::vector<int>(8, 3), "value", "element");
}

TEST_CASE("shared memory: dynamic and in all forms of declaration") {
    DeviceBuffer<double> reversed(64);
    dynamic_kernel<<<1, 64, 64 * sizeof(double)>>>(reversed.data());
    CUDA_CHECK(cudaGetLastError());
    std::vector<double> expected_reversed(64);
    for (int t = 0; t < 64; ++t) expected_reversed[t] = 0.5 * (63 - t);
    course::check_equal(reversed.download(), expected_reversed, "value", "thread");

    DeviceBuffer<int> sums(3 * 64);
    shared_forms_kernel<<<3, 64>>>(sums.data());
    CUDA_CHECK(cudaGetLastError());
    std::vector<int> expected(3 * 64);
    for (int i = 0; i < 3 * 64; ++i) expected[i] = 63 - i % 64 + 2 * (i % 64) + 4 + 100 + 5;
    course::check_equal(sums.download(), expected, "sum", "thread");
}

TEST_CASE("constant and device variables") {
    const float host[4] = {1, 2, 3, 4};
    const int zero = 0;
    CUDA_CHECK(cudaMemcpyToSymbol(coefficients, host, sizeof host));
    CUDA_CHECK(cudaMemcpyToSymbol(coefficients, host, sizeof(float), 3 * sizeof(float)));
    CUDA_CHECK(cudaMemcpyToSymbol(counter, &zero, sizeof zero));
    DeviceBuffer<float> sums(32);
    symbols_kernel<<<1, 32>>>(sums.data());
    CUDA_CHECK(cudaGetLastError());
    course::check_equal(sums.download(), std::vector<float>(32, 2), "sum", "thread");
    int count = 0;
    CUDA_CHECK(cudaMemcpyFromSymbol(&count, counter, sizeof count));
    CHECK(count == 32);
    CHECK(cudaMemcpyToSymbol(coefficients, host, sizeof host, sizeof(float)) == cudaErrorInvalidValue);
    cudaGetLastError();
}

#ifdef __CUDASIM__
TEST_CASE("recording: launches by name, allocations and bytes") {
    DeviceBuffer<int> before(10);
    const std::size_t live_before = cudasim::live_bytes(), allocations_before = cudasim::live_allocations();
    const cudasim::Recording recording;
    {
        DeviceBuffer<int> values(64), more(36);
        CHECK(cudasim::live_bytes() == live_before + 400);
        CHECK(cudasim::live_allocations() == allocations_before + 2);
        fill_kernel<<<dim3(2, 1), 32>>>(values.data(), 64, 0);
        increment_kernel<true><<<1, 64>>>(values.data());
        increment_kernel<false><<<1, 64>>>(values.data());
        launch_forms::inner::scale_by_six(values.data(), 64);
        dynamic_kernel<<<1, 4, 32>>>(reinterpret_cast<double*>(values.data()));
        fill_kernel<<<1, 2048>>>(values.data(), 64, 0);  // fails: not recorded
        CHECK(cudaGetLastError() == cudaErrorInvalidConfiguration);
    }
    CHECK(recording.allocations() == 2);
    CHECK(recording.bytes() == 400);
    CHECK(cudasim::live_bytes() == live_before);
    REQUIRE(recording.launches().size() == 6);
    CHECK(recording.launches()[0].kernel == "fill_kernel");
    CHECK(recording.launches()[0].grid.x == 2);
    CHECK(recording.launches()[0].block.x == 32);
    CHECK(recording.launches()[1].kernel == "increment_kernel<true>");
    CHECK(recording.launches()[3].kernel == "scale_kernel<T, 2>");
    CHECK(recording.launches()[5].shared_bytes == 32);
    CHECK(recording.count("increment_kernel") == 2);
    CHECK(recording.count("increment_kernel<true>") == 1);
    CHECK(recording.count("kernel") == 0);
}
#endif
