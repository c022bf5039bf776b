/// @file
/// Counts what kernels read and write, for cudasim::Counts.
#pragma once
#include <cstddef>

namespace cudasim {

enum class Access { kLoad, kStore, kAtomic };

/// From now on accesses are counted. Called at the start of a program that was built for it.
void begin_counting();
/// One access of the calling OS thread. Counts if a kernel is running and the address is in global or shared
/// memory; a kernel's own variables are neither.
void count_access(const void* address, std::size_t bytes, Access access);
/// Shared memory of this worker: what lies there is counted as such.
void note_shared_memory(const void* begin, std::size_t bytes);

}  // namespace cudasim
