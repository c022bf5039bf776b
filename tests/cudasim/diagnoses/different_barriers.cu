// All threads wait, but not at the same barrier: CUDA allows a barrier in a branch only if all threads take
// it.
#include <cuda_runtime.h>

__global__ void branches_kernel(int* values) {
    if (threadIdx.x % 2 == 0) {
        values[threadIdx.x] = 0;
        __syncthreads();  // mark: even
    } else {
        values[threadIdx.x] = 1;
        __syncthreads();  // mark: odd
    }
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(int));
    branches_kernel<<<dim3(1, 1), dim3(8, 8)>>>(values);
    const bool reported = cudaDeviceSynchronize() == cudaErrorLaunchFailure;
    cudaFree(values);
    return reported ? 0 : 1;
}
