/// @file
/// What stiffness asks for: methods that stay stable where a step is long compared to the fastest thing in
/// the system. They need to know more of it than its force.
#pragma once
#include "02_integrators/integrators.h"

namespace integrators {

//! [drag_factors]
/// What drag k leaves of a step, with z = k dt: phi1 = (1 - exp(-z)) / z of its length, and phi2 = (1 - phi1)
/// / z. Without drag that is 1 and 1/2.
struct DragFactors {
    double phi1, phi2;
};

inline DragFactors drag_factors(double z) {
    const double lost = -std::expm1(-z);  // 1 - exp(-z) with all its digits
    if (z < 1e-2)  // 1 - phi1 would have lost its own; the series' next term is below 1e-11 of the sum
        return {1 - z / 2 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5))),
                0.5 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6))))};
    return {lost / z, (1 - lost / z) / z};
}
//! [drag_factors]

/// Solves the drag exactly, for a force that runs straight from its value at the start to that at the end of
/// the step. Without drag it *is* leapfrog. No drag makes it unstable; a stiff spring does.
struct ExponentialLeapfrog {
    static constexpr const char* kName = "exponential leapfrog";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = true;

    //! [exponential_leapfrog]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const DragFactors factors = drag_factors(system.drag() * double(dt));
        const Real phi1 = Real(factors.phi1), phi2 = Real(factors.phi2);
        const Vec<Real, D> a = s.force - Real(system.drag()) * s.v;
        s.x += dt * (s.v + dt * phi2 * a);
        const Vec<Real, D> force = system.force(t + dt, s.x);
        s.v += dt * (phi1 * a + phi2 * (force - s.force));
        s.force = force;
        return s;
    }
    //! [exponential_leapfrog]
};

/// The slope at the *end* of the step, which is not known yet: an equation has to be solved. Order 1. Stable
/// at any dt, and it damps whatever is faster than the step. For forces that are linear in x.
struct ImplicitEuler {
    static constexpr const char* kName = "implicit Euler";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = false;

    //! [implicit_euler]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        // v_new = v + dt (F(x + dt v_new) - k v_new), and F(x + dt v_new) = F(x) - dt K v_new.
        const Real k = Real(system.drag());
        const Vec<Real, D> b = s.v + dt * system.force(t + dt, s.x);
        s.v = system.solve(Real(1) + dt * k, dt * dt, b);
        s.x += dt * s.v;
        return s;
    }
    //! [implicit_euler]
};

/// The slope in the middle, as seen from both ends. Order 2. Stable at any dt, and it damps nothing: what is
/// faster than the step keeps ringing. For forces that are linear in x.
struct ImplicitMidpoint {
    static constexpr const char* kName = "implicit midpoint";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = false;

    //! [implicit_midpoint]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const Real half = Real(0.5) * dt, k = Real(system.drag());
        const Vec<Real, D> b = s.v + half * system.force(t + half, s.x);
        const Vec<Real, D> middle_v = system.solve(Real(1) + half * k, half * half, b);
        s.x += dt * middle_v;
        s.v = Real(2) * middle_v - s.v;
        return s;
    }
    //! [implicit_midpoint]
};

}  // namespace integrators
