/// @file
/// How long a step may be. On a linear system, a step multiplies the state by a matrix; how that grows when
/// it is applied again and again is told by its largest eigenvalue. No formula is needed: the step itself
/// gives the matrix.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "02_integrators/problems.h"

namespace integrators {

//! [amplification]
/// What a step makes of (x, v). Its columns are what becomes of (1, 0) and of (0, 1).
struct StepMatrix {
    double xx, xv, vx, vv;
};

template <class Method, class LinearSystem>
StepMatrix step_matrix(const LinearSystem& system, double dt) {
    const auto image = [&](double x, double v) {
        return Method::step(system, begin(system, 0.0, Vec<double, 1>(x), Vec<double, 1>(v)), 0.0, dt);
    };
    const State<double, 1> of_x = image(1, 0), of_v = image(0, 1);
    return {of_x.x.x, of_v.x.x, of_x.v.x, of_v.v.x};
}

/// Size of the largest eigenvalue, a root of z^2 - trace z + det = 0: growth per step, in the long run.
inline double spectral_radius(const StepMatrix& m) {
    const double half_trace = 0.5 * (m.xx + m.vv), det = m.xx * m.vv - m.xv * m.vx;
    const double half_difference = 0.5 * (m.xx - m.vv), d = half_difference * half_difference + m.xv * m.vx;
    return d < 0 ? std::sqrt(det) : std::abs(half_trace) + std::sqrt(d);
}
//! [amplification]

/// The longest stable step of a method: up to it, no state grows. Found by trying ever longer steps from
/// `first_s` on, then bisecting. 0 if the first one grows already; infinite if none does.
template <class Method, class LinearSystem>
double stability_limit(const LinearSystem& system, double first_s) {
    // An eigenvalue of size 1 exactly, as leapfrog's without drag, may come out a few roundings above it.
    const auto stable = [&](double dt) {
        return spectral_radius(step_matrix<Method>(system, dt)) <= 1 + 1e-13;
    };
    if (!stable(first_s)) return 0;
    double low = first_s, high = first_s;
    while (stable(high *= 1.02)) {
        low = high;
        if (high > 1e6 * first_s) return std::numeric_limits<double>::infinity();
    }
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

/// The largest stable omega dt at a drag ratio.
template <class Method>
double stability_limit(double zeta) {
    return stability_limit<Method>(Oscillator{1, zeta}, 2e-3);
}

/// Drag and nothing else.
struct DragAlone {
    static constexpr int kDim = 1;
    double drag_per_s = 1;

    template <class Real>
    Vec<Real, 1> force(Real, Vec<Real, 1>) const {
        return Vec<Real, 1>(Real(0));
    }
    double drag() const { return drag_per_s; }
    template <class Real>
    Vec<Real, 1> solve(Real c, Real, Vec<Real, 1> b) const {
        return (Real(1) / c) * b;
    }
    State<double, 1> exact(double, double t) const {
        return begin(*this, t, Vec<double, 1>(-std::expm1(-drag_per_s * t) / drag_per_s),
                     Vec<double, 1>(std::exp(-drag_per_s * t)));
    }
};

// ----------------------------------------------------------- the longest stable step of each problem, in
// seconds

template <class Method>
double longest_step_s(const Oscillator& s) {
    return stability_limit<Method>(s.zeta) / s.omega_per_s;
}
/// Set by the faster of its two motions.
template <class Method>
double longest_step_s(const StiffPair& s) {
    return stability_limit<Method>(0.0) / std::sqrt(std::max(1.0, s.ratio));
}
template <class Method>
double longest_step_s(const MoteInWind& s) {
    return stability_limit<Method>(DragAlone{}, 2e-3) / s.drag_per_s;
}
template <class Method>
double longest_step_s(const Projectile& s) {
    return stability_limit<Method>(DragAlone{}, 2e-3) * s.relaxation_s;
}
/// As if the comet stayed at its perihelion r, where the pull changes along r as that of a spring of 2 / r^3.
template <class Method>
double longest_step_s(const Kepler& s) {
    return stability_limit<Method>(0.0) * std::sqrt(0.5 * std::pow(1 - s.eccentricity, 3));
}

}  // namespace integrators
