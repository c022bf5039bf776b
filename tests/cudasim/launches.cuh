// A header with kernels and launches of its own, as the lesson headers have.
#pragma once
#include <cuda_runtime.h>

namespace launch_forms::inner {

template <class T, int kTimes>
__global__ void scale_kernel(T* values, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] *= kTimes;
}

/// A launch inside a template, of a kernel whose arguments depend on it.
template <class T>
void scale_by_six(T* values, int n) {
    scale_kernel<T, 2><<<(n + 31) / 32, 32>>>(values, n);
    scale_kernel<T, (3 > 2 ? 3 : 0)><<<(n + 31) / 32, 32>>>(values, n);
}

}  // namespace launch_forms::inner
