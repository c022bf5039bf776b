/// @file
/// The exact step of a particle that drag pulls towards a wind while buoyancy lifts it less and less.
///
///     dv/dt = -(v - W) / tau + b exp(-t / cooling) up        dx/dt = v
///
/// W and b are those at the start of the step and hold during it. The solution is a sum of exponentials, so
/// that the step is exact for any length: no limit on dt, however stiff the drag.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/glm.hpp>

namespace fire {

//! [phi]
/// (1 - exp(-x)) / x for x >= 0: the mean of exp(-s) over 0 < s < x. 1 at x = 0.
template <class Real>
__host__ __device__ inline Real mean_decay(Real x) {
    // expm1 keeps the digits that 1 - exp(-x) loses at small x.
    return x > Real(0) ? -std::expm1(-x) / x : Real(1);
}

/// (mean_decay(x) - mean_decay(y)) / (y - x), also where x and y are close or small.
template <class Real>
__host__ __device__ inline Real mean_decay_slope(Real x, Real y) {
    if (x + y < Real(0.1)) {
        // Taylor's series: the difference would lose its digits. The first term left out is below 1e-9.
        const Real xx = x * x, xy = x * y, yy = y * y;
        return Real(0.5) - (x + y) / 6 + (xx + xy + yy) / 24 - (x + y) * (xx + yy) / 120 +
               (xx * xx + xx * xy + xy * xy + xy * yy + yy * yy) / 720 -
               (x + y) * (xx * xx + xy * xy + yy * yy) / 5040;
    }
    const Real middle = (x + y) / 2, half = (y - x) / 2;
    if (std::abs(half) < Real(0.02) * middle) {
        // Close together: the mean slope between them, by Gauss's rule of two points.
        const auto slope = [](Real s) { return (1 - std::exp(-s) * (1 + s)) / (s * s); };
        const Real offset = half * Real(0.5773502691896258);
        return (slope(middle - offset) + slope(middle + offset)) / 2;
    }
    return (mean_decay(x) - mean_decay(y)) / (y - x);
}
//! [phi]

/// What acts on a particle during one step.
template <class Real>
struct Forces {
    glm::vec<3, Real> wind_m_per_s{0};
    Real buoyancy_m_per_s2 = 0;  ///< at the start of the step
    Real drag_time_s = 1;        ///< tau: above 0
    Real cooling_time_s = 0;     ///< buoyancy falls by the factor e in this time; 0: never
};

//! [drag_step]
/// Moves a particle over `dt_s`, exactly.
template <class Real>
__host__ __device__ inline void drag_step(const Forces<Real>& f, Real dt_s, glm::vec<3, Real>& position,
                                          glm::vec<3, Real>& velocity) {
    const Real a = f.cooling_time_s > 0 ? dt_s / f.cooling_time_s : Real(0);
    const Real b = dt_s / f.drag_time_s;
    // The velocity relative to the wind decays; the position gains its mean.
    const glm::vec<3, Real> slip = velocity - f.wind_m_per_s;
    position += dt_s * (f.wind_m_per_s + mean_decay(b) * slip);
    velocity = f.wind_m_per_s + std::exp(-b) * slip;
    // Buoyancy: (exp(-a) - exp(-b)) / (b - a) is the mean of what drag leaves of it.
    const Real low = a < b ? a : b, high = a < b ? b : a;
    velocity.y += f.buoyancy_m_per_s2 * dt_s * std::exp(-low) * mean_decay(high - low);
    position.y += f.buoyancy_m_per_s2 * dt_s * dt_s * mean_decay_slope(low, high);
}
//! [drag_step]

}  // namespace fire
