// Two allocations are forgotten, one by a static object that is destroyed when main is over.
#include <cuda_runtime.h>

struct Owner {
    int* memory = nullptr;
    ~Owner() { cudaFree(memory); }
};
Owner frees_late;

int main() {
    float *lost = nullptr, *also_lost = nullptr, *freed = nullptr;
    cudaMalloc(&frees_late.memory, 8);
    cudaMalloc(&lost, 4000);  // mark: first
    cudaMalloc(&freed, 100);
    cudaMalloc(&also_lost, 24);  // mark: second
    cudaFree(freed);
    return 3;
}
