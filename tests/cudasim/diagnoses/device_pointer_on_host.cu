// Host code reads what a device pointer points to.
#include <cuda_runtime.h>

__global__ void fill_kernel(int* values) {
    values[threadIdx.x] = 5;
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(int));  // mark: allocation
    fill_kernel<<<1, 64>>>(values);
    const int result = values[3];  // mark: read
    cudaFree(values);
    return result;
}
