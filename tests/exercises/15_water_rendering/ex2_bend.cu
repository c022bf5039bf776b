// Exercise 15.2: rays bend as Snell says, and ripples focus the sun where a lens would.
#include "ex2_bend.cuh"

#include <vector>

#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

constexpr float kIndex = 1.333f;

std::vector<float2> landed(const std::vector<float>& x, glm::vec3 towards, water::Ripples ripples) {
    const course::DeviceBuffer<float> start(x);
    course::DeviceBuffer<float2> landing(x.size());
    water::land_kernel<<<int(x.size() + 31) / 32, 32>>>(landing.data(), start.data(), towards, kIndex,
                                                        ripples, int(x.size()));
    CUDA_CHECK(cudaGetLastError());
    return landing.download();
}

}  // namespace

TEST_CASE("head on nothing is bent") {
    course::set_hint(1);
    const glm::vec3 down(0, -1, 0), slanted = glm::normalize(glm::vec3(1, 2, -3));
    std::vector<glm::vec3> got{water::bend(down, -down, 1 / kIndex), water::bend(slanted, -slanted, kIndex)};
    course::check_close(got, std::vector<glm::vec3>{down, slanted}, course::Tolerance(3e-7), "direction",
                        "ray");
}

TEST_CASE("Snell: the sines are as the indices, in the same plane, and the length stays 1") {
    course::set_hint(2);
    std::vector<float> got, expected;
    for (const float degrees : {10.0f, 30.0f, 45.0f, 60.0f, 80.0f})
        for (const float ratio : {1 / kIndex, 1.0f, 1.1f}) {
            const float angle = degrees * 0.0174532925f, sine = std::sin(angle) * ratio;
            if (sine >= 0.99f) continue;
            // A plane that is turned about y, and a normal that points along -z.
            const glm::vec3 along(0.6f, 0.8f, 0);
            const glm::vec3 way =
                water::bend(std::sin(angle) * along + glm::vec3(0, 0, std::cos(angle)), {0, 0, -1}, ratio);
            for (const float value : {way.x, way.y, way.z}) got.push_back(value);
            for (const float value : {0.6f * sine, 0.8f * sine, std::sqrt(1 - sine * sine)})
                expected.push_back(value);
        }
    course::check_close(got, expected, course::Tolerance(2e-6), "direction",
                        "component");  // fp32, sine up to 0.98
}

TEST_CASE("steep light stays in the water") {
    course::set_hint(2);
    const glm::vec3 steep = glm::normalize(glm::vec3(1, 1, 0));  // 45 degrees: still out
    const glm::vec3 flat = glm::normalize(glm::vec3(3, 2, 0));  // 56 degrees: over the critical angle of 48.6
    const glm::vec3 out = water::bend(steep, {0, -1, 0}, kIndex), in = water::bend(flat, {0, -1, 0}, kIndex);
    course::check_close(std::vector<float>{out.x, in.x, in.y, in.z},
                        std::vector<float>{kIndex * steep.x, 0, 0, 0}, course::Tolerance(1e-6), "direction",
                        "component");
}

TEST_CASE("a level pool moves the slanted sun's photons by what Snell says") {
    course::set_hint(3);
    const float sine = 0.6f, bent = sine / kIndex, moved = 0.5f * bent / std::sqrt(1 - bent * bent);
    std::vector<float> x;
    std::vector<float2> expected;
    for (int k = 0; k < 70; ++k) {  // not a multiple of the block
        x.push_back(0.1f * float(k));
        expected.push_back(make_float2(x.back() + 0.8f * moved, -0.6f * moved));
    }
    course::check_close(landed(x, {0.8f * sine, -0.8f, -0.6f * sine}, {0.5f, 0, 3}), expected,
                        course::Tolerance(3e-6), "landing",
                        "photon");  // places up to 7 m: half a micrometre each
}

TEST_CASE("under a crest the sun comes to a point, as deep as a lens of that curve has its focus") {
    course::set_hint(3);
    // Near the crest a photon at x meets the slope -h k^2 x and turns by (1 - 1/n) of it.
    const float height = 0.002f, waves = 20, depth = 1 / ((1 - 1 / kIndex) * height * waves * waves);
    std::vector<float> x;
    std::vector<float2> expected;
    for (float place = -0.004f; place <= 0.004f; place += 0.001f) {
        x.push_back(place);
        expected.push_back(make_float2(0, 0));
    }
    // The crest is 2 mm higher than the level: 0.04 % of the depth. The third order of kx is 0.1 % of x.
    course::check_close(landed(x, {0, -1, 0}, {depth, height, waves}), expected, course::Tolerance(1.5e-5),
                        "landing", "photon");
}

TEST_CASE("photons of a ripple, one by one") {
    course::set_hint(3);
    // In double and by angles: the surface is tilted by a, the sun meets it at a, and goes on at asin(sin(a)
    // / n).
    std::vector<float> x;
    std::vector<float2> expected;
    for (double place = 0; place < 0.4; place += 0.01) {
        const double slope = -0.02 * 15 * std::sin(15 * place), tilt = std::atan(slope);
        const double turned = tilt - std::asin(std::sin(tilt) / kIndex);
        const double height = 0.3 + 0.02 * std::cos(15 * place);
        x.push_back(float(place));
        expected.push_back(make_float2(float(place + height * std::tan(turned)), 0));
    }
    course::check_close(landed(x, {0, -1, 0}, {0.3f, 0.02f, 15}), expected, course::Tolerance(1e-6),
                        "landing", "photon");
}
