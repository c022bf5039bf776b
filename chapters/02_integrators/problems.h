/// @file
/// Systems whose motion is known, so that a method's error can be measured and not guessed. Parameters are
/// double; the forces compute in the precision of the state they are asked with.
///
/// `exact(u, t)` is the answer for a family of starts, u in [0, 1): all of them solve the same problem, each
/// with other roundings. u = 0 is the one with published numbers. `error(got, exact)` is what the studies
/// plot.
#pragma once
#include <cmath>

#include "02_integrators/integrators.h"

namespace integrators {

constexpr double kPi = 3.14159265358979323846;

//! [oscillator]
/// A spring with drag: x'' = -omega^2 x - 2 zeta omega x'. Drag ratio zeta: below 1 it swings, from 1 on it
/// creeps.
struct Oscillator {
    static constexpr int kDim = 1;
    double omega_per_s = 1, zeta = 0;

    template <class Real>
    Vec<Real, 1> force(Real, Vec<Real, 1> x) const {
        return -Real(omega_per_s * omega_per_s) * x;
    }
    double drag() const { return 2 * zeta * omega_per_s; }
    template <class Real>
    Vec<Real, 1> solve(Real c, Real w, Vec<Real, 1> b) const {
        return (Real(1) / (c + w * Real(omega_per_s * omega_per_s))) * b;
    }
    //! [oscillator]

    /// Starts all around the circle x^2 + (v / omega)^2 = 1.
    State<double, 1> exact(double u, double t) const {
        const double x0 = std::cos(2 * kPi * u), v0 = -std::sin(2 * kPi * u), tau = omega_per_s * t;
        double x, v;
        if (zeta < 1) {
            const double w = std::sqrt(1 - zeta * zeta), c = std::cos(w * tau), s = std::sin(w * tau) / w;
            x = std::exp(-zeta * tau) * (x0 * c + (v0 + zeta * x0) * s);
            v = std::exp(-zeta * tau) * (v0 * c - (x0 + zeta * v0) * s);
        } else if (zeta == 1) {
            x = std::exp(-tau) * (x0 + (v0 + x0) * tau);
            v = std::exp(-tau) * (v0 - (v0 + x0) * tau);
        } else {  // two rates; their product is 1, so that the slow one loses no digits
            const double fast = -zeta - std::sqrt(zeta * zeta - 1), slow = 1 / fast;
            const double a = (v0 - fast * x0) / (slow - fast), b = x0 - a;
            x = a * std::exp(slow * tau) + b * std::exp(fast * tau);
            v = a * slow * std::exp(slow * tau) + b * fast * std::exp(fast * tau);
        }
        return begin(*this, t, Vec<double, 1>(x), Vec<double, 1>(omega_per_s * v));
    }
    /// Distance in the plane of x and v / omega.
    double error(const State<double, 1>& a, const State<double, 1>& b) const {
        return std::hypot(a.x.x - b.x.x, (a.v.x - b.v.x) / omega_per_s);
    }
};

//! [stiff_pair]
/// Two masses, each on a spring of stiffness 1, joined by a spring so hard that the stiffest motion is
/// `ratio` times as stiff as the softest: together they swing with omega = 1, against each other with
/// sqrt(ratio).
struct StiffPair {
    static constexpr int kDim = 2;
    double ratio = 1e6;

    template <class Real>
    Vec<Real, 2> force(Real, Vec<Real, 2> x) const {
        const Real joint = Real(0.5 * (ratio - 1)) * (x.x - x.y);
        return {-x.x - joint, -x.y + joint};
    }
    double drag() const { return 0; }
    /// By the sum and the difference, in which the two equations are one each.
    template <class Real>
    Vec<Real, 2> solve(Real c, Real w, Vec<Real, 2> b) const {
        const Real sum = (Real(0.5) / (c + w)) * (b.x + b.y);
        const Real difference = (Real(0.5) / (c + w * Real(ratio))) * (b.x - b.y);
        return {sum + difference, sum - difference};
    }
    //! [stiff_pair]

    /// Both motions start at 1 + u, at rest.
    State<double, 2> exact(double u, double t) const {
        const double w = std::sqrt(ratio), a = (1 + u) * std::sqrt(0.5);
        const double slow = a * std::cos(t), fast = a * std::cos(w * t);
        const double slow_v = -a * std::sin(t), fast_v = -a * w * std::sin(w * t);
        return begin(*this, t, Vec<double, 2>(slow + fast, slow - fast),
                     Vec<double, 2>(slow_v + fast_v, slow_v - fast_v));
    }
    static double slow_mode(const State<double, 2>& s) { return std::sqrt(0.5) * (s.x.x + s.x.y); }
    static double fast_mode(const State<double, 2>& s) { return std::sqrt(0.5) * (s.x.x - s.x.y); }
    /// Of the slow motion alone: it is what one wants to see.
    double error(const State<double, 2>& a, const State<double, 2>& b) const {
        return std::abs(slow_mode(a) - slow_mode(b));
    }
};

//! [wind]
/// A mote so light that it has no choice but to follow the wind: v' = -k (v - cos t) - sin t, with v = cos t
/// for all k. The problem of Prothero and Robinson (1974), told as smoke.
struct MoteInWind {
    static constexpr int kDim = 1;
    double drag_per_s = 1e6;

    template <class Real>
    Vec<Real, 1> force(Real t, Vec<Real, 1>) const {
        return Vec<Real, 1>(Real(drag_per_s) * std::cos(t) - std::sin(t));
    }
    double drag() const { return drag_per_s; }
    template <class Real>
    Vec<Real, 1> solve(Real c, Real, Vec<Real, 1> b) const {
        return (Real(1) / c) * b;
    }
    //! [wind]

    State<double, 1> exact(double, double t) const {
        return begin(*this, t, Vec<double, 1>(std::sin(t)), Vec<double, 1>(std::cos(t)));
    }
    double error(const State<double, 1>& a, const State<double, 1>& b) const {
        return std::abs(a.v.x - b.v.x);
    }
};

/// A ball thrown through air with linear drag. y is up.
struct Projectile {
    static constexpr int kDim = 2;
    double gravity_m_per_s2 = 9.81, relaxation_s = 2;  ///< in which drag takes away 63 % of a speed

    template <class Real>
    Vec<Real, 2> force(Real, Vec<Real, 2>) const {
        return {Real(0), Real(-gravity_m_per_s2)};
    }
    double drag() const { return 1 / relaxation_s; }
    template <class Real>
    Vec<Real, 2> solve(Real c, Real, Vec<Real, 2> b) const {
        return (Real(1) / c) * b;
    }

    /// Thrown from the origin with (30, 40) m/s, or up to twice as fast.
    State<double, 2> exact(double u, double t) const {
        const double tau = relaxation_s, lost = -std::expm1(-t / tau), fall = gravity_m_per_s2 * tau;
        const double vx = 30 * (1 + u), vy = 40 * (1 + u);
        return begin(*this, t, Vec<double, 2>(vx * tau * lost, (vy + fall) * tau * lost - fall * t),
                     Vec<double, 2>(vx * (1 - lost), vy - (vy + fall) * lost));
    }
    double error(const State<double, 2>& a, const State<double, 2>& b) const {
        return glm::length(a.x - b.x);
    }
};

/// A comet around a sun, G M = 1, semi-major axis 1: x'' = -x / |x|^3. Period 2 pi.
struct Kepler {
    static constexpr int kDim = 2;
    double eccentricity = 0.9;

    //! [kepler_force]
    template <class Real>
    Vec<Real, 2> force(Real, Vec<Real, 2> x) const {
        const Real r2 = x.x * x.x + x.y * x.y;
        return x * (Real(-1) / (r2 * std::sqrt(r2)));
    }
    //! [kepler_force]
    double drag() const { return 0; }

    //! [kepler_exact]
    /// From the perihelion; the orbit lies turned by the angle 2 pi u. Where the comet is at time t follows
    /// from Kepler's equation E - e sin E = t, solved by Newton's method.
    State<double, 2> exact(double u, double t) const {
        const double e = eccentricity, b = std::sqrt(1 - e * e);
        const double mean = std::remainder(t, 2 * kPi);   // in [-pi, pi]
        double E = mean + std::copysign(0.85 * e, mean);  // a start from which Newton's method never strays
        for (int k = 0; k < 30; ++k) {
            const double step = (E - e * std::sin(E) - mean) / (1 - e * std::cos(E));
            E -= step;
            if (std::abs(step) < 1e-16) break;
        }
        const double rate = 1 / (1 - e * std::cos(E));  // dE/dt
        const Vec<double, 2> x(std::cos(E) - e, b * std::sin(E)),
            v(-std::sin(E) * rate, b * std::cos(E) * rate);
        const double c = std::cos(2 * kPi * u), s = std::sin(2 * kPi * u);
        const auto turned = [&](Vec<double, 2> p) {
            return Vec<double, 2>(c * p.x - s * p.y, s * p.x + c * p.y);
        };
        return begin(*this, t, turned(x), turned(v));
    }
    //! [kepler_exact]
    double error(const State<double, 2>& a, const State<double, 2>& b) const {
        return glm::length(a.x - b.x);
    }
    static double energy(const State<double, 2>& s) {
        return 0.5 * glm::dot(s.v, s.v) - 1 / glm::length(s.x);
    }
    static double angular_momentum(const State<double, 2>& s) { return s.x.x * s.v.y - s.x.y * s.v.x; }
};

}  // namespace integrators
