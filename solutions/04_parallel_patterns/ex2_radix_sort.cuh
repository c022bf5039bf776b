// Exercise 04.2: from a scan to a sort.
//
// Compaction by scan throws the unwanted away. Keep them, behind the others, and you have split the numbers
// in two without changing the order within either half. Split by the lowest bit, then by the next one, up to
// the highest: the numbers are sorted. Sorts on GPUs are made like this, with several bits at a time.
#pragma once
#include "04_parallel_patterns/scan.cuh"
#include "common/todo.h"

namespace patterns {

// One thread per number, and one more: place[i] becomes 1 where the bit is 0, else 0; place[n] becomes 0.
inline __global__ void zero_bit_kernel(std::uint32_t* place, const std::uint32_t* values, unsigned bit,
                                       std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i > n) return;
    // TODO(4.2): write place[i]. There is no values[n]. About 2 lines.
    // <solution>
    place[i] = i < n && (values[i] >> bit & 1u) == 0;
    // <stub>
    //| (void)values, (void)bit;
    //| place[i] = std::uint32_t(course::kTodo);
    // </solution>
}

// One thread per number: brings it to its place in `to`. Numbers whose bit is 0 come first. `place` has been
// scanned: place[i] is how many numbers before number i have a 0, and place[n] how many have it in all.
inline __global__ void split_kernel(std::uint32_t* to, const std::uint32_t* values,
                                    const std::uint32_t* place, unsigned bit, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    // TODO(4.2): write values[i] to where it belongs. How many numbers before number i have a 1? About 4
    // lines.
    // <solution>
    const std::uint32_t zeros_before = place[i], ones_before = i - zeros_before;
    const bool one = values[i] >> bit & 1u;
    to[one ? place[n] + ones_before : zeros_before] = values[i];
    // <stub>
    //| (void)values, (void)place, (void)bit;
    //| to[i] = std::uint32_t(course::kTodo);
    // </solution>
}

// Splits by one bit: from `values` to `to`. `place` has n + 1 elements, `scan` was made for as many.
inline void split(std::uint32_t* to, const std::uint32_t* values, std::uint32_t* place, ExclusiveScan& scan,
                  unsigned bit, std::uint32_t n) {
    zero_bit_kernel<<<blocks_for(n + 1), kThreads>>>(place, values, bit, n);
    CUDA_CHECK(cudaGetLastError());
    scan(place, n + 1);
    split_kernel<<<blocks_for(n), kThreads>>>(to, values, place, bit, n);
    CUDA_CHECK(cudaGetLastError());
}

// Sorts n numbers on the device, ascending. n may be 0.
inline void radix_sort(std::uint32_t* values, std::uint32_t n) {
    if (n == 0) return;
    course::DeviceBuffer<std::uint32_t> other(n), place(n + 1);
    ExclusiveScan scan(n + 1);
    // TODO(4.2): split by each of the 32 bits, to and fro between `values` and `other`. The result has to end
    // in `values`. About 4 lines.
    // <solution>
    for (unsigned bit = 0; bit < 32; bit += 2) {
        split(other.data(), values, place.data(), scan, bit, n);
        split(values, other.data(), place.data(), scan, bit + 1, n);
    }
    // <stub>
    //| split(other.data(), values, place.data(), scan, 0, n);
    //| CUDA_CHECK(cudaMemcpy(values, other.data(), other.bytes(), cudaMemcpyDeviceToDevice));
    // </solution>
}

}  // namespace patterns
