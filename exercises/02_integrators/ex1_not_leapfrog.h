// Exercise 02.1: the leapfrog that is not leapfrog.
//
// This listing looks like leapfrog: velocities live half a step between the positions, v_minus before and
// v_plus after. A thesis printed it much like this, and it ran, and nobody noticed. Its energy tells: after
// 100 periods at omega dt = 0.01 an oscillator has 23 times the energy it started with. (Explicit Euler has
// 535 times as much, leapfrog 0.99998.) Find what is wrong, and mend it.
#pragma once
#include "common/todo.h"

namespace integrators {

// x at a time t, and v_minus half a step earlier.
struct Staggered {
    double x = 0, v_minus = 0;
};

// Brings the velocity v at t = 0 to half a step before, so that the first step finds it where it belongs.
template <class Acceleration>
Staggered start_staggered(double x, double v, double dt, const Acceleration& a) {
    return {x, v - 0.5 * dt * a(x)};
}

// From t to t + dt.
template <class Acceleration>
Staggered step_staggered(Staggered s, double dt, const Acceleration& a) {
    // TODO(2.1): one of these lines is wrong. Which velocity stands in the middle of the jump of x?
    const double v_plus = s.v_minus + a(s.x) * dt;
    const double v = (s.v_minus + v_plus) / 2;
    s.x += v * dt;
    s.v_minus = v_plus;
    return s;
}

// The velocity at the time of x, for energies and pictures.
template <class Acceleration>
double velocity_now(const Staggered& s, double dt, const Acceleration& a) {
    // TODO(2.1): there *is* a use for an average. About 1 line.
    (void)s, (void)dt, (void)a;
    return course::kTodo;
}

}  // namespace integrators
