// Kernels that crash, one for each number. In the default build, without a sanitizer.
#undef NDEBUG
#include <cassert>

#include <cuda_runtime.h>

__global__ void null_kernel(int* values) {
    if (blockIdx.x == 1 && threadIdx.x == 5) values[0] = 1;
}
__global__ void far_out_kernel(float* values) {
    values[blockIdx.x * blockDim.x + threadIdx.x] = 1.0f;
}
__global__ void freed_kernel(int** values) {
    (*values)[threadIdx.x] = 1;
}

__device__ int depth_of(int n) {
    volatile int here[64];
    here[n % 64] = n;
    return n == 0 ? 0 : depth_of(n - 1) + here[n % 64] - n + 1;
}
__global__ void deep_kernel(int* values) {
    values[threadIdx.x] = depth_of(1000000);
}

__global__ void assert_kernel(int* values) {
    assert(threadIdx.x < 7 && values);
}

__global__ void divide_kernel(int* values) {
    values[threadIdx.x] = 100 / values[threadIdx.x];
}

__global__ void late_kernel(int* values) {
    __syncthreads();
    if (threadIdx.x == 9) *values = 1;
}

int main(int, char** arguments) {
    int *values = nullptr, *null = nullptr;
    float* floats = nullptr;
    cudaMalloc(&values, 64 * sizeof(int));
    cudaMalloc(&floats, 4096);  // mark: allocation
    cudaMemset(values, 0, 64 * sizeof(int));
    const int wanted = std::atoi(arguments[1]);
    if (wanted == 0) null_kernel<<<2, 32>>>(null);  // mark: null
    if (wanted == 1) far_out_kernel<<<5, 256>>>(floats);
    if (wanted == 2) deep_kernel<<<1, 1>>>(values);
    if (wanted == 3) assert_kernel<<<1, 32>>>(values);
    if (wanted == 4) divide_kernel<<<1, 32>>>(values);
    if (wanted == 5) {
        int** pointer = nullptr;
        cudaMalloc(&pointer, sizeof(int*));
        cudaMemcpy(pointer, &values, sizeof(int*), cudaMemcpyHostToDevice);
        cudaFree(values);
        freed_kernel<<<1, 32>>>(pointer);
    }
    if (wanted == 6) late_kernel<<<1, 32>>>(null);
    return 0;
}
