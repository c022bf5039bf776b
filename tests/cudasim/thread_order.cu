// Orders of threads and blocks, and kernels whose results depend on them.
#include <algorithm>
#include <string>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/cudasim/simulator.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;
using cudasim::Order;

namespace {

__global__ void ticket_kernel(int* tickets, int* next) {
    tickets[blockIdx.x * blockDim.x + threadIdx.x] = atomicAdd(next, 1);
}

/// Reverses 64 values in shared memory; without the barrier it reads what may not be there yet.
template <bool kBarrier>
__global__ void reverse_kernel(int* values) {
    __shared__ int tile[64];
    tile[threadIdx.x] = values[threadIdx.x];
    if (kBarrier) __syncthreads();
    values[threadIdx.x] = tile[63 - threadIdx.x];
}

/// All threads write to one place; who is last wins.
__global__ void last_writer_kernel(int* value) {
    *value = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
}

/// Shuffled sums between barriers: the right way to do it.
__global__ void clean_sum_kernel(int* sum, const int* values) {
    __shared__ int partial[2];
    int mine = values[threadIdx.x];
    for (int offset = 16; offset > 0; offset /= 2) mine += __shfl_down_sync(0xffffffffu, mine, offset);
    if (threadIdx.x % 32 == 0) partial[threadIdx.x / 32] = mine;
    __syncthreads();
    if (threadIdx.x == 0) atomicAdd(sum, partial[0] + partial[1]);
}

std::vector<int> tickets_in(Order order, unsigned workers, int blocks, int threads) {
    const cudasim::OrderScope scope(order);
    const cudasim::WorkerScope few(workers);
    DeviceBuffer<int> tickets(blocks * threads), next(std::vector<int>{0});
    ticket_kernel<<<blocks, threads>>>(tickets.data(), next.data());
    CUDA_CHECK(cudaGetLastError());
    return tickets.download();
}

}  // namespace

TEST_CASE("threads and blocks start in the order asked for") {
    std::vector<int> ascending(6 * 50);
    for (int i = 0; i < 300; ++i) ascending[i] = i;
    std::vector<int> descending(ascending.rbegin(), ascending.rend());
    course::check_equal(tickets_in({Order::kForward}, 1, 6, 50), ascending, "ticket", "thread");
    course::check_equal(tickets_in({Order::kReverse}, 1, 6, 50), descending, "ticket", "thread");

    const std::vector<int> shuffled = tickets_in({Order::kShuffled, 3}, 1, 6, 50);
    CHECK(shuffled == tickets_in({Order::kShuffled, 3}, 1, 6, 50));
    CHECK(shuffled != tickets_in({Order::kShuffled, 4}, 1, 6, 50));
    CHECK(shuffled != ascending);
    std::vector<int> sorted = shuffled;
    std::sort(sorted.begin(), sorted.end());
    CHECK(sorted == ascending);  // each thread ran once
}

TEST_CASE("each thread runs once in a shuffled order, whatever the sizes") {
    for (const int blocks : {1, 2, 3, 12, 97, 1000})
        for (const int threads : {1, 31, 64}) {
            CAPTURE(blocks);
            CAPTURE(threads);
            std::vector<int> tickets = tickets_in({Order::kShuffled, 7}, 2, blocks, threads);
            std::sort(tickets.begin(), tickets.end());
            std::vector<int> ascending(tickets.size());
            for (std::size_t i = 0; i < ascending.size(); ++i) ascending[i] = static_cast<int>(i);
            CHECK(tickets == ascending);
        }
}

TEST_CASE("a missing barrier is found and named") {
    const std::vector<int> values(64, 5);
    DeviceBuffer<int> on_device(values);
    const std::string found =
        cudasim::find_races([&] { reverse_kernel<false><<<1, 64>>>(on_device.data()); });
    CUDA_CHECK(cudaGetLastError());
    INFO(found);
    CHECK(found.find("kernel reverse_kernel<false> (launched at ") != std::string::npos);
    CHECK(found.find("thread_order.cu:") != std::string::npos);
    CHECK(found.find("word 0 (4 bytes each) of the 256 bytes allocated at ") != std::string::npos);
    CHECK(found.find("is nan (as an int 2147483647) in forward order, ") != std::string::npos);
    CHECK(found.find(" in reverse order") != std::string::npos);
}

TEST_CASE("writers of one place are found, within a block and between blocks") {
    DeviceBuffer<int> value(1);
    const std::string within = cudasim::find_races([&] { last_writer_kernel<<<1, 32>>>(value.data()); });
    CHECK(within.find("last_writer_kernel") != std::string::npos);
    CHECK(value.download()[0] == 31);  // the forward result stays
    const std::string between = cudasim::find_races([&] { last_writer_kernel<<<32, 1>>>(value.data()); });
    CHECK(between.find("last_writer_kernel") != std::string::npos);
}

TEST_CASE("clean kernels are not accused, and run once as far as memory shows") {
    std::vector<int> values(64);
    for (int i = 0; i < 64; ++i) values[i] = i;
    DeviceBuffer<int> on_device(values), sum(std::vector<int>{1000});
    const std::string found = cudasim::find_races([&] {
        reverse_kernel<true><<<1, 64>>>(on_device.data());
        clean_sum_kernel<<<1, 64>>>(sum.data(), on_device.data());
    });
    CUDA_CHECK(cudaGetLastError());
    CHECK(found == "");
    CHECK(sum.download()[0] == 1000 + 63 * 32);
    std::reverse(values.begin(), values.end());
    CHECK(on_device.download() == values);
}
