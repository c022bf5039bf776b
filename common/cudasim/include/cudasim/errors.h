/// @file
/// Error codes, with CUDA's names and numbers.
#pragma once

enum cudaError_t {
    cudaSuccess = 0,
    cudaErrorInvalidValue = 1,
    cudaErrorMemoryAllocation = 2,
    cudaErrorInvalidConfiguration = 9,
    cudaErrorInvalidSymbol = 13,
    cudaErrorInvalidMemcpyDirection = 21,
    cudaErrorInsufficientDriver = 35,
    cudaErrorNoDevice = 100,
    cudaErrorInvalidDevice = 101,
    cudaErrorInvalidGraphicsContext = 219,
    cudaErrorInvalidResourceHandle = 400,
    cudaErrorNotReady = 600,
    cudaErrorIllegalAddress = 700,
    cudaErrorLaunchFailure = 719,
    cudaErrorNotSupported = 801,
    cudaErrorUnknown = 999,
};
using cudaError = cudaError_t;

/// "cudaErrorInvalidValue"
const char* cudaGetErrorName(cudaError_t error);
/// "invalid argument"
const char* cudaGetErrorString(cudaError_t error);
/// The last error of this host thread, which is then forgotten. Unlike on a GPU that goes for a crashed
/// kernel too: the device is usable afterwards, so that a test can provoke errors and carry on.
cudaError_t cudaGetLastError();
/// The last error of this host thread, which stays.
cudaError_t cudaPeekAtLastError();

namespace cudasim {
/// Notes an error for cudaGetLastError and returns it.
cudaError_t set_last_error(cudaError_t error);
}  // namespace cudasim
