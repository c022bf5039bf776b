// Exercise 01.1: the exact step, against the solution of the equation in double precision.
#include "ex1_exact_drag.h"

#include <cstdio>

#include "tests/support/course_test.h"

using namespace particle_loop;

namespace {

struct Flight {
    glm::dvec3 position_m, velocity_m_per_s;
};

/// The flight of t seconds in double precision, by a series where the closed form loses digits.
Flight exact_flight(const Fountain& f, const Particle& start, double t) {
    const double k = f.drag_per_s, h = k * t;
    const double reach = h < 1e-3 ? t * (1 - h / 2 + h * h / 6 - h * h * h / 24) : -std::expm1(-h) / k;
    const double fall = h < 1e-3 ? t * t * (0.5 - h / 6 + h * h / 24) : (t - reach) / k;
    const glm::dvec3 x(start.position_m), v(start.velocity_m_per_s), g(0, -f.gravity_m_per_s2, 0);
    return {x + reach * v + fall * g, std::exp(-h) * v + reach * g};
}

/// `steps` steps that make up t seconds, against the formula.
void check_flight(float drag_per_s, double t, int steps, course::Tolerance tolerance) {
    Fountain fountain;
    fountain.drag_per_s = drag_per_s;
    const Particle start{{1, 2, 3}, {3, 8, -2}};
    const ExactStep step = exact_step(drag_per_s, float(t / steps));
    Particle p = start;
    for (int s = 0; s < steps; ++s) move_exactly(fountain, step, p.position_m, p.velocity_m_per_s);
    const Flight exact = exact_flight(fountain, start, t);
    char what[80];
    std::snprintf(what, sizeof what, " after %g s in %d steps, drag %g per s,", t, steps, drag_per_s);
    course::check_close(std::vector<glm::dvec3>{glm::dvec3(p.position_m)}, {exact.position_m}, tolerance,
                        std::string("position") + what, "droplet");
    course::check_close(std::vector<glm::dvec3>{glm::dvec3(p.velocity_m_per_s)}, {exact.velocity_m_per_s},
                        tolerance, std::string("velocity") + what, "droplet");
}

// Three roundings of a sum of numbers below 16, each by up to 4.8e-7.
const course::Tolerance kOneStep(1.5e-6, 1e-6);

}  // namespace

TEST_CASE("one step of a second, with the fountain's drag") {
    course::set_hint(1);
    check_flight(0.35f, 1.0, 1, kOneStep);
    check_flight(0.35f, 0.004, 1, kOneStep);
}

TEST_CASE("a hundred steps end where one does") {
    course::set_hint(4);
    check_flight(2.0f, 1.0, 100, course::Tolerance(1e-4));  // 100 times kOneStep
}

TEST_CASE("no drag") {
    course::set_hint(3);
    check_flight(0.0f, 0.5, 1, kOneStep);
}

TEST_CASE("drag that is nearly none: no digits lost") {
    course::set_hint(2);
    for (const float drag : {1e-12f, 1e-7f, 1e-5f, 1e-3f}) check_flight(drag, 1.0, 1, kOneStep);
}

TEST_CASE("drag so strong that the chapter's step would explode") {
    course::set_hint(1);
    check_flight(50.0f, 1.0, 1, kOneStep);
    check_flight(1000.0f, 1.0, 10, course::Tolerance(1.5e-5, 1e-6));
}
