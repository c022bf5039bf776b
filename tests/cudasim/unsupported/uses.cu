// Each part uses something the simulator does not have; the compiler must say so. Compiled with one of them
// defined.
#include <cuda_runtime.h>
#if defined(COOPERATIVE_GROUPS)
#include <cooperative_groups.h>
#endif

#if defined(MANAGED_VARIABLE)
__managed__ int shared_by_all;
#endif

__global__ void kernel(int* values) {
#if defined(ACTIVE_MASK)
    values[0] = __activemask();
#endif
    values[threadIdx.x] = 0;
}

int main() {
    int* values = nullptr;
#if defined(MANAGED_MEMORY)
    cudaMallocManaged(&values, 4);
#elif defined(GRAPHS)
    cudaGraph_t* graph = nullptr;
    cudaGraphCreate(graph, 0);
#elif defined(MANAGED_VARIABLE)
    shared_by_all = 1;
#elif defined(WRONG_ARGUMENT)
    kernel<<<1, 1>>>(3.5);  // mark: wrong
#elif defined(TOO_FEW_ARGUMENTS)
    kernel<<<1, 1>>>();  // mark: few
#else
    cudaMalloc(&values, 4);
#endif
    kernel<<<1, 1>>>(values);
}
