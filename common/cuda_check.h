/// @file
/// The one macro of the course: it needs the file and the line of the call it checks.
#pragma once
#include <cuda_runtime.h>

#include <stdexcept>
#include <string>

namespace course {

/// A CUDA call failed. The message names the call, its file and line, and the runtime's own words.
struct CudaError : std::runtime_error {
    cudaError_t code;
    CudaError(cudaError_t error, const char* call, const char* file, int line)
        : std::runtime_error(std::string(file) + ":" + std::to_string(line) + ": " + call + ": " +
                             cudaGetErrorName(error) + " (" + cudaGetErrorString(error) + ")"),
          code(error) {}
};

inline void cuda_check(cudaError_t error, const char* call, const char* file, int line) {
    if (error != cudaSuccess) throw CudaError(error, call, file, line);
}

}  // namespace course

/// Every runtime call goes through it. After a launch: `CUDA_CHECK(cudaGetLastError())`, since a launch
/// returns nothing and its configuration errors wait there.
#define CUDA_CHECK(call) ::course::cuda_check((call), #call, __FILE__, __LINE__)
