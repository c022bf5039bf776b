// The barrier between writing and reading shared memory is missing. Run with CUDASIM_RACECHECK=1.
#include <cuda_runtime.h>

__global__ void no_barrier_kernel(int* values) {
    __shared__ int tile[64];
    tile[threadIdx.x] = static_cast<int>(threadIdx.x);
    values[threadIdx.x] = tile[63 - threadIdx.x];
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(int));  // mark: allocation
    no_barrier_kernel<<<1, 64>>>(values);   // mark: launch
    cudaFree(values);
    return 0;
}
