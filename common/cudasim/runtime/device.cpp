// The simulated device: this machine's cores and memory, with the limits every CUDA device has.
#include <cuda_runtime.h>

#include "runtime/allocations.h"
#include "runtime/errors.h"
#include "runtime/host_call.h"
#include "runtime/host_memory.h"
#include "runtime/limits.h"
#include "runtime/settings.h"

using namespace cudasim;

cudaError_t cudaGetDeviceCount(int* count) {
    if (!count) return set_last_error(cudaErrorInvalidValue);
    *count = 1;
    return cudaSuccess;
}

cudaError_t cudaGetDevice(int* device) {
    if (!device) return set_last_error(cudaErrorInvalidValue);
    *device = 0;
    return cudaSuccess;
}

cudaError_t cudaSetDevice(int device) {
    return device == 0 ? cudaSuccess : set_last_error(cudaErrorInvalidDevice);
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
    if (!properties) return set_last_error(cudaErrorInvalidValue);
    if (device != 0) return set_last_error(cudaErrorInvalidDevice);
    *properties = {};
    const int workers = static_cast<int>(settings().workers);
    std::snprintf(properties->name, sizeof properties->name, "CUDA simulator (%d CPU thread%s)", workers,
                  workers == 1 ? "" : "s");
    properties->totalGlobalMem = total_host_memory();
    properties->sharedMemPerBlock = kSharedLimit;
    properties->totalConstMem = 64 * 1024;
    properties->warpSize = warpSize;
    properties->maxThreadsPerBlock = static_cast<int>(kMaxThreadsPerBlock);
    const auto as_ints = [](const dim3& from, int* to) {
        to[0] = static_cast<int>(from.x);
        to[1] = static_cast<int>(from.y);
        to[2] = static_cast<int>(from.z);
    };
    as_ints(kMaxBlock, properties->maxThreadsDim);
    as_ints(kMaxGrid, properties->maxGridSize);
    properties->major = 7;
    properties->minor = 5;
    properties->multiProcessorCount = workers;
    properties->maxThreadsPerMultiProcessor = static_cast<int>(kMaxThreadsPerBlock);
    properties->integrated = 1;
    return cudaSuccess;
}

namespace {
constexpr int kCudaVersion = 12000;  // 12.0: what the simulator knows of CUDA is older than that
}

cudaError_t cudaDriverGetVersion(int* version) {
    if (!version) return set_last_error(cudaErrorInvalidValue);
    *version = kCudaVersion;
    return cudaSuccess;
}

cudaError_t cudaRuntimeGetVersion(int* version) {
    return cudaDriverGetVersion(version);
}

cudaError_t cudaDeviceSynchronize() {
    const HostCall call("cudaDeviceSynchronize");
    return set_last_error(take_kernel_fault());
}

cudaError_t cudaDeviceReset() {
    const HostCall call("cudaDeviceReset");
    free_all_device_memory();
    return cudaSuccess;
}
