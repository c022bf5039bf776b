/// @file
/// The same methods with the drag put elsewhere: a line's difference each, and another order or another
/// limit. You meet all of them in particle codes. (Leapfrog's own place for it is in integrators.h.)
#pragma once
#include "02_integrators/integrators.h"

namespace integrators {

/// Semi-implicit Euler whose drag is that of the new velocity. More drag, *longer* stable steps.
struct SemiImplicitEulerImplicitDrag {
    static constexpr const char* kName = "semi-implicit Euler, implicit drag";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = false;

    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        // v_new = v + dt (F - k v_new), solved for v_new
        s.v += dt / (Real(1) + dt * Real(system.drag())) * acceleration(system, t, s.x, s.v);
        s.x += dt * s.v;
        return s;
    }
};

/// Leapfrog whose second kick takes the drag of the velocity it has: order 1 as soon as there is drag.
struct LeapfrogLaggedDrag {
    static constexpr const char* kName = "leapfrog, lagged drag";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = true;

    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const Real half = Real(0.5) * dt, k = Real(system.drag());
        s.v += half * (s.force - k * s.v);
        s.x += dt * s.v;
        s.force = system.force(t + dt, s.x);
        s.v += half * (s.force - k * s.v);
        return s;
    }
};

/// Velocity Verlet with a predicted velocity for the drag at the end of the step, as many fluid codes have
/// it: order 2, but its limit falls with the drag.
struct LeapfrogPredictedDrag {
    static constexpr const char* kName = "leapfrog, predicted drag";
    static constexpr int kEvaluations = 1;
    static constexpr bool kKeepsForce = true;

    template <class System, class Real, int D>
    static State<Real, D> step(const System& system, State<Real, D> s, Real t, Real dt) {
        const Real half = Real(0.5) * dt, k = Real(system.drag());
        const Vec<Real, D> a = s.force - k * s.v, predicted_v = s.v + dt * a;
        s.x += dt * (s.v + half * a);
        s.force = system.force(t + dt, s.x);
        s.v += half * (a + s.force - k * predicted_v);
        return s;
    }
};

}  // namespace integrators
