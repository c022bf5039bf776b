// A launch fails, and nobody asks.
#include <cuda_runtime.h>

__global__ void never_kernel(int* values) {
    values[threadIdx.x] = 1;
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 8192);
    never_kernel<<<1, 1025>>>(values);  // mark: launch
    never_kernel<<<0, 32>>>(values);
    cudaFree(values);
    return 0;
}
