// Blocks add to one counter without atomicAdd.
#include <cuda_runtime.h>

__global__ void racing_count_kernel(int* count) {
    *count += 1;  // mark: race
}

int main() {
    int* count = nullptr;
    cudaMalloc(&count, sizeof(int));
    cudaMemset(count, 0, sizeof(int));
    // Many launches: on a busy machine one worker may have done all blocks of one before another wakes up.
    for (int launch = 0; launch < 20; ++launch) {
        racing_count_kernel<<<4000, 64>>>(count);  // mark: launch
    }
    cudaFree(count);
    return 0;
}
