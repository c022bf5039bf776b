// Exercise 08.1: transposed stretching, against a difference quotient and against the law it keeps.
#include "ex1_transposed_stretching.cuh"

#include "01_particle_loop/particle_loop.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

using namespace vortex;
using Points = std::vector<float4>;

constexpr float kCore_m = 0.3f;

struct Cloud {
    Points position, strength;
};
Cloud random_cloud(std::uint32_t n, std::uint64_t seed) {
    Cloud cloud;
    for (std::uint32_t i = 0; i < n; ++i) {
        const particle_loop::Uniforms r = particle_loop::random_start(seed, i, 0);
        cloud.position.push_back(make_float4(r.u[0], r.u[1], r.u[2], 7));
        cloud.strength.push_back(make_float4(2 * r.u[3] - 1, 2 * r.u[4] - 1, 2 * r.u[5] - 1, 9));
    }
    return cloud;
}

Points rates(const Cloud& cloud) {
    const std::uint32_t n = std::uint32_t(cloud.position.size());
    const course::DeviceBuffer<float4> position(cloud.position), strength(cloud.strength);
    course::DeviceBuffer<float4> rate(n);
    transposed_stretching_kernel<<<(n + 31) / 32, 32>>>(rate.data(), position.data(), strength.data(), n,
                                                        kCore_m * kCore_m);
    CUDA_CHECK(cudaGetLastError());
    return rate.download();
}

/// Component k: alpha_i . du/dx_k, by a central difference of the velocity in double.
glm::dvec3 by_differences(const Cloud& cloud, std::size_t i) {
    glm::dvec3 rate(0);
    const double h = 1e-5;  // its square times the third derivative, 1 / core^5: 1e-7
    for (int k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < cloud.position.size(); ++j) {
            glm::dvec3 step(0);
            step[k] = h;
            const glm::dvec3 r = glm::dvec3(xyz(cloud.position[i])) - glm::dvec3(xyz(cloud.position[j]));
            const glm::dvec3 alpha(xyz(cloud.strength[j]));
            const glm::dvec3 change = induced_velocity(alpha, r + step, double(kCore_m)) -
                                      induced_velocity(alpha, r - step, double(kCore_m));
            rate[k] += glm::dot(glm::dvec3(xyz(cloud.strength[i])), change) / (2 * h);
        }
    return rate;
}

void check_cloud(const Cloud& cloud, double tolerance) {
    Points expected;
    for (std::size_t i = 0; i < cloud.position.size(); ++i) {
        const glm::dvec3 e = by_differences(cloud, i);
        expected.push_back(make_float4(float(e.x), float(e.y), float(e.z), 0));
    }
    course::check_close(rates(cloud), expected, {tolerance}, "rate", "vorton");
}

}  // namespace

TEST_CASE("two vortons: the rate is the slope of the velocity") {
    course::set_seed(2);
    course::set_hint(1);
    check_cloud(random_cloud(2, 2), 1e-4);  // rates are near 1; fp32, and the difference quotient's 1e-7
}

TEST_CASE("what one gives the other takes: 33 vortons, a block and one more") {
    course::set_seed(3);
    course::set_hint(3);
    const Points rate = rates(random_cloud(33, 3));
    REQUIRE(rate.size() == 33);
    glm::dvec3 total(0), largest(0);
    for (const float4& r : rate) {
        total += glm::dvec3(xyz(r));
        largest = glm::max(largest, glm::abs(glm::dvec3(xyz(r))));
    }
    CHECK(glm::length(largest) > 0.1);
    CHECK(glm::length(total) < 1e-5 * 33 * glm::length(largest));  // fp32 rounding of 33 sums
}

TEST_CASE("a cloud of 40 vortons against differences") {
    course::set_seed(4);
    course::set_hint(2);
    check_cloud(random_cloud(40, 4), 1e-3);  // sums of 40 rates of a few units
}

TEST_CASE("alone, or both at one point: no stretching, no NaN") {
    course::set_hint(3);
    const Cloud one{{make_float4(1, 2, 3, 0)}, {make_float4(1, 0, 2, 0)}};
    course::check_equal(rates(one), Points{make_float4(0, 0, 0, 0)}, "rate", "vorton");
    const Cloud both{{make_float4(0, 0, 0, 0), make_float4(0, 0, 0, 0)},
                     {make_float4(1, 0, 0, 0), make_float4(0, 1, 0, 0)}};
    const float f = float(2.5 / (4 * kPi)) / (kCore_m * kCore_m * kCore_m);
    course::check_close(rates(both), Points{make_float4(0, 0, f, 0), make_float4(0, 0, -f, 0)}, {1e-4},
                        "rate", "vorton");
}
