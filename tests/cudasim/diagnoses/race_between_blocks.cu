// Blocks add to one counter without atomicAdd.
#include <cuda_runtime.h>

__global__ void racing_count_kernel(int* count) {
    *count += 1;  // mark: race
}

int main() {
    int* count = nullptr;
    cudaMalloc(&count, sizeof(int));
    cudaMemset(count, 0, sizeof(int));
    racing_count_kernel<<<4000, 64>>>(count);  // mark: launch
    cudaFree(count);
    return 0;
}
