// Grids and blocks of one to three dimensions: every thread runs once, and knows where it is.
#include <cuda_runtime.h>

#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

/// Each thread counts itself at its place in the whole grid, and notes what it knows.
__global__ void visit_kernel(int* visits, uint3* threads, uint3* blocks) {
    const uint3 place = {blockIdx.x * blockDim.x + threadIdx.x, blockIdx.y * blockDim.y + threadIdx.y,
                         blockIdx.z * blockDim.z + threadIdx.z};
    const unsigned width = gridDim.x * blockDim.x, height = gridDim.y * blockDim.y;
    const unsigned i = (place.z * height + place.y) * width + place.x;
    atomicAdd(&visits[i], 1);
    threads[i] = threadIdx;
    blocks[i] = blockIdx;
}

/// The same with a barrier in between: threads then wait on fibers of their own.
__global__ void visit_with_barrier_kernel(int* visits) {
    __shared__ int arrived;
    const unsigned t = threadIdx.x + blockDim.x * (threadIdx.y + blockDim.y * threadIdx.z);
    const unsigned threads = blockDim.x * blockDim.y * blockDim.z;
    const unsigned block = blockIdx.x + gridDim.x * (blockIdx.y + gridDim.y * blockIdx.z);
    if (t == 0) arrived = 0;
    __syncthreads();
    atomicAdd(&arrived, 1);
    __syncthreads();
    visits[block * threads + t] = arrived;
}

struct Shape {
    dim3 grid, block;
};
const Shape kShapes[] = {
    {dim3(1), dim3(1)},
    {dim3(7), dim3(31)},
    {dim3(5), dim3(32)},
    {dim3(3), dim3(33)},
    {dim3(2), dim3(256)},
    {dim3(2), dim3(1024)},
    {dim3(3, 5), dim3(16, 8)},
    {dim3(1, 7), dim3(1, 31)},
    {dim3(2, 3, 4), dim3(4, 3, 2)},
    {dim3(1, 1, 9), dim3(1, 1, 64)},
    {dim3(4, 1, 2), dim3(33, 2, 3)},
    {dim3(1, 2, 3), dim3(8, 8, 16)},
};

unsigned volume(dim3 size) {
    return size.x * size.y * size.z;
}

}  // namespace

TEST_CASE("grids of 1 to 3 dimensions: each thread runs once and knows its place") {
    for (const Shape& shape : kShapes) {
        CAPTURE(shape.grid.x);
        CAPTURE(shape.block.x);
        const unsigned n = volume(shape.grid) * volume(shape.block);
        DeviceBuffer<int> visits(n);
        DeviceBuffer<uint3> threads(n), blocks(n);
        CUDA_CHECK(cudaMemset(visits.data(), 0, visits.bytes()));
        visit_kernel<<<shape.grid, shape.block>>>(visits.data(), threads.data(), blocks.data());
        CUDA_CHECK(cudaGetLastError());

        course::check_equal(visits.download(), std::vector<int>(n, 1), "visits", "thread");
        std::vector<uint3> expected_threads, expected_blocks;
        for (unsigned z = 0; z < shape.grid.z * shape.block.z; ++z)
            for (unsigned y = 0; y < shape.grid.y * shape.block.y; ++y)
                for (unsigned x = 0; x < shape.grid.x * shape.block.x; ++x) {
                    expected_threads.push_back({x % shape.block.x, y % shape.block.y, z % shape.block.z});
                    expected_blocks.push_back({x / shape.block.x, y / shape.block.y, z / shape.block.z});
                }
        course::check_equal(threads.download(), expected_threads, "threadIdx", "thread");
        course::check_equal(blocks.download(), expected_blocks, "blockIdx", "thread");
    }
}

TEST_CASE("grids of 1 to 3 dimensions with barriers") {
    for (const Shape& shape : kShapes) {
        CAPTURE(shape.grid.x);
        CAPTURE(shape.block.x);
        const unsigned n = volume(shape.grid) * volume(shape.block);
        DeviceBuffer<int> visits(n);
        visit_with_barrier_kernel<<<shape.grid, shape.block>>>(visits.data());
        CUDA_CHECK(cudaGetLastError());
        const int threads = static_cast<int>(volume(shape.block));
        course::check_equal(visits.download(), std::vector<int>(n, threads), "threads met", "thread");
    }
}
