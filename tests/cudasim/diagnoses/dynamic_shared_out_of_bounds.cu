// The launch gives half the shared memory that the kernel uses.
#include <cuda_runtime.h>

__global__ void dynamic_overrun_kernel(float* values) {
    extern __shared__ float tile[];
    tile[threadIdx.x] = 1.0f;  // mark: write
    __syncthreads();
    values[threadIdx.x] = tile[threadIdx.x];
}

int main() {
    float* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(float));
    dynamic_overrun_kernel<<<1, 64, 32 * sizeof(float)>>>(values);  // mark: launch
    cudaFree(values);
    return 0;
}
