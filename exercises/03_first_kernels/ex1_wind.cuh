// Exercise 03.1: a kernel of your own, for any number of droplets.
//
// A gust of wind takes every droplet a little of the way to the wind's own velocity. You write the kernel and
// its launch; there may be 1 droplet, or 1000, or none, and 1000 is no multiple of 256.
#pragma once
#include "03_first_kernels/first_kernels.cuh"
#include "common/todo.h"

namespace first_kernels {

// One thread per droplet: velocity += share * (wind - velocity). velocity.w stays as it is.
__global__ void wind_kernel(float4* velocity, std::uint32_t n, float3 wind_m_per_s, float share) {
    // TODO(3.1): which droplet is this thread's, has it one at all, and what happens to it? About 7 lines.
    (void)wind_m_per_s, (void)share;
    if (blockIdx.x == 0 && threadIdx.x == 0 && n > 0) velocity[0].x = course::kTodo;
}

// Blows on n droplets in device memory. Throws course::CudaError if the launch was not accepted.
inline void blow(float4* velocity, std::uint32_t n, float3 wind_m_per_s, float share) {
    // TODO(3.1): launch the kernel with kThreadsPerBlock threads a block, and check it. About 3 lines.
    if (n > 0) wind_kernel<<<1, 1>>>(velocity, n, wind_m_per_s, share);
}

}  // namespace first_kernels
