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
    // <solution>
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    float4 v = velocity[i];
    v.x += share * (wind_m_per_s.x - v.x);
    v.y += share * (wind_m_per_s.y - v.y);
    v.z += share * (wind_m_per_s.z - v.z);
    velocity[i] = v;
    // <stub>
    //| (void)wind_m_per_s, (void)share;
    //| if (blockIdx.x == 0 && threadIdx.x == 0 && n > 0) velocity[0].x = course::kTodo;
    // </solution>
}

// Blows on n droplets in device memory. Throws course::CudaError if the launch was not accepted.
inline void blow(float4* velocity, std::uint32_t n, float3 wind_m_per_s, float share) {
    // TODO(3.1): launch the kernel with kThreadsPerBlock threads a block, and check it. About 3 lines.
    // <solution>
    if (n == 0) return;  // a grid of 0 blocks is an error
    wind_kernel<<<blocks_for(n), kThreadsPerBlock>>>(velocity, n, wind_m_per_s, share);
    CUDA_CHECK(cudaGetLastError());
    // <stub>
    //| if (n > 0) wind_kernel<<<1, 1>>>(velocity, n, wind_m_per_s, share);
    // </solution>
}

}  // namespace first_kernels
