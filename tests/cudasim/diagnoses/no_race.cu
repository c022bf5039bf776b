// What ThreadSanitizer must not report: atomics, barriers and shuffles, host writes before, host reads after.
#include <cuda_runtime.h>

__global__ void clean_count_kernel(int* count, const int* values) {
    __shared__ int partial[64];
    partial[threadIdx.x] = values[threadIdx.x];
    __syncthreads();
    int sum = partial[63 - threadIdx.x];
    for (int offset = 16; offset > 0; offset /= 2) sum += __shfl_down_sync(0xffffffffu, sum, offset);
    if (threadIdx.x % 32 == 0) atomicAdd(count, sum);
}

int main() {
    int *count = nullptr, *values = nullptr;
    int host[64];
    for (int& value : host) value = 1;
    cudaMalloc(&count, sizeof(int));
    cudaMalloc(&values, sizeof host);
    cudaMemset(count, 0, sizeof(int));
    int result = 0;
    for (int round = 0; round < 3; ++round) {
        cudaMemcpy(values, host, sizeof host, cudaMemcpyHostToDevice);
        clean_count_kernel<<<100, 64>>>(count, values);
        cudaMemcpy(&result, count, sizeof result, cudaMemcpyDeviceToHost);
    }
    cudaFree(values);
    cudaFree(count);
    std::printf("counted %d\n", result);
    return 0;
}
