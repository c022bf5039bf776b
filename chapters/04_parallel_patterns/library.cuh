/// @file
/// The same patterns by Thrust, the algorithms that come with CUDA: one call each, and the measure for our
/// own.
#pragma once
#include <cuda_runtime.h>
#include <thrust/adjacent_difference.h>
#include <thrust/binary_search.h>
#include <thrust/copy.h>
#include <thrust/execution_policy.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/sort.h>
#include <thrust/transform_reduce.h>

#include "04_parallel_patterns/bounds.cuh"
#include "04_parallel_patterns/histogram.cuh"

namespace patterns {

/// The answer comes to the host: it waits.
inline std::uint32_t reduce_thrust(const std::uint32_t* values, std::uint32_t n) {
    return thrust::reduce(thrust::device, values, values + n, 0u);
}

inline void scan_thrust(std::uint32_t* values, std::uint32_t n) {
    thrust::exclusive_scan(thrust::device, values, values + n, values);
}

/// Thrust has no histogram. Sorted, the elements of a bin stand side by side: where each bin ends says how
/// many there are up to it, and the differences are the counts.
inline void histogram_thrust(std::uint32_t* counts, std::uint32_t* scratch, const std::uint32_t* bin,
                             std::uint32_t n) {
    if (n) CUDA_CHECK(cudaMemcpy(scratch, bin, n * sizeof *bin, cudaMemcpyDeviceToDevice));
    thrust::sort(thrust::device, scratch, scratch + n);
    const thrust::counting_iterator<std::uint32_t> first_bin(0);
    thrust::upper_bound(thrust::device, scratch, scratch + n, first_bin, first_bin + kBins, counts);
    thrust::adjacent_difference(thrust::device, counts, counts + kBins, counts);
}

struct IsNotZero {
    __host__ __device__ bool operator()(std::uint32_t value) const { return value != 0; }
};
/// Keeps the order. @returns how many were kept
inline std::uint32_t compact_thrust(std::uint32_t* kept, const std::uint32_t* values, std::uint32_t n) {
    return std::uint32_t(thrust::copy_if(thrust::device, values, values + n, kept, IsNotZero{}) - kept);
}

struct BoundsOfOne {
    __host__ __device__ Bounds operator()(float4 position) const {
        const glm::vec3 x = xyz(position);
        if (is_finite(x)) return {x, x};
        return {};
    }
};
struct BoundsOfTwo {
    __host__ __device__ Bounds operator()(const Bounds& a, const Bounds& b) const {
        return {glm::min(a.low_m, b.low_m), glm::max(a.high_m, b.high_m)};
    }
};
inline Bounds bounds_thrust(const float4* position, std::uint32_t n) {
    return thrust::transform_reduce(thrust::device, position, position + n, BoundsOfOne{}, Bounds{},
                                    BoundsOfTwo{});
}

}  // namespace patterns
