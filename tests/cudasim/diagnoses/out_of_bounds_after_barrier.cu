// The same behind a barrier, where threads run on fibers of their own.
#include <cuda_runtime.h>

__global__ void write_after_barrier_kernel(float* values, int n) {
    __syncthreads();
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i <= n) values[i] = 1.0f;  // mark: write
}

int main() {
    float* values = nullptr;
    cudaMalloc(&values, 1000 * sizeof(float));
    write_after_barrier_kernel<<<4, 256>>>(values, 1000);
    cudaFree(values);
    return 0;
}
