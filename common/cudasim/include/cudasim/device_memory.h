/// @file
/// Device memory. It is ordinary memory of this machine, but the simulator keeps a list of it, so that copies
/// to the wrong place, leaks and host pointers handed to kernels are found.
#pragma once
#include <cstddef>

#include "cudasim/errors.h"
#include "cudasim/streams_and_events.h"

// Default arguments that name the learner's line: they are evaluated where the function is called.
#define CUDASIM_CALLER const char *file = __builtin_FILE(), int line = __builtin_LINE()

enum cudaMemcpyKind {
    cudaMemcpyHostToHost = 0,
    cudaMemcpyHostToDevice = 1,
    cudaMemcpyDeviceToHost = 2,
    cudaMemcpyDeviceToDevice = 3,
    cudaMemcpyDefault = 4,
};

namespace cudasim {
enum class MemoryKind { kDevice, kPinnedHost, kSymbol, kGraphics };
cudaError_t allocate(void** pointer, std::size_t bytes, MemoryKind kind, const char* file, int line);
cudaError_t release(void* pointer, MemoryKind kind, const char* file, int line);
/// A `__device__` or `__constant__` variable counts as device memory from the first call that names it.
void add_symbol(void* symbol, std::size_t bytes);
}  // namespace cudasim

/// The memory starts out as a NaN pattern (cudasim::kPoison), 256-byte aligned.
template <class T>
cudaError_t cudaMalloc(T** pointer, std::size_t bytes, CUDASIM_CALLER) {
    return cudasim::allocate(reinterpret_cast<void**>(pointer), bytes, cudasim::MemoryKind::kDevice, file,
                             line);
}
inline cudaError_t cudaFree(void* pointer, CUDASIM_CALLER) {
    return cudasim::release(pointer, cudasim::MemoryKind::kDevice, file, line);
}
/// Host memory that kernels may use, too.
template <class T>
cudaError_t cudaMallocHost(T** pointer, std::size_t bytes, CUDASIM_CALLER) {
    return cudasim::allocate(reinterpret_cast<void**>(pointer), bytes, cudasim::MemoryKind::kPinnedHost, file,
                             line);
}
inline cudaError_t cudaFreeHost(void* pointer, CUDASIM_CALLER) {
    return cudasim::release(pointer, cudasim::MemoryKind::kPinnedHost, file, line);
}
cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* total_bytes);

/// cudaErrorInvalidValue when `kind` does not fit the pointers, or a range leaves its allocation.
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, CUDASIM_CALLER);
inline cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                                   cudaStream_t = nullptr, CUDASIM_CALLER) {
    return cudaMemcpy(to, from, bytes, kind, file, line);
}
cudaError_t cudaMemset(void* to, int byte, std::size_t bytes, CUDASIM_CALLER);
inline cudaError_t cudaMemsetAsync(void* to, int byte, std::size_t bytes, cudaStream_t = nullptr,
                                   CUDASIM_CALLER) {
    return cudaMemset(to, byte, bytes, file, line);
}

// A symbol is the variable itself: in C++ a reference to it.
template <class T>
cudaError_t cudaGetSymbolAddress(void** pointer, const T& symbol) {
    *pointer = const_cast<T*>(&symbol);
    cudasim::add_symbol(*pointer, sizeof(T));
    return cudaSuccess;
}
template <class T>
cudaError_t cudaGetSymbolSize(std::size_t* bytes, const T&) {
    *bytes = sizeof(T);
    return cudaSuccess;
}
template <class T>
cudaError_t cudaMemcpyToSymbol(const T& symbol, const void* from, std::size_t bytes, std::size_t offset = 0,
                               cudaMemcpyKind kind = cudaMemcpyHostToDevice, CUDASIM_CALLER) {
    void* to = nullptr;
    cudaGetSymbolAddress(&to, symbol);
    return cudaMemcpy(static_cast<char*>(to) + offset, from, bytes, kind, file, line);
}
template <class T>
cudaError_t cudaMemcpyFromSymbol(void* to, const T& symbol, std::size_t bytes, std::size_t offset = 0,
                                 cudaMemcpyKind kind = cudaMemcpyDeviceToHost, CUDASIM_CALLER) {
    void* from = nullptr;
    cudaGetSymbolAddress(&from, symbol);
    return cudaMemcpy(to, static_cast<char*>(from) + offset, bytes, kind, file, line);
}
