// The first ten threads leave before the barrier.
#include <cuda_runtime.h>

__global__ void early_return_kernel(int* values) {
    if (threadIdx.x < 10) return;
    __syncthreads();  // mark: barrier
    values[threadIdx.x] = 1;
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(int));
    early_return_kernel<<<1, 64>>>(values);  // mark: launch
    const bool reported = cudaGetLastError() == cudaErrorLaunchFailure;
    cudaMemset(values, 0, 64 * sizeof(int));
    cudaFree(values);
    return reported ? 0 : 1;
}
