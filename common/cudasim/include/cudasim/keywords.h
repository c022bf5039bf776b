/// @file
/// CUDA's words for where code runs and where data lives. On one CPU most of them mean nothing.
#pragma once

#define __host__
#define __device__
#define __global__ __attribute__((unused))
#define __constant__
#define __grid_constant__
#define __forceinline__ inline __attribute__((always_inline))
#define __launch_bounds__(...)
#define __align__(bytes) __attribute__((aligned(bytes)))

// One copy for each worker thread, which runs one block at a time: that is what shared memory is. The
// rewriter replaces declarations with this word (shared_memory.h); the definition here serves those in
// macros.
#define __shared__ static thread_local

// Marks what the simulator does not have. A use is a compile error that says `message`.
#if defined(__has_attribute)
#if __has_attribute(unavailable)
#define CUDASIM_UNSUPPORTED(message) __attribute__((unavailable(message)))
#endif
#endif
#ifndef CUDASIM_UNSUPPORTED  // GCC before 12
#define CUDASIM_UNSUPPORTED(message) __attribute__((error(message)))
#endif

// GCC says by a macro which sanitizer it compiles for, Clang when asked.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#if __has_feature(thread_sanitizer) && !defined(__SANITIZE_THREAD__)
#define __SANITIZE_THREAD__ 1
#endif
#endif

#define __managed__ \
    CUDASIM_UNSUPPORTED("the CUDA simulator has no managed memory: use cudaMalloc and cudaMemcpy")
