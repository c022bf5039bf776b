// The bounds check is missing: 1024 threads write to 1000 values.
#include <cuda_runtime.h>

__global__ void no_bounds_check_kernel(float* values) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    values[i] = 1.0f;  // mark: write
}

int main() {
    float* values = nullptr;
    cudaMalloc(&values, 1000 * sizeof(float));
    no_bounds_check_kernel<<<4, 256>>>(values);  // mark: launch
    cudaFree(values);
    return 0;
}
