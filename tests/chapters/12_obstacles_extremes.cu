// Chapter 12 at its edges: nobody there, everybody in one place, numbers that are none, sizes and speeds that
// no scene has.
#include <cmath>
#include <limits>

#include "12_obstacles/observe.cuh"
#include "12_obstacles/scene.cuh"
#include "tests/support/course_test.h"

namespace {

using namespace obstacles;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Obstacle at_rest(const Solid& solid, glm::dvec3 at_m = {0, 0, 0}) {
    Obstacle o;
    o.solid = solid;
    o.path.start_m = at_m;
    return o;
}

struct Moved {
    std::vector<float4> position, velocity;
};

/// One pass over particles that have just moved for dt.
Moved pass(const std::vector<Obstacle>& list, const std::vector<float4>& x, const std::vector<float4>& v,
           double dt_s = 0.01, float gap_m = 0, glm::vec3 low_m = glm::vec3(-1e30f),
           glm::vec3 high_m = glm::vec3(1e30f)) {
    Setting setting;
    setting.particles = std::uint32_t(x.size());
    setting.dt_s = dt_s;
    setting.gap_m = gap_m;
    setting.low_m = low_m;
    setting.high_m = high_m;
    ObstacleSet obstacles(list, setting);
    course::DeviceBuffer<float4> position(x), velocity(v);
    obstacles.move();
    obstacles.contact(position.data(), velocity.data(), std::uint32_t(x.size()), WholeStep{float(dt_s)});
    obstacles.finish(std::uint32_t(x.size()));
    return {position.download(), velocity.download()};
}

bool finite(const float4& x) {
    return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
}

}  // namespace

TEST_CASE("nobody, one, two") {
    for (std::size_t n : {0, 1, 2}) {
        const std::vector<float4> x(n, make_float4(3, 0, 0, 0)), v(n, make_float4(0, 0, 0, 0));
        const Moved moved = pass({at_rest(sphere(1))}, x, v);
        course::check_equal(moved.position, x, "position");
    }
    Obstacle ball = at_rest(sphere(1));  // a free ball among nobody falls as it would anywhere
    ball.control = Control::free;
    ball.mass_kg = 1;
    Setting setting;
    setting.gravity_m_per_s2 = {0, -10, 0};
    setting.dt_s = 0.1;
    ObstacleSet obstacles({ball}, setting);
    for (int step = 0; step < 10; ++step) {
        obstacles.move();
        obstacles.contact(nullptr, nullptr, 0, WholeStep{0.1f});
        obstacles.finish(0);
    }
    CHECK(std::abs(obstacles.motion(0).position_m.y + 5) < 1e-12);  // leapfrog is exact here
    CHECK(std::abs(obstacles.motion(0).velocity_m_per_s.y + 10) < 1e-12);
}

TEST_CASE("in the very middle of a ball or a box: up, to the surface") {
    const std::vector<float4> x(3, make_float4(1, 2, 3, 0.5f)), v(3, make_float4(0, 0, 0, 7));
    Moved moved = pass({at_rest(sphere(0.25f), {1, 2, 3})}, x, v);
    course::check_equal(moved.position, std::vector<float4>(3, make_float4(1, 2.25f, 3, 0.5f)), "position");
    course::check_equal(moved.velocity, v, "velocity");
    moved = pass({at_rest(box({0.5f, 0.25f, 0.5f}), {1, 2, 3})}, x, v);
    course::check_equal(moved.position, std::vector<float4>(3, make_float4(1, 2.25f, 3, 0.5f)), "position");
}

TEST_CASE("on an edge, on a corner, on a plane of symmetry: finite, and not inside") {
    const Solid cube = box(glm::vec3(0.5f));
    std::vector<float4> x, v;
    for (const glm::vec3 at :
         {glm::vec3(0.5f, 0.5f, 0), glm::vec3(0.5f), glm::vec3(-0.5f, 0.5f, -0.5f),
          glm::vec3(0.25f, 0.25f, 0), glm::vec3(0.25f), glm::vec3(0.5f, 0, 0), glm::vec3(0, -0.5f, 0)})
        for (const glm::vec3 u :
             {glm::vec3(0), glm::vec3(1, 1, 1), glm::vec3(-1, 0, 0), glm::vec3(-1, -1, -1)}) {
            x.push_back(make_float4(at.x, at.y, at.z, 0));
            v.push_back(make_float4(u.x, u.y, u.z, 0));
        }
    const Moved moved = pass({at_rest(cube)}, x, v);
    for (std::size_t i = 0; i < x.size(); ++i) {
        CHECK(finite(moved.position[i]));
        CHECK(finite(moved.velocity[i]));
        CHECK(signed_distance(cube, grid::xyz(moved.position[i])) > -1e-6f);  // rounding of 0.5
    }
}

TEST_CASE("all in one place inside a moving ball: all come out in the same place") {
    Obstacle ball = at_rest(sphere(0.5f));
    ball.path.start_velocity_m_per_s = {1, 0, 0};
    const std::vector<float4> x(300, make_float4(0.1f, 0.2f, 0, 0)), v(300, make_float4(0, 0, 0, 0));
    const Moved moved = pass({ball}, x, v);
    course::check_equal(moved.position, std::vector<float4>(300, moved.position[0]), "position");
    // It leaves along the normal, and the ball slides 9 mm past it: (9 mm)^2 / 2R away from its surface.
    const float off = signed_distance(ball.solid, grid::xyz(moved.position[0]) - glm::vec3(0.01f, 0, 0));
    CHECK(off > -1e-6f);
    CHECK(off < 1e-4f);
}

TEST_CASE("a particle that is no number stays none, and harms nobody") {
    const std::vector<float4> x{make_float4(kNan, 0, 0, 0), make_float4(0, 0.1f, 0, 0),
                                make_float4(INFINITY, 0, 0, 0), make_float4(0, 2, 0, 0)};
    std::vector<float4> v(4, make_float4(0, -1, 0, 0));
    v[3] = make_float4(0, kNan, 0, 0);
    Obstacle ball = at_rest(sphere(0.5f));
    const Moved moved = pass({ball}, x, v);
    CHECK(std::isnan(moved.position[0].x));
    CHECK(std::isinf(moved.position[2].x));
    CHECK(std::isnan(moved.velocity[3].y));
    CHECK(std::abs(moved.position[1].y - 0.5f) < 1e-6f);
}

TEST_CASE("at a million metres a second, from both sides") {
    // The particle flies into a ball 2 m away; the ball flies into a particle.
    Obstacle ball = at_rest(sphere(0.5f));
    ball.surface.restitution = 1;
    const double dt_s = 1e-5;  // 10 m: twenty radii in a step
    Moved moved = pass({ball}, {make_float4(8, 0, 0, 0)}, {make_float4(1e6f, 0, 0, 0)}, dt_s);
    // It started at -2, flew 1.5 m to the ball, and 8.5 m back.
    CHECK(std::abs(moved.position[0].x + 9) < 1e-4f);
    CHECK(std::abs(moved.velocity[0].x + 1e6f) < 2);  // roundings of the normal's length
    ball.path.start_velocity_m_per_s = {1e6, 0, 0};
    moved = pass({ball}, {make_float4(3, 0, 0, 0)}, {make_float4(0, 0, 0, 0)}, dt_s);
    CHECK(std::abs(moved.velocity[0].x - 2e6f) < 1);  // 2u - v; fp32 at 2e6 has steps of 1/8
    CHECK(std::abs(moved.position[0].x - (3 + 2 * (10 - 2.5f))) < 1e-3f);
    ball.path.start_velocity_m_per_s = {1e9, 0, 0};  // 20,000 radii in a step: said to be too fast
    CHECK_THROWS_AS(pass({ball}, {}, {}, dt_s), course::BadInput);
}

TEST_CASE("sizes: nothing, not a number, huge, flat") {
    for (const float size : {0.0f, -1.0f, kNan, 1e-9f, 1e9f, float(INFINITY)})
        CHECK_THROWS_AS(pass({at_rest(sphere(size))}, {}, {}), course::BadInput);
    CHECK_THROWS_AS(pass({at_rest(box({1, 0, 1}))}, {}, {}), course::BadInput);
    // A ball as large as a mountain is a plane for those who lie on it, to the digits that fp32 has there.
    const Moved moved = pass({at_rest(sphere(1000), {0, -1000, 0})}, {make_float4(0.1f, -0.001f, 0.1f, 0)},
                             {make_float4(0, -1, 0, 0)});
    CHECK(std::abs(moved.position[0].y) < 2e-4f);
    CHECK(std::abs(moved.velocity[0].y) < 1e-3f);
}

TEST_CASE("surfaces, masses, paths and numbers of obstacles that make no sense") {
    Obstacle ball = at_rest(sphere(1));
    for (const float bad : {-0.1f, 1.1f, kNan}) {
        Obstacle o = ball;
        o.surface.restitution = bad;
        CHECK_THROWS_AS(pass({o}, {}, {}), course::BadInput);
    }
    ball.surface.friction = kNan;
    CHECK_THROWS_AS(pass({ball}, {}, {}), course::BadInput);
    ball = at_rest(sphere(1));
    ball.control = Control::free;
    for (const double bad : {0.0, -1.0, double(kNan), double(INFINITY)}) {
        ball.mass_kg = bad;
        CHECK_THROWS_AS(pass({ball}, {}, {}), course::BadInput);
    }
    ball = at_rest(sphere(1));
    ball.path.legs = {{-1, {0, 0, 0}}};
    CHECK_THROWS_AS(pass({ball}, {}, {}), course::BadInput);
    ball.path.legs = {{1, {double(kNan), 0, 0}}};
    CHECK_THROWS_AS(pass({ball}, {}, {}), course::BadInput);
    ball = at_rest(sphere(1), {double(kNan), 0, 0});
    CHECK_THROWS_AS(pass({ball}, {}, {}), course::BadInput);
    CHECK_THROWS_AS(pass(std::vector<Obstacle>(kMaxObstacles + 1, at_rest(sphere(1))), {}, {}),
                    course::BadInput);
    for (const double dt_s : {0.0, -1.0, double(kNan)})
        CHECK_THROWS_AS(pass({at_rest(sphere(1))}, {}, {}, dt_s), course::BadInput);
}

TEST_CASE("steps tiny and huge") {
    Obstacle ball = at_rest(sphere(0.5f));
    ball.surface.restitution = 1;
    Moved moved = pass({ball}, {make_float4(0, 0.5f, 0, 0)}, {make_float4(0, -1, 0, 0)}, 1e-12);
    CHECK(std::abs(moved.velocity[0].y - 1) < 1e-6f);
    CHECK(std::abs(moved.position[0].y - 0.5f) < 1e-6f);
    moved = pass({ball}, {make_float4(0, -999998, 0, 0)}, {make_float4(0, -1, 0, 0)}, 1e6);  // from y = 2
    CHECK(std::abs(moved.velocity[0].y - 1) < 1e-6f);
    CHECK(std::abs(moved.position[0].y - 999999) <
          1);  // 1.5 m down and the rest up; fp32 has steps of 1/16 there
}

TEST_CASE("an obstacle outside the tank does nothing, one through the wall pushes nobody out of it") {
    const glm::vec3 low(0), high(1);
    const std::vector<float4> x{make_float4(0.1f, 0.05f, 0.5f, 0)}, v{make_float4(0, 0, 0, 0)};
    Moved moved = pass({at_rest(sphere(0.5f), {3, 3, 3})}, x, v, 0.01, 0, low, high);
    course::check_equal(moved.position, x, "position");
    // The middle of the ball is inside, right above the particle: the way out would be through the floor.
    moved = pass({at_rest(sphere(0.2f), {0.1, 0.1, 0.5})}, x, v, 0.01, 0, low, high);
    CHECK(moved.position[0].y >= 0);
    CHECK(finite(moved.position[0]));
}

TEST_CASE("10 km from the origin: as exact as coordinates are there") {
    Obstacle ball = at_rest(sphere(0.5f), {1e4, 0, 0});
    ball.surface.restitution = 1;
    const Moved moved = pass({ball}, {make_float4(1e4f - 0.4f, 0, 0, 0)}, {make_float4(20, 0, 0, 0)}, 0.01);
    CHECK(moved.velocity[0].x < 0);
    CHECK(std::abs(moved.position[0].x - (1e4f - 0.6f)) < 4e-3f);  // fp32 has steps of 1e-3 there
}

TEST_CASE("a ball lighter than a particle: nothing is gained, nothing is lost") {
    Obstacle ball = at_rest(sphere(0.5f));
    ball.control = Control::free;
    ball.mass_kg = 1e-3;
    ball.surface.restitution = 1;
    Setting setting;
    setting.particles = 100;
    setting.dt_s = 0.01;
    std::vector<float4> x, v(100, make_float4(0, -2, 0, 0));
    for (int i = 0; i < 100; ++i)
        x.push_back(make_float4(0.004f * float(i % 10), 0.55f, 0.004f * float(i / 10), 0));
    ObstacleSet obstacles({ball}, setting);
    course::DeviceBuffer<float4> position(x), velocity(v);
    double energy_J = 0.5 * 100 * 4;
    for (int step = 0; step < 30; ++step) {
        obstacles.move();
        auto moved = position.download();
        const auto speed = velocity.download();
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i].y += 0.01f * speed[i].y;
        position.upload(moved);
        obstacles.contact(position.data(), velocity.data(), 100, WholeStep{0.01f});
        obstacles.finish(100);
        const Observation seen = observe(position.data(), velocity.data(), 100, 1, obstacles);
        const double u = glm::length(obstacles.motion(0).velocity_m_per_s);
        double now_J = 0.5 * ball.mass_kg * u * u;
        for (const float4& w : velocity.download())
            now_J += 0.5 * (double(w.x) * w.x + double(w.y) * w.y + double(w.z) * w.z);
        CHECK(now_J < energy_J * (1 + 1e-6));  // fp32 velocities
        energy_J = now_J;
        CHECK(glm::length(seen.momentum_kg_m_per_s + ball.mass_kg * obstacles.motion(0).velocity_m_per_s -
                          glm::dvec3(0, -200, 0)) < 1e-11);  // 100 terms of 2: some 1e-14 each
    }
}

TEST_CASE("water: an obstacle in its place, one that fills the tank, and none at all") {
    WaterSettings settings;
    settings.scene = water_scenes()[0];
    settings.particles = 200;
    settings.scene.obstacles[0].path.start_m = {0.2, 0.2, 0.2};
    CHECK_THROWS_AS(WaterRun{settings}, course::BadInput);
    settings.scene.obstacles[0].solid = box({5, 5, 5});
    CHECK_THROWS_AS(WaterRun{settings}, course::BadInput);
    settings.scene.obstacles.clear();
    WaterRun run(settings);
    run.step();
    run.check_state(1);
    CHECK(run.obstacles().empty());
}

TEST_CASE("water with an obstacle, of one and of two particles") {
    WaterSettings settings;
    settings.scene = water_scenes()[0];
    settings.particles = 1;
    // A particle of all the water is 0.4 m wide: its support does not fit into the tank, which chapter 10
    // says.
    CHECK_THROWS_AS(WaterRun{settings}, course::BadInput);
    settings.particles = 2;
    settings.scene.obstacles[0].path.start_m.x = 0.75;  // room for a gap of 0.1 m
    WaterRun run(settings);
    for (int step = 0; step < 50; ++step) run.step();
    run.check_state(50);
    for (const float4& x : run.water().positions().download()) CHECK(finite(x));
}
