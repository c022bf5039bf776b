// A lane takes part in a shuffle whose mask leaves it out.
#include <cuda_runtime.h>

__global__ void wrong_mask_kernel(int* values) {
    values[threadIdx.x] = __shfl_sync(0x0000ffffu, 1, 0);  // mark: shuffle
}

int main() {
    int* values = nullptr;
    cudaMalloc(&values, 64 * sizeof(int));
    wrong_mask_kernel<<<1, 32>>>(values);
    const bool reported = cudaGetLastError() == cudaErrorLaunchFailure;
    cudaFree(values);
    return reported ? 0 : 1;
}
