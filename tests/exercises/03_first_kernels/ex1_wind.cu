// Exercise 03.1: the wind on n droplets, against a loop; memory behind them; n = 0; the launch itself.
#include "ex1_wind.cuh"

#include "common/device_buffer.h"
#include "tests/support/course_test.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

using namespace first_kernels;

namespace {

const float3 kWind{5, 0, -3};
constexpr float kShare = 0.25f;
constexpr std::uint32_t kBehind = 2048;  // elements behind the n droplets, not to be touched

std::vector<float4> velocities(std::uint32_t n) {
    std::vector<float4> v;
    for (std::uint32_t i = 0; i < n + kBehind; ++i)
        v.push_back(make_float4(float(i % 17), 8.0f - float(i % 5), float(i % 3), float(i)));
    return v;
}

void check_blown(std::uint32_t n) {
    const std::vector<float4> before = velocities(n);
    std::vector<float4> expected = before;
    for (std::uint32_t i = 0; i < n; ++i) {
        float4& v = expected[i];
        v.x += kShare * (kWind.x - v.x);
        v.y += kShare * (kWind.y - v.y);
        v.z += kShare * (kWind.z - v.z);
    }
    course::DeviceBuffer<float4> device(before);
    blow(device.data(), n, kWind, kShare);
    // Two roundings of numbers below 16, or one if the device fuses them: 2 * 4.8e-7.
    course::check_close(device.download(), expected, course::Tolerance(1e-6),
                        "velocity with " + std::to_string(n) + " droplets (behind them: unchanged)",
                        "droplet");
}

}  // namespace

TEST_CASE("256 droplets: one full block") {
    course::set_hint(1);
    check_blown(256);
}

TEST_CASE("1, 255, 257 and 1000 droplets: the last block is not full") {
    course::set_hint(2);
    for (const std::uint32_t n : {1u, 255u, 257u, 1000u}) check_blown(n);
}

TEST_CASE("no droplets: no launch, no error") {
    course::set_hint(3);
    CHECK_NOTHROW(check_blown(0));
    CHECK(cudaGetLastError() == cudaSuccess);
}

TEST_CASE("one launch, with as many blocks as are needed and no more") {
    course::set_hint(2);
    course::require_simulator();
#ifdef __CUDASIM__
    course::DeviceBuffer<float4> device(velocities(1000));
    const cudasim::Recording recording;
    blow(device.data(), 1000, kWind, kShare);
    CHECK(recording.count("wind_kernel") == 1);
    if (recording.launches().size() == 1) CHECK(recording.launches()[0].grid.x == 4);
#endif
}

TEST_CASE("an error of a launch is reported") {
    course::set_hint(3);
    course::DeviceBuffer<float4> device(velocities(1));
    fountain_clear_kernel<<<1, 1025>>>(device.data(), device.data(), 1);  // too many threads, and not checked
    CHECK_THROWS_AS(blow(device.data(), 1, kWind, kShare), course::CudaError);
    cudaGetLastError();
}
