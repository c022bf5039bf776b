// Atomics and the functions that kernels may call without including anything.
#include <cuda_runtime.h>

#include <cmath>
#include <limits>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

using course::DeviceBuffer;

namespace {

struct Totals {
    int sum, difference, smallest, largest, last, bits_and, bits_or, bits_xor;
    unsigned cycle_up, cycle_down, claimed;
    unsigned long long wide_sum;
    float float_sum;
    double double_sum;
};

__global__ void atomics_kernel(Totals* totals) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    atomicAdd(&totals->sum, i);
    atomicSub(&totals->difference, i);
    atomicMin(&totals->smallest, (i * 7919) % 10007 - 5000);
    atomicMax(&totals->largest, (i * 7919) % 10007 - 5000);
    atomicExch(&totals->last, 4);
    atomicAnd(&totals->bits_and, ~(1 << (i % 5)));
    atomicOr(&totals->bits_or, 1 << (i % 5));
    atomicXor(&totals->bits_xor, i);
    atomicInc(&totals->cycle_up, 6);
    atomicDec(&totals->cycle_down, 6);
    if (atomicCAS(&totals->claimed, 0u, 1u) == 0u)
        atomicAdd(&totals->claimed, 10u);  // one thread finds the 0
    atomicAdd(&totals->wide_sum, 1ull << 33);
    atomicAdd(&totals->float_sum, 0.5f);
    atomicAdd(&totals->double_sum, 0.25);
}

struct Bits {
    int population, leading, first, as_int;
    unsigned reversed, as_uint, high;
    float from_int;
};

__global__ void bits_kernel(Bits* results, const int* inputs) {
    const int x = inputs[threadIdx.x];
    results[threadIdx.x] = {__popc(x),
                            __clz(x),
                            __ffs(x),
                            __float_as_int(static_cast<float>(x)),
                            __brev(x),
                            __float_as_uint(-0.0f),
                            __umulhi(static_cast<unsigned>(x), 0x10000u),
                            __int_as_float(0x40490fdb)};
}

struct Numbers {
    float inverse_root, quotient, saturated, exponential, smaller, larger, not_nan, product, loaded;
    int nearest, mixed_minimum;
};

__global__ void numbers_kernel(Numbers* results, const float* inputs) {
    const float x = inputs[threadIdx.x];
    results[threadIdx.x] = {rsqrtf(x),
                            __fdividef(1.0f, x),
                            __saturatef(x),
                            __expf(-x),
                            min(x, 1.0f),
                            max(x, 1.0f),
                            fminf(NAN, x),
                            __fmul_rn(x, x),
                            __ldg(&inputs[threadIdx.x]),
                            __float2int_rn(x),
                            min(static_cast<int>(x), 2)};
}

}  // namespace

TEST_CASE("atomics from many blocks") {
    constexpr int kThreads = 64 * 100;
    Totals start{};
    start.smallest = std::numeric_limits<int>::max();
    start.largest = std::numeric_limits<int>::min();
    start.bits_and = 0xff;
    DeviceBuffer<Totals> totals(std::vector<Totals>{start});
    atomics_kernel<<<100, 64>>>(totals.data());
    CUDA_CHECK(cudaGetLastError());
    const Totals got = totals.download()[0];

    Totals expected = start;
    for (int i = 0; i < kThreads; ++i) {
        expected.sum += i;
        expected.smallest = std::min(expected.smallest, (i * 7919) % 10007 - 5000);
        expected.largest = std::max(expected.largest, (i * 7919) % 10007 - 5000);
        expected.bits_xor ^= i;
    }
    CHECK(got.sum == expected.sum);
    CHECK(got.difference == -expected.sum);
    CHECK(got.smallest == expected.smallest);
    CHECK(got.largest == expected.largest);
    CHECK(got.last == 4);
    CHECK(got.bits_and == 0xe0);
    CHECK(got.bits_or == 0x1f);
    CHECK(got.bits_xor == expected.bits_xor);
    CHECK(got.cycle_up == kThreads % 7);
    CHECK(got.cycle_down == (7 - kThreads % 7) % 7);
    CHECK(got.claimed == 11u);
    CHECK(got.wide_sum == (1ull << 33) * kThreads);
    CHECK(got.float_sum == 0.5f * kThreads);  // exact: the sum stays far below 2^23
    CHECK(got.double_sum == 0.25 * kThreads);
}

TEST_CASE("functions on bits") {
    const std::vector<int> inputs = {0, 1, 2, 12345, -1, std::numeric_limits<int>::min()};
    const DeviceBuffer<int> on_device(inputs);
    DeviceBuffer<Bits> results(inputs.size());
    bits_kernel<<<1, static_cast<unsigned>(inputs.size())>>>(results.data(), on_device.data());
    CUDA_CHECK(cudaGetLastError());
    const std::vector<Bits> got = results.download();
    const int population[] = {0, 1, 1, 6, 32, 1}, leading[] = {32, 31, 30, 18, 0, 0},
              first[] = {0, 1, 2, 1, 1, 32};
    const unsigned reversed[] = {0, 0x80000000u, 0x40000000u, 0x9c0c0000u, 0xffffffffu, 1u};
    const int as_int[] = {
        0, 0x3f800000, 0x40000000, 0x4640e400, static_cast<int>(0xbf800000u), static_cast<int>(0xcf000000u)};
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        CAPTURE(inputs[i]);
        CHECK(got[i].population == population[i]);
        CHECK(got[i].leading == leading[i]);
        CHECK(got[i].first == first[i]);
        CHECK(got[i].reversed == reversed[i]);
        CHECK(got[i].as_int == as_int[i]);
        CHECK(got[i].as_uint == 0x80000000u);
        CHECK(got[i].high == static_cast<unsigned>(inputs[i]) >> 16);
        CHECK(got[i].from_int == 3.14159274f);
    }
}

TEST_CASE("functions on numbers") {
    const std::vector<float> inputs = {0.25f, 1.0f, 2.5f, 9.0f};
    const DeviceBuffer<float> on_device(inputs);
    DeviceBuffer<Numbers> results(inputs.size());
    numbers_kernel<<<1, static_cast<unsigned>(inputs.size())>>>(results.data(), on_device.data());
    CUDA_CHECK(cudaGetLastError());
    const std::vector<Numbers> got = results.download();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const float x = inputs[i];
        CAPTURE(x);
        // The fast functions are good to a few units in the last place (2^-23); on a GPU __expf of -9 to
        // about 2^-19.
        CHECK(got[i].inverse_root == doctest::Approx(1.0f / std::sqrt(x)).epsilon(1e-6));
        CHECK(got[i].quotient == doctest::Approx(1.0f / x).epsilon(1e-6));
        CHECK(got[i].exponential == doctest::Approx(std::exp(-x)).epsilon(1e-5));
        CHECK(got[i].saturated == std::min(x, 1.0f));
        CHECK(got[i].smaller == std::min(x, 1.0f));
        CHECK(got[i].larger == std::max(x, 1.0f));
        CHECK(got[i].not_nan == x);
        CHECK(got[i].product == x * x);
        CHECK(got[i].loaded == x);
        CHECK(got[i].nearest == static_cast<int>(std::nearbyint(x)));
        CHECK(got[i].mixed_minimum == std::min(static_cast<int>(x), 2));
    }
}
