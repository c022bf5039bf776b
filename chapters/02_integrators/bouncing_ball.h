/// @file
/// A ball that bounces: between impacts every method of order 2 is exact, so that all its error comes from
/// the moment at which the motion has no derivative.
#pragma once
#include "02_integrators/problems.h"

namespace integrators {

/// x is the height over the floor.
struct BouncingBall {
    static constexpr int kDim = 1;
    double gravity_m_per_s2 = 9.81;
    double restitution = 0.8;  ///< speed after an impact / speed before it

    template <class Real>
    Vec<Real, 1> force(Real, Vec<Real, 1>) const {
        return Vec<Real, 1>(Real(-gravity_m_per_s2));
    }
    double drag() const { return 0; }

    /// When a ball dropped from `height_m` hits the floor for the k-th time, k from 1 on.
    double impact_s(int k, double height_m = 1) const {
        const double first = std::sqrt(2 * height_m / gravity_m_per_s2), e = restitution;
        return first * (1 + 2 * e * (1 - std::pow(e, k - 1)) / (1 - e));
    }
    /// After this time it lies still: infinitely many bounces in a finite time.
    double rest_s(double height_m = 1) const {
        return std::sqrt(2 * height_m / gravity_m_per_s2) * (1 + restitution) / (1 - restitution);
    }

    /// Dropped from a height of 1 + u metres.
    State<double, 1> exact(double u, double t) const {
        const double h = 1 + u, g = gravity_m_per_s2;
        if (t >= rest_s(h)) return begin(*this, t, Vec<double, 1>(0.0), Vec<double, 1>(0.0));
        double since = t, speed = 0, height = h;  // of the present flight: its time, its start
        for (int k = 1; t >= impact_s(k, h); ++k) {
            since = t - impact_s(k, h);
            speed = std::pow(restitution, k) * std::sqrt(2 * g * h);
            height = 0;
        }
        return begin(*this, t, Vec<double, 1>(height + speed * since - 0.5 * g * since * since),
                     Vec<double, 1>(speed - g * since));
    }
    double error(const State<double, 1>& a, const State<double, 1>& b) const {
        return std::abs(a.x.x - b.x.x);
    }
    double energy(const State<double, 1>& s) const { return 0.5 * s.v.x * s.v.x + gravity_m_per_s2 * s.x.x; }
};

/// The simple way: below the floor at the end of a step means that there was an impact. It is put onto the
/// floor and sent back. The impact is up to a step late: order 1, whatever the method in flight.
template <class Flight>
struct ReflectedAtStepEnd {
    static constexpr int kEvaluations = Flight::kEvaluations;
    static constexpr bool kKeepsForce = Flight::kKeepsForce;

    //! [reflected]
    template <class Real>
    static State<Real, 1> step(const BouncingBall& ball, State<Real, 1> s, Real t, Real dt) {
        s = Flight::step(ball, s, t, dt);
        if (s.x.x < 0) {
            s.x.x = 0;
            s.v.x *= Real(-ball.restitution);
        }
        return s;
    }
    //! [reflected]
};

/// Which part of the step is over when the ball meets the floor: where the straight line from the height
/// before to the height after it crosses 0.
template <class Real>
Real impact_fraction(Real height_before, Real height_after) {
    return height_before > 0 ? height_before / (height_before - height_after) : Real(0);
}

/// The impact where it happens, within the step: fly up to it, turn round, fly on. Order 2. One that hits the
/// floor twice in a step is taken to lie still.
template <class Flight>
struct ImpactInterpolated {
    static constexpr int kEvaluations = Flight::kEvaluations;
    static constexpr bool kKeepsForce = Flight::kKeepsForce;

    //! [interpolated]
    template <class Real>
    static State<Real, 1> step(const BouncingBall& ball, State<Real, 1> s, Real t, Real dt) {
        State<Real, 1> after = Flight::step(ball, s, t, dt);
        if (after.x.x < 0) {
            const Real part = impact_fraction(s.x.x, after.x.x);
            s.v += part * (after.v - s.v);  // at the impact
            s.v.x *= Real(-ball.restitution);
            s.x.x = 0;
            after = Flight::step(ball, s, t + part * dt, (1 - part) * dt);
            if (after.x.x < 0) after.x.x = after.v.x = 0;
        }
        return after;
    }
    //! [interpolated]
};

}  // namespace integrators
