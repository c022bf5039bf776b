/// @file
/// Errors of launches, which nobody gets as a return value.
#pragma once
#include <cuda_runtime.h>

namespace cudasim {

/// Notes why a launch failed. Reported at exit if nobody asks for it.
void set_launch_error(const LaunchRequest& request, cudaError_t error);
/// The error of a kernel that crashed, once: what a call that waits for kernels returns.
cudaError_t take_kernel_fault();

}  // namespace cudasim
