/// @file
/// Words for people: diagnoses on stderr, and the names of places in them.
#pragma once
#include <cuda_runtime.h>

#include <string>

namespace cudasim {

/// The launch that the calling OS thread is working on; nullptr outside of kernels.
extern thread_local const LaunchRequest* running_launch;

/// Prints "cudasim: `message`" on stderr, in one piece. Further lines of the message are indented.
void say(const std::string& message);

/// "(1,0,0)"
std::string text_of(uint3 index);
/// "grid.cu:12"
std::string text_of(const char* file, int line);
/// "kernel forces_kernel (launched at main.cu:30)"
std::string text_of(const LaunchRequest& launch);
/// "kernel ..., block (0,0,0)": what the calling OS thread is running.
std::string running_block_text();
/// The same with the thread, where threadIdx is stored for certain: in all that a kernel calls. (Between
/// calls the optimiser may keep it in a register.)
std::string running_thread_text();

/// The thread of a block with that number.
uint3 thread_index_of(unsigned number);

}  // namespace cudasim
