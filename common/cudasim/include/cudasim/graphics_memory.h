/// @file
/// Graphics memory that kernels may use while it is mapped (cuda_gl_interop.h).
#pragma once
#include <cstddef>

#include "cudasim/errors.h"

namespace cudasim {

/// Mapped memory joins the list of what kernels may use. `discard`: it is poisoned first, since a kernel that
/// reads what it promised to overwrite is wrong.
void add_graphics_memory(void* begin, std::size_t bytes, bool discard);
void remove_graphics_memory(void* begin);
/// Says why on stderr, and notes and returns the error.
cudaError_t refuse_graphics(cudaError_t error, const char* call, const char* why);

}  // namespace cudasim
