/// @file
/// Ways to take one step in time, over one and the same right-hand side: x' = v, v' = force(t, x) - k v.
///
/// A *system* says what is computed:
/// - `system.force(t, x)`: acceleration by everything but drag;
/// - `system.drag()`: k, in 1/s;
/// - for implicit methods also `system.solve(c, w, b)`: the u of (c + w K) u = b, with K = -dF/dx.
/// A *method* is a struct with one function, `step`, and says what it costs: `kEvaluations` of the force a
/// step. float or double, one dimension or three: the state's type decides.
#pragma once
#include <cmath>
#include <glm/ext/vector_double1.hpp>
#include <glm/glm.hpp>

/// Chapter 02: time steps, their errors and their limits.
namespace integrators {

template <class Real, int D>
using Vec = glm::vec<D, Real, glm::defaultp>;

template <class Real, int D>
struct State {
    Vec<Real, D> x{}, v{};
    Vec<Real, D> force{};  ///< at x: kept from step to step by the methods that ask for it at both ends
};

/// The state at which a run begins. The only place where all methods ask for the force once more.
template <class System, class Real, int D>
State<Real, D> begin(const System& system, Real t, Vec<Real, D> x, Vec<Real, D> v) {
    return {x, v, system.force(t, x)};
}

/// Everything that accelerates: the force, less the drag.
template <class System, class Real, int D>
Vec<Real, D> acceleration(const System& system, Real t, Vec<Real, D> x, Vec<Real, D> v) {
    return system.force(t, x) - Real(system.drag()) * v;
}

// ------------------------------------------------------------------------------------------ the two Eulers

//! [explicit_euler]
/// Follows the tangent at the start of the step. Order 1.
struct ExplicitEuler {
    static constexpr const char* kName = "explicit Euler";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = false;

    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const Vec<Real, D> a = acceleration(system, t, s.x, s.v);
        s.x += dt * s.v;
        s.v += dt * a;
        return s;
    }
};
//! [explicit_euler]

/// The velocity first, then the position with the *new* velocity. Order 1, but symplectic.
struct SemiImplicitEuler {
    static constexpr const char* kName = "semi-implicit Euler";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = false;

    //! [semi_implicit_euler]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        s.v += dt * acceleration(system, t, s.x, s.v);
        s.x += dt * s.v;  // the new velocity
        return s;
    }
    //! [semi_implicit_euler]
};

// --------------------------------------------------------------------------------------------- leapfrog

/// Kick half a step, drift a whole one, kick half a step. The second kick takes its drag from the velocity
/// that it is about to make: v_new = v + dt/2 (F - k v_new), solved for v_new. That keeps the method
/// symmetric: order 2 with drag too, and the same limit omega dt < 2 at any drag. Symplectic without drag.
struct Leapfrog {
    static constexpr const char* kName = "leapfrog";
    static constexpr int kEvaluations = 1;  // the force at the end of a step is that of the next step's start
    static constexpr bool kKeepsForce = true;

    //! [leapfrog]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const Real half = Real(0.5) * dt, k = Real(system.drag());
        s.v += half * (s.force - k * s.v);                         // kick
        s.x += dt * s.v;                                           // drift
        s.force = system.force(t + dt, s.x);                       // the only evaluation
        s.v += half / (Real(1) + half * k) * (s.force - k * s.v);  // kick, with the drag of the new velocity
        return s;
    }
    //! [leapfrog]
};

// ------------------------------------------------------------------------------------------ Runge and Kutta

/// A trial step to the middle, then the whole step with the slope found there. Order 2.
struct Midpoint {
    static constexpr const char* kName = "RK2";
    static constexpr int kEvaluations = 2;
    static constexpr bool kKeepsForce = false;

    //! [midpoint]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const Real half = Real(0.5) * dt;
        const Vec<Real, D> middle_x = s.x + half * s.v;
        const Vec<Real, D> middle_v = s.v + half * acceleration(system, t, s.x, s.v);
        s.x += dt * middle_v;
        s.v += dt * acceleration(system, t + half, middle_x, middle_v);
        return s;
    }
    //! [midpoint]
};

/// Four slopes: one at the start, two in the middle, one at the end. Order 4.
struct RungeKutta4 {
    static constexpr const char* kName = "RK4";
    static constexpr int kEvaluations = 4;
    static constexpr bool kKeepsForce = false;

    //! [runge_kutta_4]
    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        using V = Vec<Real, D>;
        const Real half = Real(0.5) * dt;
        const V v1 = s.v, a1 = acceleration(system, t, s.x, v1);
        const V v2 = s.v + half * a1, a2 = acceleration(system, t + half, V(s.x + half * v1), v2);
        const V v3 = s.v + half * a2, a3 = acceleration(system, t + half, V(s.x + half * v2), v3);
        const V v4 = s.v + dt * a3, a4 = acceleration(system, t + dt, V(s.x + dt * v3), v4);
        s.x += dt / Real(6) * (v1 + Real(2) * (v2 + v3) + v4);
        s.v += dt / Real(6) * (a1 + Real(2) * (a2 + a3) + a4);
        return s;
    }
    //! [runge_kutta_4]
};

}  // namespace integrators
