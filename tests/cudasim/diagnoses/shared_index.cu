// The same with the array's size in sight: UndefinedBehaviorSanitizer knows it.
#include <cuda_runtime.h>

__global__ void shared_index_kernel(float* values) {
    __shared__ float tile[64];
    tile[threadIdx.x] = 1.0f;
    __syncthreads();
    values[threadIdx.x] = tile[threadIdx.x + 1];  // mark: read
}

int main() {
    float* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(float));
    shared_index_kernel<<<1, 64>>>(values);
    cudaFree(values);
    return 0;
}
