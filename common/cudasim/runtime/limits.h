/// @file
/// The limits that all CUDA devices have had since compute capability 3.0 (CUDA C++ Programming Guide, table
/// of technical specifications per compute capability).
#pragma once
#include <cuda_runtime.h>

namespace cudasim {

constexpr unsigned kMaxThreadsPerBlock = 1024;
constexpr dim3 kMaxBlock{1024, 1024, 64};
constexpr dim3 kMaxGrid{0x7fffffffu, 65535, 65535};

}  // namespace cudasim
