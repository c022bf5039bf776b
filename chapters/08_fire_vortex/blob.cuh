/// @file
/// One vorton: a blob of rotating gas, and what it does to the gas around it. Lengths in metres, times in
/// seconds.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "05_spatial_grid/cell_grid.cuh"

/// Chapter 08: fire that is stirred by vortices.
namespace vortex {

using grid::xyz;

constexpr double kPi = 3.14159265358979323846;

//! [regularisations]
/// A vorton with all its vorticity in one point would blow its neighbours away at infinite speed. So it is
/// smeared out over a core of size sigma. q(p), p = r / sigma, is the part of it that lies within r: 0 at the
/// centre, 1 far away. Two ways to smear, each as q(r / sigma) / r^3, in a form without 0 / 0 at r = 0.
///
/// Winckelmans and Leonard (1993), algebraic: q = p^3 (p^2 + 5/2) / (p^2 + 1)^(5/2). **The fire's choice**:
/// one division and one square root, and only 1.9 / p^4 of it lies outside of the core.
struct WinckelmansLeonard {
    template <class T>
    static __host__ __device__ T q_over_r3(T r2, T core2) {
        const T s = r2 + core2;
        return (r2 + T(2.5) * core2) / (s * s * std::sqrt(s));
    }
};

/// Gaussian: q = erf(p / sqrt 2) - sqrt(2 / pi) p exp(-p^2 / 2). A line of such blobs is a Lamb-Oseen vortex
/// with a^2 = 2 sigma^2, the exact answer of a viscous fluid; erf and exp cost several times as much.
struct Gaussian {
    template <class T>
    static __host__ __device__ T q_over_r3(T r2, T core2) {
        const T p2 = r2 / core2, r3 = r2 * std::sqrt(r2), half_core3 = core2 * std::sqrt(core2);
        constexpr T kSlope = T(0.7978845608028654);  // sqrt(2 / pi)
        // Near the centre q is a difference of nearly equal numbers. Its series, to p^8, has no such trouble.
        if (p2 < T(0.1)) {
            const T series = T(1) / 3 + p2 * (T(-1) / 10 + p2 * (T(1) / 56 + p2 * (T(-1) / 432 + p2 / 4224)));
            return kSlope * series / half_core3;
        }
        const T p = std::sqrt(p2);
        return (std::erf(p * T(0.7071067811865476)) - kSlope * p * std::exp(T(-0.5) * p2)) / r3;
    }
};
//! [regularisations]

//! [biot_savart]
/// Velocity at a distance `from_vorton_m` (the point minus the vorton) of a vorton of this strength, by the
/// law of Biot and Savart: u = alpha x r q / (4 pi r^3). The right hand's rule: thumb along alpha, the
/// fingers point with the flow.
/// @param strength  alpha = vorticity x volume, in m^3/s
template <class Blob = WinckelmansLeonard, class Vec>
__host__ __device__ Vec induced_velocity(const Vec& strength, const Vec& from_vorton_m,
                                         typename Vec::value_type core_m) {
    using T = typename Vec::value_type;
    const T factor = Blob::q_over_r3(glm::dot(from_vorton_m, from_vorton_m), core_m * core_m);
    return T(1 / (4 * kPi)) * factor * glm::cross(strength, from_vorton_m);
}
//! [biot_savart]

/// How the hot gas of one vorton is spread: 1 / m^3, its integral is 1. It is the very density whose integral
/// up to r is the q of Winckelmans and Leonard.
inline __host__ __device__ float blob_density(float r2, float core2) {
    const float s = r2 + core2;
    return float(15 / (8 * kPi)) * core2 * core2 / (s * s * s * std::sqrt(s));
}

//! [core_turn]
/// The core of a vorton turns like a wheel: u = Omega r for r << sigma. Radians per second.
inline __host__ __device__ float core_turn_rad_per_s(float strength, float core_m) {
    return float(2.5 / (4 * kPi)) * strength / (core_m * core_m * core_m);
}
//! [core_turn]

/// Speed at distance r from an endless straight line of vortons: circulation in m^2/s. The closed forms of
/// the integral of induced_velocity along the line; core 0 gives the point vortex of two-dimensional flow.
template <class T>
T line_speed_winckelmans_leonard(T r, T core, T circulation) {
    const T s = r * r + core * core;
    return circulation * r * (r * r + 2 * core * core) / (T(2 * kPi) * s * s);
}
/// Lamb and Oseen's vortex. 1 - exp(-x) by expm1: near the axis the plain difference keeps no digits.
template <class T>
T lamb_oseen_speed(T r, T a, T circulation) {
    return -circulation * std::expm1(-(r * r) / (a * a)) / (T(2 * kPi) * r);
}

}  // namespace vortex
