/// @file
/// Whole vectors of neighbours: data and loops that fill the registers of a processor with vector units.
#pragma once
#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "common/device_buffer.h"

namespace grid {

//! [lanes]
/// Numbers that one thread handles with one instruction. A thread of a GPU is itself a lane, one of the 32 of
/// its warp. A thread of a CPU has lanes of its own: vector registers of 32 or 64 bytes.
#if defined(__CUDACC__)
constexpr int kLanes = 1;
#elif defined(__AVX512F__)
constexpr int kLanes = 16;
#else
constexpr int kLanes = 8;
#endif

/// Calls visit(lane, place, mine) for `count` successive places, kLanes at a time. What is left over at the
/// end is no slower loop of its own, but one more whole vector, in which `mine` is false for the lanes
/// beyond. They may read what lies there, so arrays have kLanes more elements than they need; nothing may
/// come of it.
template <class Visit>
__host__ __device__ __forceinline__ void for_each_in_lanes(std::uint32_t first, std::uint32_t count,
                                                           Visit visit) {
    for (std::uint32_t done = 0; done < count; done += kLanes) {
        // Signed, and as wide as a pointer: it cannot wrap around, so places are known to be successive.
        const std::ptrdiff_t place = std::ptrdiff_t(first) + done;
        const int left = int(count - done);
#pragma omp simd simdlen(kLanes)
        for (int lane = 0; lane < kLanes; ++lane) visit(lane, place + lane, lane < left);
    }
}

/// A sum for each lane. They become one number only when all rows are done: to add up the lanes of a vector
/// takes longer than to fill it.
template <class T>
struct LaneSum {
    T lane[kLanes] = {};

    __host__ __device__ T total() const {
        T sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int k = 0; k < kLanes; ++k) sum += lane[k];
        return sum;
    }
};
//! [lanes]

//! [columns]
/// Vectors of all particles, one array for each axis: a CPU loads as many x as it has lanes in one go. From
/// an array of float4 it would have to pick them out one by one.
template <class T>
struct Columns {
    T *x, *y, *z;

    __host__ __device__ glm::vec3 operator[](std::uint32_t k) const { return {x[k], y[k], z[k]}; }
};

/// Columns for n particles in device memory, with kLanes elements more behind each.
class ColumnBuffer {
  public:
    ColumnBuffer() = default;
    explicit ColumnBuffer(std::size_t n) : x_(n, kLanes), y_(n, kLanes), z_(n, kLanes) {}

    Columns<float> columns() { return {x_.data(), y_.data(), z_.data()}; }
    Columns<const float> columns() const { return {x_.data(), y_.data(), z_.data()}; }

  private:
    course::DeviceBuffer<float> x_, y_, z_;
};

/// One thread per place: gather_kernel into columns.
inline __global__ void gather_columns_kernel(Columns<float> sorted, const float4* data,
                                             const std::uint32_t* order, std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place >= n) return;
    const float4 value = data[order[place]];
    sorted.x[place] = value.x;
    sorted.y[place] = value.y;
    sorted.z[place] = value.z;
}
//! [columns]

}  // namespace grid
