// The last thread reads behind the end of a shared array, through a pointer that has lost the array's size.
#include <cuda_runtime.h>

__device__ float right_neighbour(const float* tile) {
    return tile[threadIdx.x + 1];  // mark: read
}

__global__ void shared_overrun_kernel(float* values) {
    __shared__ float tile[65];
    tile[threadIdx.x] = 1.0f;
    __syncthreads();
    values[threadIdx.x] = right_neighbour(tile + 1);
}

int main() {
    float* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(float));
    shared_overrun_kernel<<<1, 64>>>(values);
    cudaFree(values);
    return 0;
}
