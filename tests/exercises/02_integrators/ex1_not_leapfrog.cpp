// Exercise 02.1: the staggered leapfrog, against the answers that leapfrog must give.
#include "ex1_not_leapfrog.h"

#include <cmath>
#include <vector>

#include "tests/support/course_test.h"

using namespace integrators;

namespace {

double spring(double x) {
    return -x;
}
double gravity(double) {
    return -9.81;
}

/// Positions and velocities of an oscillator that starts at x = 1 at rest, at the start and after each step.
struct Motion {
    std::vector<double> x, v;
};
Motion swing(double dt, int steps) {
    Motion motion{{1}, {0}};
    Staggered s = start_staggered(1, 0, dt, spring);
    for (int k = 0; k < steps; ++k) {
        s = step_staggered(s, dt, spring);
        motion.x.push_back(s.x);
        motion.v.push_back(velocity_now(s, dt, spring));
    }
    return motion;
}

}  // namespace

TEST_CASE("positions are those of leapfrog: x_n = cos(n theta) with cos(theta) = 1 - h^2 / 2") {
    course::set_hint(1);
    for (const double h : {0.1, 0.5, 1.0, 1.9}) {
        std::vector<double> expected;
        for (int n = 0; n <= 200; ++n) expected.push_back(std::cos(n * std::acos(1 - h * h / 2)));
        // 200 roundings of 1e-16, ten times as large near the limit h = 2, where x and v / h differ much.
        course::check_close(swing(h, 200).x, expected, course::Tolerance(1e-11), "position", "step");
    }
}

TEST_CASE("energy after 100 periods at omega dt = 0.01") {
    course::set_hint(2);
    const Motion motion = swing(0.01, 62832);
    const double x = motion.x.back(), v = motion.v.back();
    // Leapfrog's energy lies between 1 - h^2 / 4 and 1, for ever.
    course::check_close(std::vector<double>{x * x + v * v}, std::vector<double>{1 - 1.25e-5},
                        course::Tolerance(1.3e-5), "energy / energy at the start", "oscillator");
}

TEST_CASE("velocities at the time of the positions: v^2 + (1 - h^2 / 4) x^2 never changes") {
    course::set_hint(3);
    for (const double h : {0.1, 1.0}) {
        const Motion motion = swing(h, 300);
        std::vector<double> kept;
        for (std::size_t k = 0; k < motion.x.size(); ++k)
            kept.push_back(motion.v[k] * motion.v[k] + (1 - h * h / 4) * motion.x[k] * motion.x[k]);
        course::check_close(kept, std::vector<double>(301, 1 - h * h / 4), course::Tolerance(1e-12),
                            "invariant", "step");
    }
}

TEST_CASE("free fall is exact, position and velocity") {
    course::set_hint(1);
    const double dt = 0.01;
    Staggered s = start_staggered(0, 2, dt, gravity);
    std::vector<double> x, v, exact_x, exact_v;
    for (int n = 1; n <= 100; ++n) {
        s = step_staggered(s, dt, gravity);
        const double t = n * dt;
        x.push_back(s.x), v.push_back(velocity_now(s, dt, gravity));
        exact_x.push_back(2 * t - 0.5 * 9.81 * t * t), exact_v.push_back(2 - 9.81 * t);
    }
    course::check_close(x, exact_x, course::Tolerance(1e-12), "position",
                        "step");  // 100 roundings below 1e-15
    course::check_close(v, exact_v, course::Tolerance(1e-12), "velocity", "step");
}

TEST_CASE("order 2, away from whole periods") {
    course::set_hint(2);
    const auto error = [](int steps) { return std::abs(swing(5.0 / steps, steps).x.back() - std::cos(5.0)); };
    const double order = std::log2(error(400) / error(800));
    CHECK_MESSAGE(!!(std::abs(order - 2) <= 0.02), "order " << order << ", expected 2");
}
