// Exit code 0 when a CUDA device answers. CMake runs it where nvcc is installed (CudaSources.cmake).
#include <cuda_runtime.h>

int main() {
    int count = 0;
    const bool answered = cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
    return answered ? 0 : 1;
}
