/// @file
/// Four launches that are wrong, to be looked at: what does each look like from outside?
#pragma once
#include <string>
#include <vector>

#include "03_first_kernels/first_kernels.cuh"
#include "common/device_buffer.h"
#include "common/errors.h"

namespace first_kernels {

//! [no_guard_kernel]
/// One thread per droplet, and one line missing.
__global__ void no_guard_kernel(float4* position) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    position[i].y = 1.0f;  // the last block has more threads than there are droplets
}
//! [no_guard_kernel]

//! [mistake_too_many_threads]
/// A block of 1025 threads; 1024 is the most there is.
inline void too_many_threads() {
    course::DeviceBuffer<float4> position(2000), velocity(2000);
    launch_fountain_clear(position.data(), velocity.data(), 2000);
    launch_fountain_step(position.data(), velocity.data(), 2000, Fountain{}, 0, 1025);
}
//! [mistake_too_many_threads]

//! [mistake_unchecked]
/// The same, and nobody asks. @return what the program would go on with
inline std::string unchecked() {
    course::DeviceBuffer<float4> position(std::vector<float4>(2000, make_float4(0, 7, 0, 0)));
    no_guard_kernel<<<2, 1025>>>(position.data());
    const float y = position.download()[0].y;  // the copy itself works, and says nothing
    cudaGetLastError();                        // forget the error: it would hit the next check
    return "no error was reported, and the height that should be 1 is " + std::to_string(y);
}
//! [mistake_unchecked]

//! [mistake_host_pointer]
/// The address of a vector's elements, given to a kernel.
inline void host_pointer() {
    std::vector<float4> position(2000), velocity(2000);
    launch_fountain_clear(position.data(), velocity.data(), 2000);
    CUDA_CHECK(cudaDeviceSynchronize());  // a kernel's own errors arrive once it has run
}
//! [mistake_host_pointer]

//! [mistake_no_guard]
/// 2000 droplets in 8 blocks of 256: 48 threads have none.
inline void no_guard() {
    course::DeviceBuffer<float4> position(2000);
    no_guard_kernel<<<blocks_for(2000), kThreadsPerBlock>>>(position.data());
    CUDA_CHECK(cudaGetLastError());
    CUDA_CHECK(cudaDeviceSynchronize());
}
//! [mistake_no_guard]

/// Makes one of the mistakes. @return what to print if it did not throw
inline std::string make_mistake(const std::string& name) {
    const std::string silent = "no error was reported";
    if (name == "too-many-threads") return too_many_threads(), silent;
    if (name == "unchecked") return unchecked();
    if (name == "host-pointer") return host_pointer(), silent;
    if (name == "no-guard") return no_guard(), silent;
    throw course::BadInput("there is no mistake '" + name +
                           "': choose one of too-many-threads, unchecked, host-pointer, no-guard");
}

}  // namespace first_kernels
