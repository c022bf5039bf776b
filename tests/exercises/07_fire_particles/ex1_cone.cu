// Exercise 07.1: directions in a cone, against the areas of a sphere.
#include "ex1_cone.cuh"

#include "tests/support/course_test.h"

using namespace fire;

namespace {

constexpr std::uint32_t kSparks = 40000;

std::vector<float4> sparks(glm::vec3 axis, float half_angle_rad) {
    course::set_seed(7);
    course::DeviceBuffer<float4> direction(kSparks);
    cone_kernel<<<first_kernels::blocks_for(kSparks), first_kernels::kThreadsPerBlock>>>(
        direction.data(), kSparks, axis, half_angle_rad, 7);
    CUDA_CHECK(cudaGetLastError());
    return direction.download();
}

constexpr float kPi = 3.14159265f;

}  // namespace

TEST_CASE("directions have length 1 and stay in their cone") {
    course::set_hint(1);
    for (const float angle : {0.01f, 0.349f, 1.2f}) {
        CAPTURE(angle);
        const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, -3));
        float longest = 0, shortest = 1e9f, widest = 0, narrowest = 1e9f;
        for (const float4 d : sparks(axis, angle)) {
            const glm::vec3 way(d.x, d.y, d.z);
            longest = std::max(longest, glm::length(way)), shortest = std::min(shortest, glm::length(way));
            const float off = std::asin(std::min(1.0f, glm::length(glm::cross(way, axis))));
            widest = std::max(widest, off), narrowest = std::min(narrowest, off);
        }
        CHECK(std::abs(longest - 1) <= 1e-5f);  // fp32: a few roundings
        CHECK(std::abs(shortest - 1) <= 1e-5f);
        CHECK(widest <= angle * 1.001f);
        CHECK(widest >= angle * 0.99f);  // the outermost of 40000 is within 1/40000 of the area
        CHECK(narrowest <= angle * 0.03f);
    }
}

TEST_CASE("equal areas get equally many") {
    course::set_hint(2);
    for (const float angle : {0.349f, kPi / 2, kPi}) {
        CAPTURE(angle);
        const glm::vec3 axis = glm::normalize(glm::vec3(-1, 0.3f, 2));
        const glm::vec3 x = glm::normalize(glm::cross(axis, glm::vec3(0, 1, 0))), y = glm::cross(axis, x);
        std::vector<double> bins(80);  // 10 rings of equal area, 8 parts around
        for (const float4 d : sparks(axis, angle)) {
            const glm::vec3 way(d.x, d.y, d.z);
            const float ring = (1 - glm::dot(way, axis)) / (1 - std::cos(angle));
            const float turn = std::atan2(glm::dot(way, y), glm::dot(way, x)) / (2 * kPi) + 0.5f;
            // Through clamp first: what a stub returns would not fit into an int.
            bins[10 * int(std::min(std::max(8 * turn, 0.0f), 7.0f)) +
                 int(std::min(std::max(10 * ring, 0.0f), 9.0f))] += 1;
        }
        double chi2 = 0;
        for (const double n : bins) chi2 += (n - kSparks / 80.0) * (n - kSparks / 80.0) / (kSparks / 80.0);
        CHECK(chi2 <= 123.6);  // 79 degrees of freedom: 99.9 % of all even samples
    }
}

TEST_CASE("the mean cosine of a cone of 20 degrees, and the moments of the whole sphere") {
    course::set_hint(2);
    double cosine = 0;
    for (const float4 d : sparks({0, 1, 0}, kPi / 9)) cosine += d.y / double(kSparks);
    // (1 + cos 20 degrees) / 2; the cosine spreads by 0.0174, so four standard errors are 3.5e-4
    CHECK(std::abs(cosine - 0.9698463103929542) <= 3.5e-4);
    double mean = 0, square = 0;
    for (const float4 d : sparks({0, -1, 0}, kPi)) {
        mean += d.y / double(kSparks);
        square += double(d.y) * d.y / kSparks;
    }
    CHECK(std::abs(mean) <= 0.012);              // four standard errors of sqrt(1/3) / 200
    CHECK(std::abs(square - 1.0 / 3) <= 0.006);  // of sqrt(4/45) / 200
}

TEST_CASE("a cone as narrow as a needle keeps its digits") {
    course::set_hint(3);
    constexpr float kAngle = 0.001f;
    std::vector<float> off;
    for (const float4 d : sparks({0, 0, 1}, kAngle)) off.push_back(std::hypot(d.x, d.y) / kAngle);
    std::sort(off.begin(), off.end());
    // Radii in a small disc: the part q lies within sqrt(q). Steps of four digits would show as a gap.
    float worst = 0, gap = 0;
    for (std::size_t k = 0; k < off.size(); ++k) {
        worst = std::max(worst, std::abs(off[k] - std::sqrt((k + 0.5f) / off.size())));
        if (k > 0) gap = std::max(gap, off[k] - off[k - 1]);
    }
    CHECK(worst <= 0.02f);  // Kolmogorov's bound for 40000 draws: 0.01 in q; near q = 0 twice that in sqrt(q)
    CHECK(gap <= 0.02f);
    CHECK(cone_direction({0, 1, 0}, 0, 0.7f, 0.2f) == glm::vec3(0, 1, 0));
}
