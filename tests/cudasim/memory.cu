// Memory calls, their error codes, events and device queries.
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/cudasim/simulator.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

/// Checks the code, and that cudaGetLastError has it too, once.
void check_error(cudaError_t got, cudaError_t expected, const char* what) {
    INFO(what);
    CHECK(std::string(cudaGetErrorName(got)) == cudaGetErrorName(expected));
    CHECK(cudaPeekAtLastError() == expected);
    CHECK(cudaGetLastError() == expected);
    CHECK(cudaGetLastError() == cudaSuccess);
}

__global__ void copy_kernel(float* to, const float* from, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) to[i] = from[i];
}

}  // namespace

TEST_CASE("memory: round trips in all directions") {
    const std::vector<float> values = {1, 2, 3, 4};
    const std::size_t bytes = 4 * sizeof(float);
    DeviceBuffer<float> a(4), b(4);
    std::vector<float> back(4), host(4);
    CUDA_CHECK(cudaMemcpy(a.data(), values.data(), bytes, cudaMemcpyHostToDevice));
    CUDA_CHECK(cudaMemcpy(b.data(), a.data(), bytes, cudaMemcpyDeviceToDevice));
    CUDA_CHECK(cudaMemcpyAsync(back.data(), b.data(), bytes, cudaMemcpyDeviceToHost, nullptr));
    CUDA_CHECK(cudaDeviceSynchronize());
    CHECK(back == values);
    CUDA_CHECK(cudaMemcpy(host.data(), back.data(), bytes, cudaMemcpyHostToHost));
    CHECK(host == values);
    CUDA_CHECK(cudaMemcpy(host.data(), a.data() + 1, 2 * sizeof(float), cudaMemcpyDefault));
    CHECK(host == std::vector<float>{2, 3, 3, 4});
    CUDA_CHECK(cudaMemset(a.data(), 0, 2 * sizeof(float)));
    CHECK(a.download() == std::vector<float>{0, 0, 3, 4});
}

TEST_CASE("memory: alignment, and pinned host memory in kernels") {
    float* odd = nullptr;
    DeviceBuffer<float> device(3);
    CUDA_CHECK(cudaMalloc(&odd, 13));
    CHECK(reinterpret_cast<std::uintptr_t>(odd) % 256 == 0);
    CUDA_CHECK(cudaFree(odd));
    float* pinned = nullptr;
    CUDA_CHECK(cudaMallocHost(&pinned, 3 * sizeof(float)));
    for (int i = 0; i < 3; ++i) pinned[i] = 1.5f * i;
    copy_kernel<<<1, 3>>>(device.data(), pinned, 3);
    CUDA_CHECK(cudaGetLastError());
    CHECK(device.download() == std::vector<float>{0, 1.5f, 3});
    CUDA_CHECK(cudaMemcpy(pinned, device.data(), 3 * sizeof(float), cudaMemcpyDeviceToHost));
    CUDA_CHECK(cudaFreeHost(pinned));
}

TEST_CASE("memory: wrong calls get CUDA's codes") {
    DeviceBuffer<char> device(1000);
    std::vector<char> host(2000);
    char* const inside = device.data() + 10;
    check_error(cudaMemcpy(device.data(), host.data(), 1001, cudaMemcpyHostToDevice), cudaErrorInvalidValue,
                "one byte too many");
    check_error(cudaMemcpy(inside, host.data(), 991, cudaMemcpyHostToDevice), cudaErrorInvalidValue,
                "too many from the inside");
    check_error(cudaMemset(inside, 0, 991), cudaErrorInvalidValue, "cudaMemset over the end");
    check_error(cudaFree(inside), cudaErrorInvalidValue, "cudaFree of the inside");
    char* freed = nullptr;
    CUDA_CHECK(cudaMalloc(&freed, 10));
    CUDA_CHECK(cudaFree(freed));
    check_error(cudaFree(freed), cudaErrorInvalidValue, "cudaFree twice");
    CUDA_CHECK(cudaFree(nullptr));
    char* far_too_large = reinterpret_cast<char*>(1);
    check_error(cudaMalloc(&far_too_large, std::size_t{1} << 40), cudaErrorMemoryAllocation, "a tebibyte");
    std::size_t free_bytes = 0, total_bytes = 0;
    CUDA_CHECK(cudaMemGetInfo(&free_bytes, &total_bytes));
    CHECK(free_bytes > 0);
    CHECK(free_bytes <= total_bytes);
    check_error(cudaMalloc(&far_too_large, total_bytes + 1), cudaErrorMemoryAllocation, "more than there is");
    CUDA_CHECK(cudaMemcpy(nullptr, nullptr, 0, cudaMemcpyHostToDevice));
}

TEST_CASE("events take the time") {
    cudaEvent_t start, stop, never;
    CUDA_CHECK(cudaEventCreate(&start));
    CUDA_CHECK(cudaEventCreate(&stop));
    CUDA_CHECK(cudaEventCreate(&never));
    DeviceBuffer<float> a(1 << 16), b(1 << 16);
    CUDA_CHECK(cudaMemset(a.data(), 0, a.bytes()));
    CUDA_CHECK(cudaEventRecord(start));
    copy_kernel<<<256, 256>>>(b.data(), a.data(), 1 << 16);
    CUDA_CHECK(cudaEventRecord(stop));
    CUDA_CHECK(cudaEventSynchronize(stop));
    float milliseconds = -1;
    CUDA_CHECK(cudaEventElapsedTime(&milliseconds, start, stop));
    CHECK(milliseconds > 0);
    CHECK(milliseconds < 60e3f);
    check_error(cudaEventElapsedTime(&milliseconds, start, never), cudaErrorInvalidResourceHandle,
                "never recorded");
    CUDA_CHECK(cudaEventDestroy(start));
    CUDA_CHECK(cudaEventDestroy(stop));
    CUDA_CHECK(cudaEventDestroy(never));
}

TEST_CASE("the device and its limits") {
    int count = 0, device = -1;
    CUDA_CHECK(cudaGetDeviceCount(&count));
    CHECK(count >= 1);
    CUDA_CHECK(cudaSetDevice(0));
    CUDA_CHECK(cudaGetDevice(&device));
    CHECK(device == 0);
    cudaDeviceProp properties;
    CUDA_CHECK(cudaGetDeviceProperties(&properties, 0));
    CHECK(properties.warpSize == 32);
    CHECK(properties.maxThreadsPerBlock == 1024);
    CHECK(properties.sharedMemPerBlock == 48 * 1024);
    CHECK(properties.totalGlobalMem > 0);
    check_error(cudaSetDevice(count), cudaErrorInvalidDevice, "no such device");
    CHECK(std::string(cudaGetErrorString(cudaErrorMemoryAllocation)) == "out of memory");
}

TEST_CASE("launch configurations that no device takes") {
    DeviceBuffer<float> a(1), b(1);
    struct Launch {
        dim3 grid, block;
        std::size_t shared_bytes;
        cudaError_t expected;
    };
    const Launch launches[] = {
        {dim3(1), dim3(1025), 0, cudaErrorInvalidConfiguration},
        {dim3(1), dim3(0), 0, cudaErrorInvalidConfiguration},
        {dim3(0), dim3(32), 0, cudaErrorInvalidConfiguration},
        {dim3(1), dim3(33, 32), 0, cudaErrorInvalidConfiguration},
        {dim3(1), dim3(1, 1, 65), 0, cudaErrorInvalidConfiguration},
        {dim3(1, 65536), dim3(1), 0, cudaErrorInvalidConfiguration},
        {dim3(1, 1, 65536), dim3(1), 0, cudaErrorInvalidConfiguration},
        {dim3(1), dim3(32), 1 << 20, cudaErrorInvalidValue},
    };
    CUDA_CHECK(cudaMemset(a.data(), 0, a.bytes()));
    for (const Launch& launch : launches) {
        CAPTURE(launch.block.x);
        copy_kernel<<<launch.grid, launch.block, launch.shared_bytes>>>(b.data(), a.data(), 1);
        CHECK(cudaGetLastError() == launch.expected);
        CHECK(cudaDeviceSynchronize() == cudaSuccess);  // no kernel ran, so none failed
    }
    copy_kernel<<<1, 1024, 48 * 1024>>>(b.data(), a.data(), 1);
    CHECK(cudaGetLastError() == cudaSuccess);
    CHECK(b.download()[0] == 0);
}

#ifdef __CUDASIM__
TEST_CASE("memory: copies in the wrong direction") {
    DeviceBuffer<char> device(100);
    std::vector<char> host(100);
    const auto copy = [](void* to, const void* from, cudaMemcpyKind kind) {
        return cudaMemcpy(to, from, 100, kind);
    };
    for (const cudaMemcpyKind kind : {cudaMemcpyHostToHost, cudaMemcpyDeviceToHost, cudaMemcpyDeviceToDevice})
        check_error(copy(device.data(), host.data(), kind), cudaErrorInvalidValue, "host to device");
    for (const cudaMemcpyKind kind : {cudaMemcpyHostToHost, cudaMemcpyHostToDevice, cudaMemcpyDeviceToDevice})
        check_error(copy(host.data(), device.data(), kind), cudaErrorInvalidValue, "device to host");
    check_error(copy(device.data(), host.data(), static_cast<cudaMemcpyKind>(7)),
                cudaErrorInvalidMemcpyDirection, "no kind");
    check_error(cudaMemset(host.data(), 0, 100), cudaErrorInvalidValue, "cudaMemset of host memory");
    check_error(cudaFree(host.data()), cudaErrorInvalidValue, "cudaFree of host memory");
    check_error(cudaFreeHost(device.data()), cudaErrorInvalidValue, "cudaFreeHost of device memory");
}

TEST_CASE("a host pointer as a kernel's argument is refused") {
    DeviceBuffer<float> device(4);
    std::vector<float> host(4);
    copy_kernel<<<1, 4>>>(device.data(), host.data(), 4);
    CHECK(cudaGetLastError() == cudaErrorIllegalAddress);
    copy_kernel<<<1, 4>>>(device.data(), device.data() + 4, 0);  // one behind the end may be passed
    CHECK(cudaGetLastError() == cudaSuccess);
}

TEST_CASE("memory begins as a pattern that is no number") {
    DeviceBuffer<float> floats(100);
    for (const float value : floats.download()) CHECK(std::isnan(value));
    DeviceBuffer<double> doubles(100);
    for (const double value : doubles.download()) CHECK(std::isnan(value));
    DeviceBuffer<int> integers(100);
    for (const int value : integers.download()) CHECK(value == 0x7fffffff);
    DeviceBuffer<unsigned char> bytes(7);
    CHECK(bytes.download() == std::vector<unsigned char>{0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff});
}

TEST_CASE("cudaDeviceReset frees everything") {
    void* forgotten[3];
    for (void*& pointer : forgotten) CUDA_CHECK(cudaMalloc(&pointer, 100));
    CHECK(cudasim::live_allocations() == 3);
    CUDA_CHECK(cudaDeviceReset());
    CHECK(cudasim::live_allocations() == 0);
    CHECK(cudasim::live_bytes() == 0);
}
#endif
