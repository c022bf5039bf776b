/// @file
/// The box around all particles, found on the device, so that the grid can follow them.
#pragma once
#include <cuda_runtime.h>

#include <cfloat>
#include <cmath>
#include <vector>

#include "05_spatial_grid/cell_grid.cuh"
#include "common/device_buffer.h"

namespace grid {

/// Corners of the box. Empty (low above high) when no particle has a finite position.
struct Bounds {
    glm::vec3 low_m{FLT_MAX}, high_m{-FLT_MAX};
};

/// CPU reference: one loop.
inline Bounds bounds_cpu(const std::vector<float4>& position) {
    Bounds box;
    for (const float4& p : position)
        if (is_finite(xyz(p))) {
            box.low_m = glm::min(box.low_m, xyz(p));
            box.high_m = glm::max(box.high_m, xyz(p));
        }
    return box;
}

//! [float_order]
/// Unsigned integers in the same order as the floats they come from, so that the hardware's integer atomicMin
/// and atomicMax can be used: there is no atomicMin for float. Positive floats already sort like their bits;
/// negative ones sort backwards and below, hence the flips.
inline __device__ std::uint32_t ordered_bits(float value) {
    const std::uint32_t bits = __float_as_uint(value);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
inline float from_ordered_bits(std::uint32_t ordered) {
    const std::uint32_t bits = ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered;
    float value;
    static_assert(sizeof value == sizeof bits);
    __builtin_memcpy(&value, &bits, sizeof value);
    return value;
}
//! [float_order]

//! [bounds_kernel]
/// A fixed number of threads, each walking over many particles: one set of six atomics per thread, not per
/// particle. Minimum and maximum don't depend on the order of the atomics, so the result repeats exactly.
/// @param extremes  low x, y, z then high x, y, z as ordered_bits
inline __global__ void bounds_kernel(std::uint32_t* extremes, const float4* position, std::uint32_t n) {
    glm::vec3 low(FLT_MAX), high(-FLT_MAX);
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) {
        const glm::vec3 x = xyz(position[i]);
        if (!is_finite(x)) continue;
        low = glm::min(low, x);
        high = glm::max(high, x);
    }
    for (int axis = 0; axis < 3; ++axis) {
        atomicMin(&extremes[axis], ordered_bits(low[axis]));
        atomicMax(&extremes[3 + axis], ordered_bits(high[axis]));
    }
}
//! [bounds_kernel]

/// Box around the particles with finite positions. Waits for the device.
inline Bounds find_bounds(const float4* position, std::uint32_t n) {
    course::DeviceBuffer<std::uint32_t> extremes(std::vector<std::uint32_t>{~0u, ~0u, ~0u, 0, 0, 0});
    if (n == 0) return {};
    bounds_kernel<<<32, 64>>>(extremes.data(), position, n);
    CUDA_CHECK(cudaGetLastError());
    const std::vector<std::uint32_t> bits = extremes.download();
    Bounds box;
    for (int axis = 0; axis < 3; ++axis) {
        box.low_m[axis] = from_ordered_bits(bits[axis]);
        box.high_m[axis] = from_ordered_bits(bits[3 + axis]);
    }
    return box;
}

}  // namespace grid
