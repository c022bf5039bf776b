// Exercise 02.3: three leapfrogs make a better one.
//
// Leapfrog is symmetric: its error per step is an odd power of dt, c dt^3 + ... Take a step of w1 dt, one of
// w0 dt and another of w1 dt. They make up one dt, and their errors of third order cancel, if
//     2 w1 + w0 = 1    and    2 w1^3 + w0^3 = 0.
// The result is symplectic as leapfrog is, needs no more memory, and has order 4. (H. Yoshida, 1990.)
#pragma once
#include <cmath>
#include <initializer_list>

#include "02_integrators/integrators.h"
#include "common/todo.h"

namespace integrators {

struct Weights {
    double w1, w0;
};

inline Weights fourth_order_weights() {
    // TODO(2.3): solve the two equations. One of the weights is negative: there is a step back in time.
    // About 2 lines.
    // <solution>
    const double w1 = 1 / (2 - std::cbrt(2.0));
    return {w1, 1 - 2 * w1};
    // <stub>
    //| return {course::kTodo, course::kTodo};
    // </solution>
}

// One step of the fourth-order method. It may call Leapfrog::step, as any method of the chapter.
struct FourthOrder {
    static constexpr const char* kName = "three leapfrogs";
    static constexpr int kEvaluations = 3;
    static constexpr bool kKeepsForce = true;

    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        // TODO(2.3): three steps of Leapfrog. Each starts when the last one ended. About 6 lines.
        // <solution>
        const Weights weights = fourth_order_weights();
        for (const double w : {weights.w1, weights.w0, weights.w1}) {
            const Real part = Real(w) * dt;
            s = Leapfrog::step(system, s, t, part);
            t += part;
        }
        return s;
        // <stub>
        //| (void)system, (void)t, (void)dt;
        //| s.x = s.v = Vec<Real, D>(Real(course::kTodo));
        //| return s;
        // </solution>
    }
};

}  // namespace integrators
