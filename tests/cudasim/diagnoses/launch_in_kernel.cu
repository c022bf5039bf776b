// A kernel launches another one, which the simulator does not have.
#include <cuda_runtime.h>

__global__ void inner_kernel() {}

__global__ void outer_kernel() {
    if (blockIdx.x == 2 && threadIdx.x == 7) inner_kernel<<<1, 1>>>();
}

int main() {
    outer_kernel<<<3, 32>>>();  // mark: launch
    return 0;
}
