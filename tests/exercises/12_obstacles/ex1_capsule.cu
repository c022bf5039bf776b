// Exercise 12.1: a capsule's distance and way out, against points of its surface and against a sphere.
#include "ex1_capsule.cuh"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

using obstacles::Capsule;

const Capsule kStick{{-0.3f, 0.1f, 0.2f}, {0.5f, 0.3f, -0.1f}, 0.15f};

/// One thread per point.
__global__ void evaluate_kernel(float4* normal_and_distance, const float4* x, Capsule capsule,
                                std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 at(x[i].x, x[i].y, x[i].z), normal = obstacles::outward(capsule, at);
    normal_and_distance[i] =
        make_float4(normal.x, normal.y, normal.z, obstacles::signed_distance(capsule, at));
}

std::vector<float4> evaluate(const Capsule& capsule, const std::vector<float4>& x) {
    course::DeviceBuffer<float4> points(x), results(x.size());
    const std::uint32_t n = std::uint32_t(x.size());
    evaluate_kernel<<<(n + 127) / 128, 128>>>(results.data(), points.data(), capsule, n);
    CUDA_CHECK(cudaGetLastError());
    return results.download();
}

std::vector<float4> random_points(std::uint32_t n) {
    course::set_seed(12);
    std::mt19937 random(12);
    std::uniform_real_distribution<float> at(-0.8f, 0.8f);
    std::vector<float4> points;
    for (std::uint32_t i = 0; i < n; ++i) {
        const float x = at(random), y = at(random), z = at(random);
        points.push_back(make_float4(x, y, z, 0));
    }
    return points;
}

/// Distance to the segment by trying 4001 points of it.
double segment_distance(const Capsule& c, const float4& x) {
    double nearest = 1e30;
    for (int k = 0; k <= 4000; ++k) {
        const double t = k / 4000.0;
        const double dx = x.x - (c.from_m.x + t * (c.to_m.x - c.from_m.x));
        const double dy = x.y - (c.from_m.y + t * (c.to_m.y - c.from_m.y));
        const double dz = x.z - (c.from_m.z + t * (c.to_m.z - c.from_m.z));
        nearest = std::min(nearest, std::sqrt(dx * dx + dy * dy + dz * dz));
    }
    return nearest;
}

std::vector<float> distances(const std::vector<float4>& results) {
    std::vector<float> values;
    for (const float4& r : results) values.push_back(r.w);
    return values;
}

}  // namespace

TEST_CASE("distance is that to the nearest of many points of the segment, minus the radius") {
    course::set_hint(2);
    const auto x = random_points(500);
    std::vector<float> expected;
    for (const float4& point : x)
        expected.push_back(float(segment_distance(kStick, point) - kStick.radius_m));
    // The points tried are 2e-4 m apart: from the axis, at most 1e-4 m along it is missed. On the axis itself
    // that would be the error; a point of this cloud is farther away.
    course::check_close(distances(evaluate(kStick, x)), expected, {1e-5}, "distance", "point");
}

TEST_CASE("the way out is one long, and leads to the surface") {
    course::set_hint(3);
    const auto x = random_points(500);
    const auto got = evaluate(kStick, x);
    std::vector<float4> on_surface;
    std::vector<float> lengths;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const float4 r = got[i];
        lengths.push_back(std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z));
        on_surface.push_back(make_float4(x[i].x - r.w * r.x, x[i].y - r.w * r.y, x[i].z - r.w * r.z, 0));
    }
    // fp32: roundings of numbers around 1
    if (course::check_close(lengths, std::vector<float>(x.size(), 1.0f), {1e-6}, "length of the way out",
                            "point"))
        course::check_close(distances(evaluate(kStick, on_surface)), std::vector<float>(x.size(), 0.0f),
                            {1e-6}, "distance after that way", "point");
}

TEST_CASE("a segment without length is a sphere") {
    course::set_hint(2);
    const Capsule ball{{0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}, 0.25f};
    const auto x = random_points(100);
    std::vector<float> expected;
    for (const float4& p : x)
        expected.push_back(std::sqrt((p.x - 0.1f) * (p.x - 0.1f) + (p.y - 0.2f) * (p.y - 0.2f) +
                                     (p.z - 0.3f) * (p.z - 0.3f)) -
                           0.25f);
    course::check_close(distances(evaluate(ball, x)), expected, {1e-6}, "distance", "point");
}

TEST_CASE("on the segment itself the way out is up, or along x where the segment leads up") {
    course::set_hint(3);
    const Capsule lying{{-1, 0, 0}, {1, 0, 0}, 0.5f}, upright{{0, -1, 0}, {0, 1, 0}, 0.5f},
        none{glm::vec3(0), glm::vec3(0), 0.5f};
    const std::vector<float4> middle(1, make_float4(0, 0, 0, 0)), up{make_float4(0, 1, 0, -0.5f)},
        across{make_float4(1, 0, 0, -0.5f)};
    course::check_equal(evaluate(lying, middle), up, "way out and distance, lying,", "point");
    course::check_equal(evaluate(upright, middle), across, "way out and distance, upright,", "point");
    course::check_equal(evaluate(none, middle), up, "way out and distance, without length,", "point");
}
