/// @file
/// The one simulated device.
#pragma once
#include <cstddef>

#include "cudasim/errors.h"

/// Those members of CUDA's structure that all toolkit versions have and the simulator can fill in.
struct cudaDeviceProp {
    char name[256];              ///< "CUDA simulator (2 CPU threads)"
    std::size_t totalGlobalMem;  ///< memory of this machine, bytes
    std::size_t sharedMemPerBlock;
    std::size_t totalConstMem;
    int warpSize;
    int maxThreadsPerBlock;
    int maxThreadsDim[3];
    int maxGridSize[3];
    int major, minor;         ///< 7.5: the oldest GPU the course compiles for
    int multiProcessorCount;  ///< worker threads: each runs one block at a time
    int maxThreadsPerMultiProcessor;
    int integrated;
};

cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaGetDevice(int* device);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device);
cudaError_t cudaDriverGetVersion(int* version);
cudaError_t cudaRuntimeGetVersion(int* version);
/// Kernels have ended when the launch returns; this hands out the error of one that failed.
cudaError_t cudaDeviceSynchronize();
/// Frees all device memory.
cudaError_t cudaDeviceReset();
