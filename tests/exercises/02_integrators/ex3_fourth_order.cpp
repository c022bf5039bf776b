// Exercise 02.3: order, energy and cost of three leapfrogs in one step.
#include "ex3_fourth_order.h"

#include <cmath>
#include <vector>

#include "02_integrators/problems.h"
#include "tests/support/course_test.h"

using namespace integrators;

namespace {

template <class System>
State<double, System::kDim> fly(const System& system, double end_s, int steps) {
    State<double, System::kDim> s = system.exact(0, 0);
    const double dt = end_s / steps;
    for (int k = 0; k < steps; ++k) s = FourthOrder::step(system, s, k * dt, dt);
    return s;
}

template <class System>
double order(const System& system, double end_s, int steps) {
    const auto error = [&](int n) { return system.error(fly(system, end_s, n), system.exact(0, end_s)); };
    return std::log2(error(steps) / error(2 * steps));
}

/// A spring that is shaken: x'' = -x + cos(2 t), x = (4 cos t - cos 2t) / 3 when it starts at 1 at rest.
struct Shaken : Oscillator {
    mutable int evaluations = 0;

    template <class Real>
    Vec<Real, 1> force(Real t, Vec<Real, 1> x) const {
        ++evaluations;
        return -x + std::cos(2 * t);
    }
    State<double, 1> exact(double, double t) const {
        return begin(*this, t, Vec<double, 1>((4 * std::cos(t) - std::cos(2 * t)) / 3),
                     Vec<double, 1>((-4 * std::sin(t) + 2 * std::sin(2 * t)) / 3));
    }
};

}  // namespace

TEST_CASE("the weights solve both equations") {
    course::set_hint(1);
    const Weights w = fourth_order_weights();
    course::check_close(std::vector<double>{2 * w.w1 + w.w0, 2 * w.w1 * w.w1 * w.w1 + w.w0 * w.w0 * w.w0},
                        std::vector<double>{1, 0}, course::Tolerance(1e-13), "equation", "equation");
    CHECK_MESSAGE(w.w1 > 1, "w1 = " << w.w1);  // the real solution: longer than the whole step, and back
}

TEST_CASE("order 4 on the oscillator, away from whole periods") {
    course::set_hint(2);
    const double measured = order(Oscillator{}, 5.0, 100);
    CHECK_MESSAGE(!!(std::abs(measured - 4) <= 0.05), "order " << measured << ", expected 4");
}

TEST_CASE("order 4 on a force that depends on time") {
    course::set_hint(3);
    const double measured = order(Shaken{}, 5.0, 200);
    CHECK_MESSAGE(!!(std::abs(measured - 4) <= 0.1), "order " << measured << ", expected 4");
}

TEST_CASE("three evaluations of the force a step, and no more") {
    course::set_hint(2);
    const Shaken system;
    State<double, 1> s = system.exact(0, 0);
    system.evaluations = 0;
    for (int k = 0; k < 10; ++k) s = FourthOrder::step(system, s, 0.1 * k, 0.1);
    CHECK_MESSAGE(system.evaluations == 30, system.evaluations << " evaluations in 10 steps, expected 30");
}

TEST_CASE("energy does not drift over a thousand periods") {
    course::set_hint(2);
    State<double, 1> s = Oscillator{}.exact(0, 0);
    std::vector<double> energies;
    for (int period = 0; period < 1000; ++period) {
        for (int k = 0; k < 20; ++k) s = FourthOrder::step(Oscillator{}, s, 0.0, 2 * kPi / 20);
        if (period % 100 == 99) energies.push_back(s.x.x * s.x.x + s.v.x * s.v.x);
    }
    // It swings within (omega dt)^4 / 12 = 8e-4, for ever; RK4 at this step has lost a quarter by now.
    course::check_close(energies, std::vector<double>(10, 1.0), course::Tolerance(1.6e-3), "energy",
                        "hundred periods");
}

TEST_CASE("a comet keeps its angular momentum, and comes back 50 times nearer than with leapfrog") {
    course::set_hint(2);
    const int steps = 4000;
    const State<double, 2> s = fly(Kepler{}, 2 * kPi, steps);
    course::check_close(std::vector<double>{Kepler::angular_momentum(s)},
                        std::vector<double>{std::sqrt(0.19)}, course::Tolerance(1e-12), "angular momentum",
                        "comet");
    State<double, 2> leapfrog = Kepler{}.exact(0, 0);  // the same number of evaluations
    for (int k = 0; k < 3 * steps; ++k)
        leapfrog = Leapfrog::step(Kepler{}, leapfrog, 0.0, 2 * kPi / (3 * steps));
    const double near = Kepler{}.error(s, Kepler{}.exact(0, 0)),
                 far = Kepler{}.error(leapfrog, Kepler{}.exact(0, 0));
    CHECK_MESSAGE(!!(near <= far / 50), "distance " << near << ", with leapfrog " << far);
}
