// Half of a warp waits in a shuffle for lanes that wait in another one.
#include <cuda_runtime.h>

__global__ void half_warp_kernel(int* values) {
    if (threadIdx.x < 16)
        values[threadIdx.x] = __shfl_sync(0xffffffffu, 1, 0);  // mark: shuffle
    else
        __syncwarp(0xffff0000u), __syncthreads();  // mark: barrier
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 32 * sizeof(int));
    half_warp_kernel<<<1, 32>>>(values);
    const bool reported = cudaGetLastError() == cudaErrorLaunchFailure;
    cudaFree(values);
    return reported ? 0 : 1;
}
