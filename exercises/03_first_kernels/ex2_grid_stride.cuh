// Exercise 03.2: fewer threads than droplets.
//
// One thread per droplet is not a law. A grid of fixed size whose threads each take many droplets costs less
// to start and gives each thread something of its own to keep: here, a count. "How many droplets are higher
// than ...?"
#pragma once
#include <numeric>

#include "03_first_kernels/first_kernels.cuh"
#include "common/device_buffer.h"
#include "common/todo.h"

namespace first_kernels {

// Each thread counts those of its droplets whose y is over height_m, and writes its count to its own place:
// count_of_thread has gridDim.x * blockDim.x elements.
__global__ void count_above_kernel(int* count_of_thread, const float4* position, std::uint32_t n,
                                   float height_m) {
    // TODO(3.2): a loop over this thread's droplets: its first one, then one grid further, and so on.
    // About 6 lines.
    (void)position, (void)n, (void)height_m;
    const std::uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x;
    count_of_thread[thread] = thread == 0 ? course::kTodo : 0;
}

// How many of n droplets in device memory are higher than height_m, with a grid of `blocks` blocks. The
// counts of the threads are added on the host; chapter 04 does that on the device, too.
inline int count_above_on_device(const float4* position, std::uint32_t n, float height_m, unsigned blocks,
                                 unsigned threads_per_block = kThreadsPerBlock) {
    course::DeviceBuffer<int> count_of_thread(std::size_t(blocks) * threads_per_block);
    count_above_kernel<<<blocks, threads_per_block>>>(count_of_thread.data(), position, n, height_m);
    CUDA_CHECK(cudaGetLastError());
    const std::vector<int> counts = count_of_thread.download();
    return std::accumulate(counts.begin(), counts.end(), 0);
}

}  // namespace first_kernels
