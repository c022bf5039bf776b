// A kernel gets a host pointer.
#include <cuda_runtime.h>

__global__ void host_pointer_kernel(int n, int* values) {
    if (n > 0) values[threadIdx.x] = 1;
}

int main() {
    int host[32];
    host_pointer_kernel<<<1, 32>>>(32, host);  // mark: launch
    return cudaGetLastError() == cudaErrorIllegalAddress ? 0 : 1;
}
