// Exercise 10.5: multipliers that push and never pull, one by one and in a row of particles that lean on one
// another.
#include "ex5_never_pulls.cuh"

#include <cmath>
#include <vector>

#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

/// One thread per particle.
__global__ void correct_kernel(float* multiplier, float* change, const float* density, float rest_density,
                               float response, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const sph::Correction next = sph::corrected(multiplier[i], density[i], rest_density, response);
    multiplier[i] = next.multiplier;
    change[i] = next.change;
}

struct Corrected {
    std::vector<float> multiplier, change;
};

Corrected correct(const std::vector<float>& multiplier, const std::vector<float>& density, float rest_density,
                  float response) {
    course::DeviceBuffer<float> m(multiplier), c(std::vector<float>(multiplier.size(), 0.0f)), rho(density);
    correct_kernel<<<1, 64>>>(m.data(), c.data(), rho.data(), rest_density, response,
                              std::uint32_t(multiplier.size()));
    CUDA_CHECK(cudaGetLastError());
    return {m.download(), c.download()};
}

}  // namespace

TEST_CASE("pressed water is pushed apart, by a part of what it would need alone") {
    course::set_hint(1);
    const Corrected got = correct({0, 0, 3}, {1000, 1010, 1020}, 1000, 4);
    course::check_close(got.change, std::vector<float>{0, 1.25f, 2.5f}, {1e-6}, "change", "particle");
    course::check_close(got.multiplier, std::vector<float>{0, 1.25f, 5.5f}, {1e-6}, "multiplier", "particle");
}

TEST_CASE("what was given too much is taken back") {
    course::set_hint(2);
    const Corrected got = correct({3, 3}, {992, 996}, 1000, 4);
    course::check_close(got.change, std::vector<float>{-1, -0.5f}, {1e-6}, "change", "particle");
    course::check_close(got.multiplier, std::vector<float>{2, 2.5f}, {1e-6}, "multiplier", "particle");
}

TEST_CASE("thin water at the surface is not pulled together") {
    course::set_hint(3);
    const Corrected got = correct({0, 1, 3}, {700, 700, 700}, 1000, 4);
    course::check_close(got.change, std::vector<float>{0, -1, -3}, {1e-6}, "change", "particle");
    course::check_close(got.multiplier, std::vector<float>{0, 0, 0}, {1e-6}, "multiplier", "particle");
}

TEST_CASE("a row of particles comes to rest: nobody is pressed, nobody pulls") {
    course::set_hint(3);
    // Each multiplier lowers the density of its particle by 1, of the next ones by 0.65 and 0.2: a
    // multiplier's whole step at once would overshoot, since neighbours help each other by 1.7 more.
    const std::vector<float> start{1005, 1003, 992, 1004, 980, 999, 1006, 1002};
    const int n = int(start.size());
    std::vector<float> multiplier(n, 0.0f), density = start;
    for (int k = 0; k < 500; ++k) {
        const Corrected next = correct(multiplier, density, 1000, 1);
        multiplier = next.multiplier;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const int apart = std::abs(i - j);
                density[i] -= (apart == 0   ? 1.0f
                               : apart == 1 ? 0.65f
                               : apart == 2 ? 0.2f
                                            : 0.0f) *
                              next.change[j];
            }
    }
    // 500 corrections, each rounding a density near 1000 by up to 3e-5, at random: 1e-3 at most.
    for (int i = 0; i < n; ++i) {
        INFO("particle " << i);
        CHECK(density[i] < 1000.005f);
        CHECK(multiplier[i] >= 0);
        CHECK((multiplier[i] < 1e-3f ||
               std::abs(density[i] - 1000) < 5e-3f));  // who is not pressed does not push
    }
}
