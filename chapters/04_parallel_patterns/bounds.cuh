/// @file
/// The box around all particles: six reductions at once, minimum and maximum along each axis.
#pragma once
#include <cuda_runtime.h>

#include <cfloat>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "04_parallel_patterns/blocks.h"
#include "common/device_buffer.h"

namespace patterns {

inline __host__ __device__ glm::vec3 xyz(float4 v) {
    return {v.x, v.y, v.z};
}

/// False for NaN and both infinities. (x - x is 0 for a finite x and NaN otherwise.)
inline __host__ __device__ bool is_finite(glm::vec3 x) {
    const glm::vec3 zero = x - x;
    return zero.x == 0.0f && zero.y == 0.0f && zero.z == 0.0f;
}

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

//! [bounds_cas]
/// The number at `address` becomes `value` if that is smaller; CUDA has no atomicMin for float. atomicCAS
/// stores the new bits only if it finds the expected ones, and says what it found. So: guess; if something
/// larger is there, ask again with what was found, until nobody has changed it in between.
inline __device__ void atomic_min_by_cas(float* address, float value) {
    std::uint32_t* bits = reinterpret_cast<std::uint32_t*>(address);
    const std::uint32_t wanted = __float_as_uint(value);
    std::uint32_t expected = wanted, found;
    while ((found = atomicCAS(bits, expected, wanted)) != expected && value < __uint_as_float(found))
        expected = found;
}

/// One thread per particle: six such loops, on six addresses that all threads want.
/// @param extremes  low x, y, z, then high x, y, z *negated*, here and below: so all six are minima
inline __global__ void bounds_cas_kernel(float* extremes, const float4* position, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float4 p = position[i];
    const glm::vec3 x = xyz(p);
    if (!is_finite(x)) return;
    for (int axis = 0; axis < 3; ++axis) {
        atomic_min_by_cas(&extremes[axis], x[axis]);
        atomic_min_by_cas(&extremes[3 + axis], -x[axis]);
    }
}
//! [bounds_cas]

//! [float_order]
/// Unsigned integers in the same order as the floats they come from, so that the hardware's integer atomicMin
/// can be used. Positive floats already sort like their bits; negative ones sort backwards and below, hence
/// the flips.
inline __host__ __device__ std::uint32_t ordered_bits(float value) {
    std::uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
inline __host__ __device__ float from_ordered_bits(std::uint32_t ordered) {
    const std::uint32_t bits = ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
//! [float_order]

//! [bounds_ordered]
/// Only the difference: an atomicMin on ordered bits instead of a loop. There is nothing to repeat.
inline __global__ void bounds_ordered_kernel(std::uint32_t* extremes, const float4* position,
                                             std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float4 p = position[i];
    const glm::vec3 x = xyz(p);
    if (!is_finite(x)) return;
    for (int axis = 0; axis < 3; ++axis) {
        atomicMin(&extremes[axis], ordered_bits(x[axis]));
        atomicMin(&extremes[3 + axis], ordered_bits(-x[axis]));
    }
}
//! [bounds_ordered]

/// The six extremes of some particles.
struct Extremes {
    float minimum[6] = {FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX};
};

/// Extremes of the particles that the calling thread meets on its walk.
inline __device__ Extremes walk_extremes(const float4* position, std::uint32_t n) {
    Extremes mine;
    for (std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) {
        const float4 p = position[i];
        const glm::vec3 x = xyz(p);
        if (!is_finite(x)) continue;
        for (int axis = 0; axis < 3; ++axis) {
            mine.minimum[axis] = fminf(mine.minimum[axis], x[axis]);
            mine.minimum[3 + axis] = fminf(mine.minimum[3 + axis], -x[axis]);
        }
    }
    return mine;
}

//! [bounds_walk]
/// Only the difference: a fixed number of threads, each of which walks over many particles before it touches
/// the six addresses. Minima don't depend on the order of the atomics, so the result repeats exactly.
inline __global__ void bounds_walk_kernel(std::uint32_t* extremes, const float4* position, std::uint32_t n) {
    const Extremes mine = walk_extremes(position, n);
    for (int k = 0; k < 6; ++k) atomicMin(&extremes[k], ordered_bits(mine.minimum[k]));
}
//! [bounds_walk]

//! [bounds_shared]
/// Only the difference: a tree in shared memory, and six atomics per block.
inline __global__ void bounds_shared_kernel(std::uint32_t* extremes, const float4* position,
                                            std::uint32_t n) {
    __shared__ float minimum[6][kThreads];
    const std::uint32_t t = threadIdx.x;
    const Extremes mine = walk_extremes(position, n);
    for (int k = 0; k < 6; ++k) minimum[k][t] = mine.minimum[k];
    for (std::uint32_t half = kThreads / 2; half > 0; half /= 2) {
        __syncthreads();
        if (t < half)
            for (int k = 0; k < 6; ++k) minimum[k][t] = fminf(minimum[k][t], minimum[k][t + half]);
    }
    if (t == 0)
        for (int k = 0; k < 6; ++k) atomicMin(&extremes[k], ordered_bits(minimum[k][0]));
}
//! [bounds_shared]

inline __device__ float warp_minimum(float value) {
    for (std::uint32_t offset = kWarp / 2; offset > 0; offset /= 2)
        value = fminf(value, __shfl_down_sync(kAllLanes, value, offset));
    return value;
}

//! [bounds_warp]
/// Only the difference: shuffles inside the warps, and one barrier.
inline __global__ void bounds_warp_kernel(std::uint32_t* extremes, const float4* position, std::uint32_t n) {
    __shared__ float minimum[6][kWarps];
    const std::uint32_t warp = threadIdx.x / kWarp, lane = threadIdx.x % kWarp;
    const Extremes mine = walk_extremes(position, n);
    for (int k = 0; k < 6; ++k) {
        const float of_warp = warp_minimum(mine.minimum[k]);
        if (lane == 0) minimum[k][warp] = of_warp;
    }
    __syncthreads();
    if (warp > 0) return;
    for (int k = 0; k < 6; ++k) {
        float value = FLT_MAX;
        if (lane < kWarps) value = minimum[k][lane];
        value = warp_minimum(value);
        if (lane == 0) atomicMin(&extremes[k], ordered_bits(value));
    }
}
//! [bounds_warp]

enum class BoundsMethod { cas, ordered, walk, shared, warp };

constexpr std::uint32_t kWalkBlocks = 32, kWalkThreads = 64;  ///< of bounds_walk_kernel, whatever n is

/// Finds boxes again and again, in memory made once.
class BoundsFinder {
  public:
    explicit BoundsFinder(BoundsMethod method) : method_(method), extremes_(6) {}

    /// The box is on the device; nobody waits.
    void launch(const float4* position, std::uint32_t n) {
        const Extremes none;
        std::vector<std::uint32_t> start(6, ordered_bits(FLT_MAX));
        if (method_ == BoundsMethod::cas) memcpy(start.data(), none.minimum, sizeof none.minimum);
        extremes_.upload(start);
        if (n == 0) return;
        std::uint32_t* extremes = extremes_.data();
        switch (method_) {
            case BoundsMethod::cas:
                bounds_cas_kernel<<<blocks_for(n), kThreads>>>(reinterpret_cast<float*>(extremes), position,
                                                               n);
                break;
            case BoundsMethod::ordered:
                bounds_ordered_kernel<<<blocks_for(n), kThreads>>>(extremes, position, n);
                break;
            case BoundsMethod::walk:
                bounds_walk_kernel<<<kWalkBlocks, kWalkThreads>>>(extremes, position, n);
                break;
            case BoundsMethod::shared:
                bounds_shared_kernel<<<walking_blocks(n), kThreads>>>(extremes, position, n);
                break;
            case BoundsMethod::warp:
                bounds_warp_kernel<<<walking_blocks(n), kThreads>>>(extremes, position, n);
                break;
        }
        CUDA_CHECK(cudaGetLastError());
    }
    /// Waits for the device.
    Bounds download() const {
        const std::vector<std::uint32_t> bits = extremes_.download();
        Extremes found;
        if (method_ == BoundsMethod::cas)
            memcpy(found.minimum, bits.data(), sizeof found.minimum);
        else
            for (int k = 0; k < 6; ++k) found.minimum[k] = from_ordered_bits(bits[k]);
        Bounds box;
        for (int axis = 0; axis < 3; ++axis) {
            box.low_m[axis] = found.minimum[axis];
            box.high_m[axis] = -found.minimum[3 + axis];
        }
        return box;
    }

  private:
    BoundsMethod method_;
    course::DeviceBuffer<std::uint32_t> extremes_;
};

/// Box around the particles with finite positions. Waits for the device.
inline Bounds find_bounds(const float4* position, std::uint32_t n, BoundsMethod method = BoundsMethod::walk) {
    BoundsFinder finder(method);
    finder.launch(position, n);
    return finder.download();
}

}  // namespace patterns
