// Shuffles, votes and barriers with a result, against what CUDA's programming guide says of each.
#include <cuda_runtime.h>

#include <functional>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

constexpr unsigned kAllLanes = 0xffffffffu;

struct Shuffles {
    int get, up, down, exchanged;
};

__global__ void shuffle_kernel(Shuffles* results, int amount, int width) {
    const int mine = 100 + static_cast<int>(threadIdx.x);
    results[threadIdx.x] = {
        __shfl_sync(kAllLanes, mine, amount, width), __shfl_up_sync(kAllLanes, mine, amount, width),
        __shfl_down_sync(kAllLanes, mine, amount, width), __shfl_xor_sync(kAllLanes, mine, amount, width)};
}

__global__ void wide_types_kernel(double* reversed, unsigned long long* rotated) {
    const int lane = threadIdx.x % 32;
    reversed[threadIdx.x] = __shfl_xor_sync(kAllLanes, 0.5 * threadIdx.x, 31);
    rotated[threadIdx.x] = __shfl_sync(kAllLanes, (1ull << 40) + threadIdx.x, lane + 1);
}

__global__ void vote_kernel(unsigned* ballots, int* any, int* all, int divisor) {
    const int predicate = threadIdx.x % divisor == 0;
    ballots[threadIdx.x] = __ballot_sync(kAllLanes, predicate);
    any[threadIdx.x] = __any_sync(kAllLanes, predicate);
    all[threadIdx.x] = __all_sync(kAllLanes, predicate);
}

/// The even lanes have ended; the odd ones name only each other.
__global__ void partial_mask_kernel(int* results) {
    results[threadIdx.x] = -1;
    if (threadIdx.x % 2 == 0) return;
    results[threadIdx.x] = __shfl_sync(0xaaaaaaaau, static_cast<int>(threadIdx.x), 5);
}

/// Two halves of a warp go different ways, each with its own mask.
__global__ void two_groups_kernel(int* results) {
    int sum = static_cast<int>(threadIdx.x);
    const unsigned mask = threadIdx.x < 16 ? 0x0000ffffu : 0xffff0000u;
    if (threadIdx.x < 16)
        for (int offset = 8; offset > 0; offset /= 2) sum += __shfl_xor_sync(mask, sum, offset);
    else
        for (int offset = 8; offset > 0; offset /= 2) sum -= __shfl_xor_sync(mask, sum, offset);
    results[threadIdx.x] = sum;
}

/// Neighbouring lanes hand values round in shared memory, with __syncwarp in between.
__global__ void syncwarp_kernel(int* results) {
    __shared__ int slots[64];
    int value = static_cast<int>(threadIdx.x);
    const unsigned neighbour = (threadIdx.x & ~31u) | ((threadIdx.x + 1) & 31u);
    for (int round = 0; round < 5; ++round) {
        slots[threadIdx.x] = value;
        __syncwarp();
        value = slots[neighbour];
        __syncwarp();
    }
    results[threadIdx.x] = value;
}

struct BlockVotes {
    int count, all, any;
};

__global__ void block_vote_kernel(BlockVotes* results, int limit) {
    const int predicate = static_cast<int>(threadIdx.x) < limit;
    const int count = __syncthreads_count(predicate);
    const int all = __syncthreads_and(predicate);
    const int any = __syncthreads_or(predicate);
    results[threadIdx.x] = {count, all, any};
}

}  // namespace

TEST_CASE("the four shuffles for every distance and width") {
    DeviceBuffer<Shuffles> results(64);
    for (const int width : {2, 4, 8, 16, 32})
        for (int amount = 0; amount < 32; ++amount) {
            CAPTURE(width);
            CAPTURE(amount);
            shuffle_kernel<<<1, 64>>>(results.data(), amount, width);
            CUDA_CHECK(cudaGetLastError());
            std::vector<int> get, up, down, exchanged, expect_get, expect_up, expect_down, expect_exchanged;
            const std::vector<Shuffles> got = results.download();
            for (int t = 0; t < 64; ++t) {
                const int first = t / width * width, last = first + width - 1;  // of the group
                get.push_back(got[t].get);
                up.push_back(got[t].up);
                down.push_back(got[t].down);
                exchanged.push_back(got[t].exchanged);
                expect_get.push_back(100 + first + amount % width);
                expect_up.push_back(100 + (t - amount >= first ? t - amount : t));
                expect_down.push_back(100 + (t + amount <= last ? t + amount : t));
                expect_exchanged.push_back(100 + ((t ^ amount) <= last ? t ^ amount : t));
            }
            course::check_equal(get, expect_get, "__shfl_sync", "thread");
            course::check_equal(up, expect_up, "__shfl_up_sync", "thread");
            course::check_equal(down, expect_down, "__shfl_down_sync", "thread");
            course::check_equal(exchanged, expect_exchanged, "__shfl_xor_sync", "thread");
        }
}

TEST_CASE("shuffles of 8-byte types") {
    DeviceBuffer<double> reversed(64);
    DeviceBuffer<unsigned long long> rotated(64);
    wide_types_kernel<<<1, 64>>>(reversed.data(), rotated.data());
    CUDA_CHECK(cudaGetLastError());
    std::vector<double> expect_reversed(64);
    std::vector<unsigned long long> expect_rotated(64);
    for (unsigned t = 0; t < 64; ++t) {
        expect_reversed[t] = 0.5 * (t ^ 31u);
        expect_rotated[t] = (1ull << 40) + ((t & ~31u) | ((t + 1) & 31u));
    }
    course::check_equal(reversed.download(), expect_reversed, "reversed", "thread");
    course::check_equal(rotated.download(), expect_rotated, "rotated", "thread");
}

TEST_CASE("votes of a warp") {
    DeviceBuffer<unsigned> ballots(32);
    DeviceBuffer<int> any(32), all(32);
    for (const int divisor : {1, 2, 3, 31, 32}) {
        CAPTURE(divisor);
        vote_kernel<<<1, 32>>>(ballots.data(), any.data(), all.data(), divisor);
        CUDA_CHECK(cudaGetLastError());
        unsigned expected = 0;
        for (int lane = 0; lane < 32; lane += divisor) expected |= 1u << lane;
        course::check_equal(ballots.download(), std::vector<unsigned>(32, expected), "ballot", "lane");
        course::check_equal(any.download(), std::vector<int>(32, 1), "any", "lane");
        course::check_equal(all.download(), std::vector<int>(32, divisor == 1), "all", "lane");
    }
}

TEST_CASE("lanes that have ended are not waited for") {
    DeviceBuffer<int> results(32);
    partial_mask_kernel<<<1, 32>>>(results.data());
    CUDA_CHECK(cudaGetLastError());
    std::vector<int> expected(32);
    for (int lane = 0; lane < 32; ++lane) expected[lane] = lane % 2 ? 5 : -1;
    course::check_equal(results.download(), expected, "shuffled", "lane");
}

TEST_CASE("two groups of a warp go different ways") {
    DeviceBuffer<int> results(32);
    two_groups_kernel<<<1, 32>>>(results.data());
    CUDA_CHECK(cudaGetLastError());
    std::vector<int> expected(32);
    const auto combine = [](std::vector<int>& values, int begin,
                            const std::function<int(int, int)>& operation) {
        for (int offset = 8; offset > 0; offset /= 2) {
            const std::vector<int> before = values;
            for (int i = begin; i < begin + 16; ++i) values[i] = operation(before[i], before[i ^ offset]);
        }
    };
    for (int i = 0; i < 32; ++i) expected[i] = i;
    combine(expected, 0, std::plus<int>());
    combine(expected, 16, std::minus<int>());
    course::check_equal(results.download(), expected, "sum", "lane");
}

TEST_CASE("__syncwarp orders shared memory") {
    DeviceBuffer<int> results(64);
    syncwarp_kernel<<<1, 64>>>(results.data());
    CUDA_CHECK(cudaGetLastError());
    std::vector<int> expected(64);
    for (unsigned t = 0; t < 64; ++t) expected[t] = static_cast<int>((t & ~31u) | ((t + 5) & 31u));
    course::check_equal(results.download(), expected, "value after five rounds", "thread");
}

TEST_CASE("barriers that count and vote") {
    DeviceBuffer<BlockVotes> results(100);
    for (const int limit : {0, 1, 37, 100}) {
        CAPTURE(limit);
        block_vote_kernel<<<1, 100>>>(results.data(), limit);
        CUDA_CHECK(cudaGetLastError());
        std::vector<int> count, all, any;
        for (const BlockVotes& votes : results.download()) {
            count.push_back(votes.count);
            all.push_back(votes.all != 0);
            any.push_back(votes.any != 0);
        }
        course::check_equal(count, std::vector<int>(100, limit), "count", "thread");
        course::check_equal(all, std::vector<int>(100, limit == 100), "all", "thread");
        course::check_equal(any, std::vector<int>(100, limit > 0), "any", "thread");
    }
}
