// Exercise 13.1: the phase function adds up to 1, has the mean cosine g, and points the right way.
#include "ex1_forward_scattering.cuh"

#include <vector>

#include "common/device_buffer.h"
#include "tests/support/course_test.h"

TEST_CASE("without a preference light goes evenly to all sides") {
    course::set_hint(1);
    std::vector<float> got, expected;
    for (float cosine = -1; cosine <= 1; cosine += 0.25f) {
        got.push_back(volume::phase(cosine, 0));
        expected.push_back(1 / (4 * volume::kPi));
    }
    course::check_close(got, expected, course::Tolerance(1e-7), "phase", "direction");  // a rounding of 0.08
}

TEST_CASE("straight ahead and straight back") {
    course::set_hint(1);
    std::vector<float> got, expected;
    for (const float g : {-0.5f, 0.3f, 0.8f}) {
        got.push_back(volume::phase(1, g));
        expected.push_back((1 + g) / (4 * volume::kPi * (1 - g) * (1 - g)));
        got.push_back(volume::phase(-1, g));
        expected.push_back((1 - g) / (4 * volume::kPi * (1 + g) * (1 + g)));
    }
    // At g = 0.8 the bracket is 0.04, a difference of numbers near 1.6: 1e-7 of those is 4e-6 of it.
    course::check_close(got, expected, course::Tolerance(0, 2e-5), "phase", "case");
}

TEST_CASE("over all directions it adds up to 1, and the mean cosine is g") {
    course::set_hint(2);
    std::vector<double> got, expected;
    for (const float g : {-0.6f, 0.0f, 0.4f, 0.7f}) {
        double sum = 0, mean = 0;
        constexpr int kRings = 20000;  // rings of equal solid angle
        for (int k = 0; k < kRings; ++k) {
            const double cosine = -1 + 2 * (k + 0.5) / kRings, part = 4 * 3.14159265358979 / kRings;
            sum += part * volume::phase(float(cosine), g);
            mean += part * cosine * volume::phase(float(cosine), g);
        }
        got.push_back(sum), expected.push_back(1);
        got.push_back(mean), expected.push_back(g);
    }
    course::check_close(got, expected, course::Tolerance(1e-5), "sum", "case");  // fp32 values, midpoint rule
}

TEST_CASE("smoke between lamp and eye shines, smoke behind the lamp is dull") {
    course::set_hint(3);
    const glm::vec3 lamp(0, 0, 0), eye(0, 0, 5);
    const std::vector<float4> puffs{make_float4(0, 0, 2, 0), make_float4(0, 0, -2, 0),
                                    make_float4(3, 0, 0, 0), make_float4(0, 0.01f, 4, 0),
                                    make_float4(0, -7, 5, 0)};
    const course::DeviceBuffer<float4> puff(puffs);
    course::DeviceBuffer<float> light(puffs.size());
    volume::scattered_kernel<<<1, 32>>>(light.data(), puff.data(), lamp, eye, 0.6f, int(puffs.size()));
    CUDA_CHECK(cudaGetLastError());
    std::vector<float> expected;
    for (const float4& p : puffs) {
        const double x = p.x, y = p.y, z = p.z, to_eye = std::sqrt(x * x + y * y + (5 - z) * (5 - z));
        const double cosine = (-x * x - y * y + z * (5 - z)) / (std::sqrt(x * x + y * y + z * z) * to_eye);
        expected.push_back(float(0.64 / (4 * 3.14159265358979 * std::pow(1.36 - 1.2 * cosine, 1.5))));
    }
    course::check_close(light.download(), expected, course::Tolerance(0, 2e-5), "light", "puff");
}
