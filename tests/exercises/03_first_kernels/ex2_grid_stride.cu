// Exercise 03.2: counts of a grid-stride loop, against chapter 01's loop.
#include "ex2_grid_stride.cuh"

#include "01_particle_loop/scenes.h"
#include "03_first_kernels/device_fountain.cuh"
#include "tests/support/course_test.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

using namespace first_kernels;

namespace {

/// n droplets of a running fountain.
std::vector<Particle> droplets(std::uint32_t n) {
    const Fountain fountain = particle_loop::make_scene("spray");
    std::vector<Particle> particles(n);
    for (std::uint32_t s = 0; s < 500; ++s) step(particles, fountain, s);
    return particles;
}

/// Several heights, from "all" to "none", against the host's count.
void check_counts(std::uint32_t n, unsigned blocks, unsigned threads_per_block) {
    const std::vector<Particle> particles = droplets(n);
    const Float4OnDevice device(particles);
    std::vector<int> got, expected;
    for (const float height_m : {-1.0f, 0.1f, 1.0f, 2.0f, 50.0f}) {
        got.push_back(count_above_on_device(device.position.data(), n, height_m, blocks, threads_per_block));
        expected.push_back(int(count_above(particles, n, height_m)));
    }
    course::check_equal(got, expected,
                        "count of " + std::to_string(n) + " droplets by " + std::to_string(blocks) +
                            " blocks of " + std::to_string(threads_per_block),
                        "height");
}

}  // namespace

TEST_CASE("one block, many droplets each") {
    course::set_hint(1);
    check_counts(1000, 1, 64);
}

TEST_CASE("several blocks, many droplets each") {
    course::set_hint(2);
    check_counts(5000, 4, 128);
    check_counts(4999, 3, 96);
}

TEST_CASE("as many threads as droplets, or nearly") {
    course::set_hint(2);
    check_counts(512, 2, 256);
    check_counts(513, 2, 256);
    check_counts(511, 2, 256);
}

TEST_CASE("more threads than droplets, and no droplets") {
    course::set_hint(3);
    check_counts(5, 4, 64);
    check_counts(1, 2, 256);
    CHECK(count_above_on_device(nullptr, 0, 0.0f, 2) == 0);
}

TEST_CASE("a droplet exactly at the height is not above it") {
    course::set_hint(1);
    const course::DeviceBuffer<float4> position(std::vector<float4>(100, make_float4(9, 2, 9, 9)));
    CHECK(count_above_on_device(position.data(), 100, 2.0f, 1) == 0);
    CHECK(count_above_on_device(position.data(), 100, 1.999f, 1) == 100);
}
