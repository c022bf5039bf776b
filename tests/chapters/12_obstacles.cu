// Chapter 12: obstacles against sampled surfaces, elastic collisions, free falls, integrals and conservation
// laws.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "10_water_sph/sph_cpu.h"
#include "12_obstacles/contact_cpu.h"
#include "12_obstacles/explain.h"
#include "12_obstacles/fire_run.cuh"
#include "12_obstacles/observe.cuh"
#include "12_obstacles/obstacle_view.cuh"
#include "12_obstacles/studies.cuh"
#include "common/gl_context.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"

namespace {

using namespace obstacles;

const Solid kBall = sphere(0.5f);
const Solid kBrick = box({0.5f, 0.3f, 0.2f});

glm::vec3 random_point(std::mt19937& random, float reach_m) {
    std::uniform_real_distribution<float> at(-reach_m, reach_m);
    const float x = at(random), y = at(random), z = at(random);
    return {x, y, z};
}

/// Points of a solid's surface, at most `spacing_m` from their neighbours.
std::vector<glm::dvec3> surface_points(const Solid& solid, double spacing_m) {
    std::vector<glm::dvec3> points;
    const glm::dvec3 half = solid.half_size_m;
    if (solid.shape == Shape::sphere) {
        const int rings = int(sph::kPi * half.x / spacing_m) + 1;
        for (int i = 0; i <= rings; ++i) {
            const double polar = sph::kPi * i / rings;
            const int count = int(2 * sph::kPi * half.x * std::sin(polar) / spacing_m) + 1;
            for (int k = 0; k < count; ++k) {
                const double turn = 2 * sph::kPi * k / count;
                points.push_back(half.x * glm::dvec3(std::sin(polar) * std::cos(turn), std::cos(polar),
                                                     std::sin(polar) * std::sin(turn)));
            }
        }
        return points;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const int nb = int(2 * half[b] / spacing_m) + 1, nc = int(2 * half[c] / spacing_m) + 1;
        for (int i = 0; i <= nb; ++i)
            for (int k = 0; k <= nc; ++k)
                for (const double side : {-1.0, 1.0}) {
                    glm::dvec3 p;
                    p[axis] = side * half[axis];
                    p[b] = half[b] * (2.0 * i / nb - 1);
                    p[c] = half[c] * (2.0 * k / nc - 1);
                    points.push_back(p);
                }
    }
    return points;
}

/// Setting without a tank.
Setting open_setting(std::uint32_t particles, double dt_s) {
    Setting setting;
    setting.particles = particles;
    setting.dt_s = dt_s;
    return setting;
}

Obstacle moving(const Solid& solid, glm::dvec3 at_m, glm::dvec3 velocity_m_per_s, Surface surface = {}) {
    Obstacle o;
    o.solid = solid;
    o.surface = surface;
    o.path.start_m = at_m;
    o.path.start_velocity_m_per_s = velocity_m_per_s;
    return o;
}

/// Particles that fly freely, and obstacles in their way.
struct Flight {
    ObstacleSet obstacles;
    course::DeviceBuffer<float4> position, velocity;
    glm::vec3 gravity_m_per_s2{0};

    Flight(const std::vector<Obstacle>& list, const Setting& setting, const std::vector<float4>& x,
           const std::vector<float4>& v)
        : obstacles(list, setting), position(x), velocity(v) {}

    std::uint32_t size() const { return std::uint32_t(position.size()); }
    void step() {
        const float dt = float(obstacles.setting().dt_s);
        kick(0.5f * dt);
        if (size() > 0)
            fly_kernel<<<patterns::blocks_for(size()), patterns::kThreads>>>(position.data(), velocity.data(),
                                                                             dt, size());
        CUDA_CHECK(cudaGetLastError());
        obstacles.move();
        obstacles.contact(position.data(), velocity.data(), size(), WholeStep{dt});
        obstacles.finish(size());
        kick(0.5f * dt);
    }
    glm::dvec3 momentum(double mass_kg) const {
        return observe(position.data(), velocity.data(), size(), mass_kg, obstacles).momentum_kg_m_per_s;
    }
    double kinetic_J(double mass_kg) const {
        double sum = 0;
        for (const float4& v : velocity.download())
            sum += 0.5 * mass_kg * (double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
        return sum;
    }

  private:
    void kick(float dt) {
        if (gravity_m_per_s2 == glm::vec3(0)) return;
        auto v = velocity.download();
        for (float4& u : v)
            u = make_float4(u.x + dt * gravity_m_per_s2.x, u.y + dt * gravity_m_per_s2.y,
                            u.z + dt * gravity_m_per_s2.z, u.w);
        velocity.upload(v);
    }
};

float4 as_float4(glm::vec3 x, float w = 0) {
    return make_float4(x.x, x.y, x.z, w);
}

}  // namespace

// --------------------------------------------------------------------------------------------- distances

TEST_CASE("the signed distance is the distance to the nearest of many points of the surface") {
    course::set_seed(1);
    std::mt19937 random(1);
    for (const Solid& solid : {kBall, kBrick}) {
        const double spacing_m = 0.01;
        const auto surface = surface_points(solid, spacing_m);
        for (int k = 0; k < 300; ++k) {
            const glm::vec3 r = random_point(random, 0.9f);
            double nearest = 1e30;
            for (const glm::dvec3& p : surface) nearest = std::min(nearest, glm::length(glm::dvec3(r) - p));
            const double distance = signed_distance(solid, r);
            // The nearest sample is off the nearest point by at most half a diagonal of the samples' net,
            // which makes it no nearer, and at most that much farther.
            CHECK(nearest >= std::abs(distance) - 1e-6);
            CHECK(nearest <= std::abs(distance) + 0.71 * spacing_m);
            const glm::dvec3 a = glm::abs(glm::dvec3(r)), half = solid.half_size_m;
            const bool inside = solid.shape == Shape::sphere ? glm::length(glm::dvec3(r)) < half.x
                                                             : a.x < half.x && a.y < half.y && a.z < half.z;
            CHECK((distance < 0) == inside);
        }
    }
}

TEST_CASE("the way out is the gradient of the distance, and as long as the distance says") {
    course::set_seed(2);
    std::mt19937 random(2);
    for (const Solid& solid : {kBall, kBrick})
        for (int k = 0; k < 300; ++k) {
            const glm::vec3 r = random_point(random, 0.9f), n = outward(solid, r);
            CHECK(std::abs(glm::length(n) - 1) < 1e-6);
            const glm::vec3 on_surface = r - signed_distance(solid, r) * n;
            CHECK(std::abs(signed_distance(solid, on_surface)) < 1e-6);  // roundings of numbers around 1
            // Across a box's planes of symmetry the gradient jumps: differences of 1e-7 m seldom straddle it.
            CHECK(glm::length(glm::dvec3(n) - outward_cpu(solid, r)) < 1e-6);
        }
}

TEST_CASE("where no way out is the shortest, it is up") {
    CHECK(outward(kBall, {0, 0, 0}) == glm::vec3(0, 1, 0));
    CHECK(outward(box(glm::vec3(1)), {0, 0, 0}) == glm::vec3(0, 1, 0));
    CHECK(outward(box(glm::vec3(1)), {0.5f, 0.5f, 0}) == glm::vec3(0, 1, 0));
    CHECK(outward(box({1, 2, 2}), {0, 0, 0}) == glm::vec3(1, 0, 0));
    // On an edge and a corner, outside by nothing: still a direction of length 1, and no NaN.
    CHECK(std::abs(glm::length(outward(box(glm::vec3(1)), {1, 1, 0})) - 1) < 1e-6);
    CHECK(std::abs(glm::length(outward(box(glm::vec3(1)), {1, 1, 1})) - 1) < 1e-6);
}

TEST_CASE("a line enters a solid where small steps along it first find the inside") {
    course::set_seed(3);
    std::mt19937 random(3);
    int crossings = 0;
    for (const Solid& solid : {kBall, kBrick})
        for (int k = 0; k < 1000; ++k) {
            const glm::vec3 from = random_point(random, 1.2f), to = random_point(random, 1.2f);
            if (signed_distance(solid, from) <= 0) continue;
            constexpr int kPieces = 2000;
            int first = 0;
            double deepest = 1e30;
            for (int piece = 1; piece <= kPieces; ++piece) {
                const double d = signed_distance_cpu(
                    solid, glm::mix(glm::dvec3(from), glm::dvec3(to), double(piece) / kPieces));
                deepest = std::min(deepest, d);
                if (d < 0 && first == 0) first = piece;
            }
            Crossing found;
            const bool enters = find_crossing(solid, from, to, found);
            // Lines that only just touch may pass between the steps: a chord of one piece is that shallow.
            if (std::abs(deepest) < 1e-4) continue;
            REQUIRE(enters == (first > 0));
            if (!enters) continue;
            ++crossings;
            CHECK(std::abs(found.fraction * kPieces - first) <= 1.01);
            const glm::vec3 there = from + found.fraction * (to - from);
            CHECK(std::abs(signed_distance(solid, there)) < 2e-6);  // roundings of numbers around 2
            CHECK(glm::dot(found.normal, to - from) < 0);
            CHECK(std::abs(glm::length(found.normal) - 1) < 1e-5);
        }
    CHECK(crossings > 300);
}

// ---------------------------------------------------------------------------------------------- contacts

TEST_CASE("off a moving wall: v' = 2u - v along the normal, and what restitution and friction make of it") {
    const glm::vec3 n(0, 1, 0), u(0, 3, 0), v(4, -2, 0);
    // Numbers that floats hold exactly.
    CHECK(bounce(v, u, n, {1, 0}) == glm::vec3(4, 8, 0));
    CHECK(bounce(v, u, n, {0, 0}) == glm::vec3(4, 3, 0));
    CHECK(bounce(v, u, n, {0.5f, 0}) == glm::vec3(4, 5.5f, 0));
    CHECK(bounce({4, 3.5f, 0}, u, n, {1, 0}) == glm::vec3(4, 3.5f, 0));  // it leaves: nothing happens
    // Coulomb: the push is 5 (restitution 0), so friction 0.2 takes 1 of the sliding...
    CHECK(glm::length(bounce(v, u, n, {0, 0.2f}) - glm::vec3(3, 3, 0)) < 1e-6f);
    // ...and a rough surface takes all of it and turns nothing round: the particle moves with the surface,
    CHECK(glm::length(bounce(v, u, n, {0, 1e6f}) - glm::vec3(0, 3, 0)) < 1e-6f);
    CHECK(glm::length(bounce(v, {1, 3, 0}, n, {0, 1e6f}) - glm::vec3(1, 3, 0)) < 1e-6f);
    // but is not held: with the next push upwards it is free.
    CHECK(bounce({1, 3.1f, 0}, {1, 3, 0}, n, {0, 1e6f}) == glm::vec3(1, 3.1f, 0));
}

TEST_CASE("the pass sends particles where a walk in small pieces sends them") {
    course::set_seed(4);
    std::mt19937 random(4);
    const std::uint32_t n = 3000;  // not a multiple of the block
    const double dt_s = 0.1;
    Obstacle ball = moving(sphere(0.15f), {-0.3, 0, 0}, {2, 1, 0}, {0.7f, 0.1f});
    ball.path.legs = {{dt_s, {3, -4, 2}}};
    const Obstacle brick = moving(box({0.2f, 0.1f, 0.15f}), {0.35, 0.1, 0}, {-1, 0, 1}, {0.2f, 0.3f});
    std::vector<float4> x, v;
    for (std::uint32_t i = 0; i < n; ++i) {
        x.push_back(as_float4(random_point(random, 0.7f)));
        v.push_back(as_float4(random_point(random, 5)));
    }
    Flight flight({ball, brick}, open_setting(n, dt_s), x, v);
    flight.step();
    const auto x_got = flight.position.download(), v_got = flight.velocity.download();
    int compared = 0, bounced = 0, wrong = 0;
    const int pieces = 4000;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Obstacles& all = flight.obstacles.now();
        bool inside = false;  // those that start inside are another test's business
        for (int k = 0; k < all.count; ++k)
            inside = inside ||
                     signed_distance(all.obstacle[k].solid, grid::xyz(x[i]) - all.obstacle[k].from_m) < 1e-3f;
        if (inside) continue;
        glm::dvec3 place = glm::dvec3(grid::xyz(x[i])) + double(all.dt_s) * glm::dvec3(grid::xyz(v[i]));
        glm::dvec3 velocity = grid::xyz(v[i]);
        resolve_cpu(all, pieces, place, velocity);
        ++compared;
        bounced += glm::length(velocity - glm::dvec3(grid::xyz(v[i]))) > 0.1;
        // A piece is at most 1/4000 of 0.9 m. The walk meets a sphere up to that much deeper, where its
        // normal is turned by up to 0.002 rad (more in a grazing hit), and 9 m/s with it.
        const bool close = glm::length(place - glm::dvec3(grid::xyz(x_got[i]))) < 4e-3 &&
                           glm::length(velocity - glm::dvec3(grid::xyz(v_got[i]))) < 0.06;
        wrong += !close;
    }
    MESSAGE(compared << " compared, " << bounced << " bounced, " << wrong << " differ");
    CHECK(compared > 2000);
    CHECK(bounced > 100);
    // Which face of a box a line meets near an edge, and whether a grazing line meets a ball at all, can be
    // decided by the length of a piece.
    CHECK(wrong <= bounced / 50);
}

TEST_CASE("a ball bounces on a box as often and as high as a falling ball does") {
    // From the height H, with restitution e: contact after t0 = sqrt(2 H / g), then flights of 2 e^k t0.
    const float e = 0.8f;
    const double height = 0.5, g = 9.81, dt_s = 1e-4, t0 = std::sqrt(2 * height / g);
    Flight flight({moving(box({1, 0.5f, 1}), {0, -0.5, 0}, {0, 0, 0}, {e, 0})}, open_setting(1, dt_s),
                  {as_float4({0, float(height), 0})}, {as_float4({0, 0, 0})});
    flight.gravity_m_per_s2 = {0, -float(g), 0};
    std::vector<double> bounces, tops;
    double top = 0, last_speed = 0;
    for (int step = 1; step <= 12600; ++step) {
        flight.step();
        const float4 x = flight.position.download()[0], v = flight.velocity.download()[0];
        top = std::max(top, double(x.y));
        if (last_speed < 0 && v.y > 0) {
            bounces.push_back(step * dt_s);
            tops.push_back(top);
            top = 0;
        }
        last_speed = v.y;
    }
    REQUIRE(bounces.size() >= 3);
    double expected_s = t0, expected_top = height;
    for (int k = 0; k < 3; ++k) {
        // Each bounce is timed to a step, and takes its speed from the middle of the step: g dt / 2 of at
        // most 3 m/s, which is an error of 2e-4 in the speed and of as much in the flight that follows.
        CHECK(std::abs(bounces[k] - expected_s) < 2 * dt_s + 4e-4 * expected_s);
        CHECK(std::abs(tops[k] / expected_top - 1) < 2e-3);
        expected_s += 2 * std::pow(double(e), k + 1) * t0;
        expected_top *= double(e) * e;
    }
}

TEST_CASE("a bounce is second order in the time step where the first idea is first order") {
    const Shower shower;
    std::vector<glm::dvec3> exact;
    for (std::uint32_t i = 0; i < Shower::kParticles; i += 8) exact.push_back(shower.exact(i));
    const auto error = [&](Test test, int steps) {
        std::vector<float4> x, v;
        for (std::uint32_t i = 0; i < Shower::kParticles; i += 8) {
            x.push_back(shower.position[i]);
            v.push_back(shower.velocity[i]);
        }
        Flight flight({shower.ball}, open_setting(std::uint32_t(x.size()), Shower::kTime_s / steps), x, v);
        for (int step = 0; step < steps; ++step) {
            fly_kernel<<<patterns::blocks_for(flight.size()), patterns::kThreads>>>(
                flight.position.data(), flight.velocity.data(), float(flight.obstacles.setting().dt_s),
                flight.size());
            flight.obstacles.move();
            launch_test(test, flight.position.data(), flight.velocity.data(), flight.obstacles,
                        flight.size());
        }
        double sum = 0;
        const auto got = flight.position.download();
        for (std::size_t i = 0; i < got.size(); ++i) {
            const double off = glm::length(glm::dvec3(grid::xyz(got[i])) - exact[i]);
            sum += off * off;
        }
        return std::sqrt(sum / got.size());
    };
    const double swept = error(Test::swept, 8) / error(Test::swept, 32);
    const double end = error(Test::end_of_step, 8) / error(Test::end_of_step, 32);
    MESSAGE("four times the steps: swept " << swept << ", end of the step " << end);
    CHECK(swept > 12);  // 16 for second order...
    CHECK(swept < 20);
    CHECK(end > 2);  // ...and 4 for first
    CHECK(end < 6);
}

TEST_CASE("nothing gets through a swept obstacle at any speed, and much gets through the other test") {
    for (const double speed : {0.1, 10.0, 1e3, 1e6})
        for (const double plates : {0.3, 3.0, 300.0}) {  // half plates in a step
            CHECK(nobody_gets_through(Test::swept, speed, plates * 0.01 / speed));
            CHECK(nobody_gets_through(Test::end_of_step, speed, plates * 0.01 / speed) == (plates < 1));
        }
}

TEST_CASE("between two obstacles in one step: as often as it takes") {
    // A particle between two walls that are 1 m apart, fast enough for three bounces in a step.
    const Solid wall = box({0.5f, 1, 1});
    Flight flight({moving(wall, {-1, 0, 0}, {0, 0, 0}, {1, 0}), moving(wall, {1, 0, 0}, {0, 0, 0}, {1, 0})},
                  open_setting(1, 1), {as_float4({0, 0, 0})}, {as_float4({3.25f, 0, 0})});
    flight.step();
    // 0.5 m to the first wall, 1 m, 1 m, and 0.75 m back: three bounces.
    course::check_close(flight.position.download(), {as_float4({-0.5f + 0.25f, 0, 0}, 0)}, {1e-6},
                        "position");
    course::check_close(flight.velocity.download(), {as_float4({-3.25f, 0, 0})}, {0}, "velocity");
}

TEST_CASE("a newborn flame has come only as far as its age") {
    // Born 0.01 s before the end of the step, right above a ball: its way back for the whole step would lead
    // through the ball.
    ObstacleSet obstacles({moving(sphere(0.1f), {0, 0, 0}, {0, 0, 0}, {1, 0})}, open_setting(2, 0.1));
    course::DeviceBuffer<float4> position({make_float4(0, 0.2f, 0, 0.01f), make_float4(0, 0.2f, 0, 5)});
    course::DeviceBuffer<float4> velocity({make_float4(0, 5, 0, 1), make_float4(0, 5, 0, 9)});
    obstacles.move();
    obstacles.contact(position.data(), velocity.data(), 2, SinceBirth{0.1f});
    const auto x = position.download(), v = velocity.download();
    CHECK((x[0].y == 0.2f && x[0].w == 0.01f && v[0].y == 5 && v[0].w == 1));  // untouched, age and life too
    CHECK((x[1].w == 5 && v[1].w == 9));
    CHECK(std::abs(v[1].y + 5) < 2e-6f);  // the old one came through the ball: it bounced
}

// ----------------------------------------------------------------------------------------------- two ways

TEST_CASE("one particle and one free ball, head on: the textbook's collision") {
    for (const double e : {1.0, 0.5, 0.0})
        for (const double ball_kg : {10.0, 2.0, 0.1}) {
            Obstacle ball = moving(sphere(0.1f), {0, 0, 0}, {-1, 0, 0}, {float(e), 0});
            ball.control = Control::free;
            ball.mass_kg = ball_kg;
            Setting setting = open_setting(1, 0.1);
            setting.particle_mass_kg = 2;
            Flight flight({ball}, setting, {as_float4({-0.4f, 0, 0})}, {as_float4({3, 0, 0})});
            for (int step = 0; step < 3; ++step) flight.step();
            const double m = 2, common = (m * 3 + ball_kg * -1) / (m + ball_kg), w = 4;
            const double particle = common - e * w * ball_kg / (m + ball_kg),
                         body = common + e * w * m / (m + ball_kg);
            CHECK(std::abs(flight.velocity.download()[0].x - particle) < 2e-6);  // roundings of 3 m/s
            CHECK(std::abs(flight.obstacles.motion(0).velocity_m_per_s.x - body) < 2e-6 * (1 + m / ball_kg));
        }
}

TEST_CASE("a free ball in a cloud: momentum stays to the last digits of a double, and energy never grows") {
    course::set_seed(5);
    const std::uint32_t n = 2000;
    const double mass_kg = 0.01;
    for (const float e : {0.0f, 0.5f, 1.0f})
        for (const double ball_kg : {1.0, 0.05}) {  // the light one weighs as much as five particles
            std::mt19937 random(5);
            std::vector<float4> x, v;
            for (std::uint32_t i = 0; i < n; ++i) {
                glm::vec3 at = random_point(random, 0.5f);
                if (signed_distance(sphere(0.16f), at) < 0) at += glm::vec3(0.6f, 0, 0);
                x.push_back(as_float4(at));
                v.push_back(as_float4(random_point(random, 0.2f)));
            }
            Obstacle ball = moving(sphere(0.15f), {0, 0, 0}, {3, 1, 0}, {e, 0.3f});
            ball.control = Control::free;
            ball.mass_kg = ball_kg;
            Setting setting = open_setting(n, 0.01);
            setting.particle_mass_kg = mass_kg;
            Flight flight({ball}, setting, x, v);
            const auto all = [&] {
                return flight.momentum(mass_kg) + ball_kg * flight.obstacles.motion(0).velocity_m_per_s;
            };
            const auto energy = [&] {
                const double u = glm::length(flight.obstacles.motion(0).velocity_m_per_s);
                return flight.kinetic_J(mass_kg) + 0.5 * ball_kg * u * u;
            };
            const glm::dvec3 before = all();
            double last_J = energy(), most = 0, hits = 0;
            for (int step = 0; step < 40; ++step) {
                flight.step();
                hits += glm::length(flight.obstacles.impulse(0)) > 0;
                const double now_J = energy();
                most = std::max(most, now_J / last_J - 1);
                last_J = now_J;
            }
            CHECK(hits > 5);
            // 2000 terms of up to 0.03 kg m/s, added in another order in double: some 1e-17 each.
            CHECK(glm::length(all() - before) < 1e-13);
            CHECK(most < 1e-7);  // fp32 velocities: 6e-8 of each change
        }
}

TEST_CASE("a ball that falls into resting particles gives them what it loses") {
    const std::uint32_t n = 500;
    std::vector<float4> x;
    for (std::uint32_t i = 0; i < n; ++i)
        x.push_back(make_float4(0.02f * float(i % 10) - 0.09f, 0.02f * float(i / 100),
                                0.02f * float(i / 10 % 10) - 0.09f, 0));
    Obstacle ball = moving(sphere(0.05f), {0, 0.2, 0}, {0, -2, 0});
    ball.control = Control::free;
    ball.mass_kg = 1;
    Setting setting = open_setting(n, 0.005);
    setting.particle_mass_kg = 0.02;
    setting.gap_m = 0.01f;
    Flight flight({ball}, setting, x, sph::at_rest(n));
    for (int step = 0; step < 60; ++step) flight.step();
    const glm::dvec3 left = flight.obstacles.motion(0).velocity_m_per_s;
    CHECK(left.y > -1.9);                                                             // slowed...
    CHECK(glm::length(left + flight.momentum(0.02) - glm::dvec3(0, -2, 0)) < 1e-13);  // ...and nothing lost
}

TEST_CASE("the sums do not depend on who runs first: two runs agree bit for bit") {
    const auto run = [] {
        WaterSettings settings;
        settings.scene = water_scenes()[2];
        settings.scene.obstacles[0].path.start_m.y = 0.36;
        settings.particles = 400;
        WaterRun water(settings);
        for (int step = 0; step < 60; ++step) water.step();
        return std::make_pair(water.water().positions().download(), water.obstacles().motion(0));
    };
    const auto first = run(), second = run();
    course::check_equal(first.first, second.first, "position");
    CHECK(first.second.position_m == second.second.position_m);
    CHECK(first.second.velocity_m_per_s == second.second.velocity_m_per_s);
}

// -------------------------------------------------------------------------------------------------- paths

TEST_CASE("a path is the integral of its accelerations") {
    Path path;
    path.start_m = {1, 2, 3};
    path.start_velocity_m_per_s = {0.5, 0, -1};
    path.legs = {{2, {1, 0, 0}}, {1, {0, -3, 0}}, {0, {9, 9, 9}}, {1, {0, 0, 4}}};
    // x = x0 + v0 t + a t^2 / 2, by hand.
    CHECK(path.at(0).position_m == glm::dvec3(1, 2, 3));
    CHECK(path.at(1).position_m == glm::dvec3(2, 2, 2));
    CHECK(path.at(2).position_m == glm::dvec3(4, 2, 1));
    CHECK(path.at(2).velocity_m_per_s == glm::dvec3(2.5, 0, -1));
    CHECK(path.at(3).position_m == glm::dvec3(6.5, 0.5, 0));
    CHECK(path.at(4).velocity_m_per_s == glm::dvec3(2.5, -3, 3));
    CHECK(path.at(6).position_m == path.at(4).position_m + 2.0 * path.at(4).velocity_m_per_s);  // it goes on
    CHECK(path.fastest_m_per_s() == glm::length(glm::dvec3(2.5, -3, 3)));
    // Against 30,000 small steps of the midpoint rule, which is exact for a constant acceleration: what is
    // left is the three steps in which the acceleration changes, and rounding.
    glm::dvec3 x = path.start_m, v = path.start_velocity_m_per_s;
    const double dt = 1e-4;
    for (int step = 0; step < 30000; ++step) {
        const glm::dvec3 a = path.at((step + 0.5) * dt).acceleration_m_per_s2;
        x += dt * (v + 0.5 * dt * a);
        v += dt * a;
    }
    CHECK(glm::length(x - path.at(3).position_m) < 1e-9);
    CHECK(glm::length(v - path.at(3).velocity_m_per_s) < 1e-9);
}

TEST_CASE("a path that repeats goes on from where it has come to") {
    Path path;
    path.start_velocity_m_per_s = {1, 0, 0};
    path.legs = {{1, {0, 2, 0}}, {1, {0, -2, 0}}};
    path.repeats = true;
    CHECK(path.at(2).position_m == glm::dvec3(2, 2, 0));
    CHECK(glm::length(path.at(5).position_m - glm::dvec3(5, 5, 0)) < 1e-12);
    Obstacle obstacle;
    obstacle.path = path;
    CHECK_NOTHROW(check(obstacle, Setting{}));
    obstacle.path.legs.pop_back();  // now it would have to lose 2 m/s at once
    CHECK_THROWS_AS(check(obstacle, Setting{}), course::BadInput);
}

TEST_CASE("steps of an obstacle add up to its path, and a hand's to where it points") {
    const WaterScene stir = water_scenes()[1];
    Setting setting = open_setting(0, 1e-3);
    ObstacleSet obstacles(stir.obstacles, setting);
    for (int step = 0; step < 1234; ++step) obstacles.move();
    CHECK(glm::length(obstacles.motion(0).position_m - stir.obstacles[0].path.at(1.234).position_m) < 1e-12);

    Obstacle led = moving(kBall, {0, 0, 0}, {0, 0, 0});
    led.control = Control::hand;
    setting.fastest_m_per_s = 2;
    ObstacleSet hand({led}, setting);
    hand.lead(0, {0.1, 0, 0});
    for (int step = 0; step < 25; ++step) hand.move();
    CHECK(std::abs(hand.motion(0).position_m.x - 0.05) < 1e-12);  // 2 m/s, and no faster
    CHECK(std::abs(hand.motion(0).velocity_m_per_s.x - 2) < 1e-12);
    for (int step = 0; step < 26; ++step) hand.move();
    CHECK(hand.motion(0).position_m == glm::dvec3(0.1, 0, 0));
    CHECK(hand.motion(0).velocity_m_per_s == glm::dvec3(0, 0, 0));
}

TEST_CASE("an obstacle that is dragged stays under the pointer") {
    course::OrbitCamera orbit;
    orbit.yaw_rad = 0.7f, orbit.pitch_rad = 0.4f, orbit.distance_m = 2;
    const course::Camera camera = orbit.camera();
    const int width = 1280, height = 720;
    const auto pixel = [&](glm::dvec3 at_m) {
        const glm::vec4 clip =
            camera.projection(float(width) / height) * camera.view() * glm::vec4(glm::vec3(at_m), 1);
        return glm::vec2(0.5f * width * clip.x / clip.w, -0.5f * height * clip.y / clip.w);
    };
    course::WindowEvents events;
    events.drag_x_px = 40, events.drag_y_px = -25;
    const glm::dvec3 from_m(0.3, 0.2, -0.1), to_m = dragged(from_m, events, camera, height);
    const glm::vec2 moved = pixel(to_m) - pixel(from_m);
    CHECK(std::abs(moved.x - 40) < 0.01f);  // fp32 matrices: 1e-6 of a thousand pixels
    CHECK(std::abs(moved.y + 25) < 0.01f);
}

// -------------------------------------------------------------------------------------------- ghost water

namespace {

/// Part of the poly6 kernel around r that lies in the solid, and the sum of spiky's gradients there times -h:
/// by summing over small cubes.
Ghost sampled_ghost(const Solid& solid, glm::dvec3 r, double h, int cubes) {
    const double edge = 2 * h / cubes;
    double density = 0;
    glm::dvec3 push(0);
    for (int z = 0; z < cubes; ++z)
        for (int y = 0; y < cubes; ++y)
            for (int x = 0; x < cubes; ++x) {
                const glm::dvec3 d = edge * (glm::dvec3(x, y, z) + 0.5) - h;  // from the particle
                const double q = glm::length(d) / h;
                if (q >= 1 || signed_distance_cpu(solid, r + d) > 0) continue;
                const double part = edge * edge * edge / (h * h * h);
                density += part * sph::poly6(q * q);
                push += part * sph::spiky_slope(q) * -d / (q * h);
            }
    Ghost ghost;
    ghost.density = float(density);
    ghost.push = push;
    return ghost;
}

}  // namespace

TEST_CASE("half a space of ghost water: half the density, half the push, and the slices add up") {
    CHECK(std::abs(poly6_beyond(0) - 0.5f) < 1e-6f);
    CHECK(poly6_beyond(1) == 0);
    CHECK(poly6_beyond(-1) == 1);
    CHECK(std::abs(poly6_beyond(-0.3f) + poly6_beyond(0.3f) - 1) < 1e-6f);
    double push = 0;
    for (int k = 0; k < 1000; ++k) push += 1e-3 * spiky_slice((k + 0.5f) / 1000);
    CHECK(std::abs(push - 0.5) < 1e-5);  // the midpoint rule's error: its step squared
}

TEST_CASE("ghost water is what small cubes in the obstacle's place add up to") {
    const double h = 0.1;
    // A large ball, a wall, and the edge and corner of a box, at several distances from their surfaces.
    struct Case {
        Solid solid;
        glm::dvec3 way;        ///< outwards, length 1
        double density, push;  ///< largest errors: of a density up to 1/2 and a push up to 1.5
    };
    const double slant2 = std::sqrt(0.5), slant3 = std::sqrt(1.0 / 3);
    for (const Case& c : {
             Case{sphere(0.5f), {0, 1, 0}, 0.01, 0.03},      // h / R = 0.2: the correction's own square, 0.04
             Case{sphere(0.2f), {0.6, 0, 0.8}, 0.03, 0.10},  // 0.5: 0.25
             Case{box(glm::vec3(0.5f)), {1, 0, 0}, 0.005, 0.02},  // a plane: exact but for the cubes
             Case{box(glm::vec3(0.5f)), {slant2, 0, slant2}, 0.04, 0.15},
             Case{box(glm::vec3(0.5f)), {slant3, slant3, slant3}, 0.04, 0.15},
         })
        for (const double distance : {0.1, 0.3, 0.6}) {
            const double corner = c.solid.shape == Shape::sphere ? 1 : std::max({c.way.x, c.way.y, c.way.z});
            const glm::dvec3 r = c.way * (c.solid.half_size_m.x / corner + distance * h);
            const Ghost got = ghost_of(c.solid, r, float(h)), expected = sampled_ghost(c.solid, r, h, 80);
            CAPTURE(distance);
            CAPTURE(got.density);
            CAPTURE(expected.density);
            CHECK(std::abs(got.density - expected.density) < c.density);
            CHECK(glm::length(got.push - expected.push) < c.push);
        }
    // Far away there is none.
    CHECK(ghost_of(sphere(0.5f), {0, 0.61f, 0}, 0.1f).density == 0);
    CHECK(ghost_of(box(glm::vec3(0.5f)), {0, 0.61f, 0}, 0.1f).density == 0);
}

TEST_CASE("in the water: densities are those of particles and ghost together, pushes are felt by both") {
    course::set_seed(6);
    const float spacing_m = 0.05f;
    sph::Fluid fluid = sph::lattice_fluid(2);
    fluid.support_m = 2 * spacing_m;
    fluid.mass_kg = 4000 * spacing_m * spacing_m * spacing_m;  // a thin cloud: heavy enough to have pressure
    const sph::Box tank{{-5, -5, -5}, {5, 5, 5}};
    std::mt19937 random(6);
    std::vector<float4> x;
    while (x.size() < 800) {
        const glm::vec3 at = random_point(random, 0.45f);
        if (signed_distance(sphere(0.25f), at) > 0) x.push_back(as_float4(at));
    }
    sph::Water water(fluid, tank, sph::EquationOfState::linear, x, sph::at_rest(x.size()));
    Setting setting = open_setting(water.size(), 1e-5);
    setting.particle_mass_kg = fluid.mass_kg;
    setting.measure_forces = true;
    ObstacleSet obstacles({moving(sphere(0.25f), {0, 0, 0}, {0, 0, 0})}, setting);
    obstacles::step(water, obstacles, Skin::ghost);
    const auto now = water.positions().download();
    const auto density = water.densities().download();
    const auto alone = sph::density_cpu(now, fluid, tank);
    double gained = 0;
    int near = 0;
    std::vector<float> expected(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
        const Ghost ghost = ghost_of(sphere(0.25f), grid::xyz(now[i]), fluid.support_m);
        expected[i] = float(alone[i] + 1000 * ghost.density);
        near += ghost.density > 0.05f;
    }
    CHECK(near > 50);
    course::check_close(density, expected, {0, 5e-6}, "density");  // fp32 sum of up to 100 terms
    // What the ball got is what the water lost: all forces between particles cancel in the sum.
    const Observation seen =
        observe(water.position(), water.velocity(), water.size(), fluid.mass_kg, obstacles);
    gained = glm::length(seen.momentum_kg_m_per_s + obstacles.impulse(0));
    CHECK(glm::length(obstacles.impulse(0)) > 1e-6);
    // fp32 velocities of 800 particles of 0.5 kg: kicks of some 0.1 m/s, whose roundings do not add up.
    CHECK(gained < 1e-6 * 800 * 0.5 * 0.1);
    MESSAGE("impulse on the ball " << glm::length(obstacles.impulse(0)) << ", lost " << gained);
}

TEST_CASE("a ball of half the water's density floats with its middle at the surface") {
    WaterSettings settings;
    settings.scene = water_scenes()[2];
    settings.scene.water.block_size_m.y = 0.2f;
    settings.scene.obstacles[0].path.start_m.y = 0.31;
    settings.particles = 1000;
    WaterRun run(settings);
    const int steps = int(1.6 / run.dt_s());
    double y = 0;
    int looks = 0;
    for (int step = 0; step < steps; ++step) {
        run.step();
        if (step < steps / 2) continue;
        y += run.obstacles().motion(0).position_m.y;
        ++looks;
    }
    // Archimedes: it displaces its mass of water, half its volume, and lifts the surface by that.
    const double ball_m3 = volume_m3(settings.scene.obstacles[0].solid);
    const double surface_m = 0.2 + 0.5 * ball_m3 / (0.6 * 0.4);
    MESSAGE("middle at " << y / looks << " m, surface at " << surface_m << " m");
    // One spacing, 3 cm of so coarse a water, of a ball 16 cm across: where the surface is nobody knows
    // better.
    CHECK(std::abs(y / looks - surface_m) < run.spacing_m());
}

TEST_CASE("a ball held under water is pushed up by about the weight of the water in its place") {
    const double ghost = still_tank(Skin::ghost, 1000, 0.8, 0.4).buoyancy;
    const double bare = still_tank(Skin::bare, 1000, 0.8, 0.4).buoyancy;
    MESSAGE("of Archimedes' force: ghost " << ghost << ", bare " << bare);
    // The ball's radius is 1.25 supports here, so nearly all water that touches it is in its layer. What
    // finer water makes of it is the study's business.
    CHECK(ghost > 0.9);
    CHECK(ghost < 1.4);
    CHECK(bare > 0.4);
    CHECK(bare < 0.9);
}

// -------------------------------------------------------------------------------- models, launches, pictures

TEST_CASE("no flame is inside the ball, and none loses its age") {
    FireObstacles scene = flame_around_ball(3000, 1);
    scene.obstacles[0].path = {};
    scene.obstacles[0].path.start_m = {0, 0.35, 0};
    FireRun run(scene, 1);
    const std::uint32_t n = fire::particle_count(scene.fire.fire);
    course::DeviceBuffer<float4> position(n), velocity(n);
    course::DeviceBuffer<std::uint32_t> generation(n);
    const fire::FlameArrays flames{position.data(), velocity.data(), generation.data()};
    fire::launch_flame_clear(flames, scene.fire.fire);
    int near = 0;
    for (int step = 0; step < 150; ++step) {
        run.step(flames);
        if (step % 10 != 9) continue;
        const Observation seen = observe(flames.position, flames.velocity, n, 1, run.obstacles());
        CHECK(seen.deepest_m < 1e-6);  // fp32 at half a metre
    }
    for (const float4& x : position.download()) {
        CHECK(std::isfinite(x.w));
        near += signed_distance(scene.obstacles[0].solid, grid::xyz(x) - glm::vec3(0, 0.35f, 0)) < 0.01f;
    }
    CHECK(near > 20);  // the ball does stand in the fire
}

TEST_CASE("what --explain says is what happens: launches and bytes, in water and in fire") {
#ifndef __CUDASIM__
    course::require_simulator();
#else
    for (const WaterScene& scene : water_scenes())
        for (const Skin skin : {Skin::ghost, Skin::bare})
            for (const bool without : {false, true}) {
                WaterSettings settings;
                settings.scene = scene;
                settings.skin = skin;
                settings.particles = 400;
                if (without) settings.scene.obstacles.clear();
                WaterRun run(settings);
                cudasim::Recording recording;
                for (int step = 0; step < 2; ++step) run.step();
                CHECK(recording.allocations() == 0);
                Launches expected = sph::launches_per_step(run.water_settings(), run.water());
                const Launches added = launches_per_step(run.obstacles(), skin, run.water().state());
                CHECK(added.empty() == without);  // no obstacle, no pass
                expected.insert(expected.end(), added.begin(), added.end());
                std::size_t total = 0;
                const std::string text = explain("x", {}, added, run.obstacles(), true, false);
                for (const auto& [kernel, count] : expected) {
                    CHECK_MESSAGE(recording.count(kernel) == std::size_t(2 * count), kernel);
                    total += 2 * count;
                }
                for (const auto& [kernel, count] : added) CHECK(text.find(kernel) != std::string::npos);
                CHECK(recording.launches().size() == total);
            }
    // Bytes: a free obstacle wants 24 a particle, and the trees a little; others want none.
    for (const bool free : {false, true}) {
        Obstacle ball = moving(kBall, {0, 0, 0}, {0, 0, 0});
        if (free) ball.control = Control::free, ball.mass_kg = 1;
        cudasim::Recording making;
        const ObstacleSet obstacles({ball}, open_setting(10000, 1e-3));
        CHECK(obstacles.bytes_per_particle() == (free ? 24u : 0u));
        const std::size_t blocks = patterns::walking_blocks(10000);
        const std::size_t trees = (blocks + 1) * (sizeof(Impulse) + sizeof(std::uint32_t));
        CHECK(making.bytes() == (free ? 10000 * 24 + trees : 0));
    }
    // Fire: one kernel, and one more where there is a ball.
    for (const bool without : {false, true}) {
        FireObstacles scene = flame_around_ball(500, 1);
        if (without) scene.obstacles.clear();
        FireRun run(scene, 1);
        const std::uint32_t n = fire::particle_count(scene.fire.fire);
        course::DeviceBuffer<float4> position(n), velocity(n);
        course::DeviceBuffer<std::uint32_t> generation(n);
        const fire::FlameArrays flames{position.data(), velocity.data(), generation.data()};
        fire::launch_flame_clear(flames, scene.fire.fire);
        cudasim::Recording recording;
        run.step(flames);
        CHECK(recording.launches().size() == (without ? 1u : 2u));
        CHECK(recording.count("contact_kernel<Clock, false>") == (without ? 0u : 1u));
    }
#endif
}

TEST_CASE("the obstacle is in the picture, where water does not hide it, and no OpenGL object is left") {
    std::unique_ptr<course::GlContext> context;
    try {
        context = course::make_headless_context();
    } catch (const course::NoOpenGl& error) {
        course::skip(error.what());
    }
    WaterSettings settings;
    settings.scene = water_scenes()[0];
    settings.particles = 500;
    const auto red_pixels = [&] {
        const WaterRun run(settings);
        ObstacleView view(run.view(), run.size(), 320, 180);
        view.draw(run.position(), run.velocity(), run.size(), run.obstacles(),
                  obstacle_view(run.view().tank).camera());
        const course::Image image = view.image();
        int red = 0;
        for (std::size_t p = 0; p < image.rgb.size(); p += 3) red += image.rgb[p] > image.rgb[p + 2] + 30;
        return red;
    };
    // A ball of 9 cm seen from about 1.2 m in a picture of 0.7 rad and 180 pixels: some 40 pixels wide.
    const int red = red_pixels();
    CHECK(red > 400);
    CHECK(red < 2500);
    settings.scene.obstacles[0].path.start_m = {-0.3, 0.09, -0.4};  // behind the block
    CHECK(red_pixels() < red / 4);
    settings.scene.obstacles.clear();
    CHECK(red_pixels() == 0);
    CHECK(course::gl_count().live == 0);
}

TEST_CASE("runs of the program repeat, whatever the threads; bad input gets a sentence and exit code 2") {
    const course::TemporaryFolder folder;
    const std::string common =
        " --draw none --out '" + folder.path().string() + "' --particles 300 --steps 80 ";
    const auto rows = [&](const std::string& environment, const std::string& arguments) {
        const course::ProgramRun run = course::run_program("ch12_obstacles", common + arguments, environment);
        CHECK_MESSAGE(run.exit_code == 0, run.output);
        return run.output.substr(run.output.find("Obstacle 0"));
    };
    CHECK(rows("CUDASIM_THREADS=1", "--scene floating_ball") ==
          rows("CUDASIM_THREADS=2", "--scene floating_ball"));
    for (const std::string& bad :
         {std::string("--skin wool"), std::string("--draw points"), std::string("--frames -1"),
          std::string("--size 0"), std::string("--size nan"), std::string("--size 50"),
          std::string("--speed 0"), std::string("--speed nan"), std::string("--restitution 1.5"),
          std::string("--scene box_in_water --speed 3"),
          std::string("--scene flame_around_ball --speed 1e5")}) {
        const course::ProgramRun run = course::run_program("ch12_obstacles", common + bad);
        CHECK_MESSAGE(run.exit_code == 2, bad << ": " << run.output);
        CHECK_MESSAGE(run.output.find("error: ") != std::string::npos, bad << ": " << run.output);
    }
    // A step far over the water's limit: exit code 3, and the sentence names the limit.
    const course::ProgramRun wild = course::run_program("ch12_obstacles", common + "--dt 0.02");
    CHECK(wild.exit_code == 3);
    CHECK_MESSAGE(wild.output.find("over the limit") != std::string::npos, wild.output);
}
