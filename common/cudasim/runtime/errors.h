/// @file
/// Errors: those of launches, which nobody gets as a return value, and a word of explanation for the others.
#pragma once
#include <cuda_runtime.h>

#include <string>

namespace cudasim {

/// Notes why a launch failed. Reported at exit if nobody asks for it.
void set_launch_error(const LaunchRequest& request, cudaError_t error);
/// The error of a kernel that crashed, once: what a call that waits for kernels returns.
cudaError_t take_kernel_fault();

/// Says why a call at that place failed, and notes and returns its error.
cudaError_t refuse(cudaError_t error, const char* call, const char* file, int line, const std::string& why);

}  // namespace cudasim
