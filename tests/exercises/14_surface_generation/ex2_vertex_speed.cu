// Exercise 14.2: the water's speed at vertices, against the plain sum over all particles.
#include "ex2_vertex_speed.cuh"

#include <cmath>
#include <random>

#include "tests/support/course_test.h"

namespace {

constexpr float kReach_m = 0.1f;

struct Particles {
    std::vector<float4> position, velocity;
};

Particles cloud(std::uint32_t n, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-0.4f, 0.5f), speed(-3, 3);
    Particles p;
    for (std::uint32_t i = 0; i < n; ++i) {
        const float x = at(random), y = at(random), z = at(random);
        p.position.push_back(make_float4(x, y, z, 7));
        const float u = speed(random), v = speed(random), w = speed(random);
        p.velocity.push_back(make_float4(u, v, w, 1000));  // w is not used
    }
    return p;
}
std::vector<float4> vertices(std::uint32_t n, std::uint32_t seed) {
    return cloud(n, seed).position;
}

std::vector<float> speeds(const Particles& particles, const std::vector<float4>& vertex) {
    const std::uint32_t n = std::uint32_t(particles.position.size()), count = std::uint32_t(vertex.size());
    const grid::Bounds box = grid::bounds_cpu(particles.position);
    const grid::CellGrid cells = grid::make_grid(box.low_m, box.high_m, kReach_m, 4096);
    grid::CountingSort sort(n, cells.cell_count());
    const course::DeviceBuffer<float4> position(particles.position), velocity(particles.velocity), at(vertex);
    course::DeviceBuffer<float4> sorted_position(n), sorted_velocity(n);
    sort.build(position.data(), cells, n);
    grid::gather_kernel<<<grid::blocks_for(n, 64), 64>>>(sorted_position.data(), position.data(),
                                                         sort.order(), n);
    CUDA_CHECK(cudaGetLastError());
    grid::gather_kernel<<<grid::blocks_for(n, 64), 64>>>(sorted_velocity.data(), velocity.data(),
                                                         sort.order(), n);
    CUDA_CHECK(cudaGetLastError());
    course::DeviceBuffer<float> speed(std::vector<float>(count, -1.0f));
    surface::vertex_speed_kernel<<<grid::blocks_for(count, 64), 64>>>(
        speed.data(), at.data(), count, sorted_position.data(), sorted_velocity.data(), sort.ranges(), cells,
        kReach_m);
    CUDA_CHECK(cudaGetLastError());
    return speed.download();
}

std::vector<float> speeds_plain(const Particles& particles, const std::vector<float4>& vertex) {
    std::vector<float> all;
    for (const float4& v : vertex) {
        double sum = 0, weights = 0;
        for (std::size_t k = 0; k < particles.position.size(); ++k) {
            const float4 &p = particles.position[k], &u = particles.velocity[k];
            const double r2 = std::pow(double(p.x) - v.x, 2) + std::pow(double(p.y) - v.y, 2) +
                              std::pow(double(p.z) - v.z, 2);
            const double inside = 1 - r2 / (double(kReach_m) * kReach_m);
            if (!(inside > 0)) continue;
            sum += std::pow(inside, 3) * std::sqrt(double(u.x) * u.x + double(u.y) * u.y + double(u.z) * u.z);
            weights += std::pow(inside, 3);
        }
        all.push_back(weights > 0 ? float(sum / weights) : 0.0f);
    }
    return all;
}

}  // namespace

TEST_CASE("water of one speed has it everywhere") {
    course::set_seed(1);
    course::set_hint(2);
    Particles particles = cloud(2000, 1);
    for (float4& v : particles.velocity) v = make_float4(1, -2, 2, 50);
    std::vector<float4> vertex = vertices(300, 2);
    for (float4& v : vertex) v.x *= 0.8f;  // where particles are all around
    std::vector<float> expected = speeds_plain(particles, vertex);
    int wet = 0;
    for (const float s : expected) wet += s > 0;
    CHECK(wet > 250);
    course::check_close(speeds(particles, vertex), expected, 3e-6, "speed (m/s)",
                        "vertex");  // roundings of 3 m/s
}

TEST_CASE("one particle, near and far") {
    course::set_hint(2);
    const Particles one{{make_float4(0, 0, 0, 0)}, {make_float4(0, 3, 4, 0)}};
    const std::vector<float4> vertex = {
        make_float4(0, 0, 0, 1),      make_float4(0.05f, 0, 0, 1),         make_float4(0, 0.09f, 0, 1),
        make_float4(0.101f, 0, 0, 1), make_float4(0.06f, 0.06f, 0.06f, 1), make_float4(5, 0, 0, 1)};
    course::check_close(speeds(one, vertex), {5, 5, 5, 0, 0, 0}, 1e-5, "speed (m/s)", "vertex");  // roundings
}

TEST_CASE("nobody near: no speed, and a number") {
    course::set_hint(3);
    const Particles particles{{make_float4(0, 0, 0, 0), make_float4(1, 1, 1, 0)},
                              {make_float4(1, 0, 0, 0), make_float4(1, 0, 0, 0)}};
    course::check_equal(speeds(particles, {make_float4(0.5f, 0.5f, 0.5f, 1), make_float4(-3, 0, 0, 1)}),
                        {0, 0}, "speed (m/s)", "vertex");
}

TEST_CASE("any water: as the plain sum says") {
    course::set_seed(3);
    course::set_hint(1);
    for (const std::uint32_t n : {1u, 63u, 500u, 3000u}) {
        CAPTURE(n);
        const Particles particles = cloud(n, n);
        const std::vector<float4> vertex = vertices(257, n + 1);  // not a multiple of the block
        // Sums of up to some tens of speeds below 5.2 m/s. A vertex with one particle at the very rim has
        // weights of 1e-10, made of a difference that has lost most of its digits: but the mean has not.
        if (!course::check_close(speeds(particles, vertex), speeds_plain(particles, vertex), 1e-4,
                                 "speed (m/s)", "vertex"))
            return;
    }
}

TEST_CASE("particles at NaN are not asked") {
    course::set_seed(4);
    course::set_hint(1);
    Particles particles = cloud(800, 4);
    const std::vector<float4> vertex = vertices(100, 5);
    for (std::size_t k = 0; k < 800; k += 9) {
        particles.position[k].y = NAN;
        particles.velocity[k].x = NAN;
    }
    Particles rest;
    for (std::size_t k = 0; k < 800; ++k)
        if (k % 9 != 0) {
            rest.position.push_back(particles.position[k]);
            rest.velocity.push_back(particles.velocity[k]);
        }
    course::check_close(speeds(particles, vertex), speeds_plain(rest, vertex), 1e-4, "speed (m/s)",
                        "vertex");  // as above
}
