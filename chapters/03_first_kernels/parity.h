/// @file
/// Do host and device agree? And where they don't: is it rounding, or a droplet that bounced a step earlier?
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "01_particle_loop/particle_loop.h"

namespace first_kernels {

/// What rounding alone can do to a position of these fountains in one life of 462 steps. The device fuses
/// a * b + c into one operation with one rounding, the host may do two; each rounds a velocity below 8 m/s by
/// up to 2.4e-7 m/s and a position below 4 m by up to 1.2e-7 m, each step. All in the same direction, that is
/// 462 * 2.4e-7 m/s * 1.85 s / 2 + 462 * 1.2e-7 m = 1.6e-4 m on either side.
constexpr double kRoundingBound_m = 3.2e-4;

/// What a bounce one step early or late can do: the floor and gravity act on other velocities for that step,
/// (1 + restitution) g dt = 0.055 m/s, for what is left of a life, at most 1.85 s.
constexpr double kOtherBounceBound_m = 0.11;

//! [parity]
struct Parity {
    double largest_m = 0;            ///< largest distance that rounding can explain
    std::uint32_t other_bounce = 0;  ///< droplets further apart: they touched the floor in another step
    double largest_other_m = 0;      ///< largest distance among those; infinite if a number is none
};

/// Compares the first `count` droplets.
inline Parity compare_positions(const std::vector<particle_loop::Particle>& host,
                                const std::vector<particle_loop::Particle>& device, std::uint32_t count) {
    Parity parity;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double distance_m =
            glm::distance(glm::dvec3(host[i].position_m), glm::dvec3(device[i].position_m));
        if (distance_m <= kRoundingBound_m) {
            parity.largest_m = std::max(parity.largest_m, distance_m);
            continue;
        }
        ++parity.other_bounce;  // NaN ends up here, too: it is not <= anything
        parity.largest_other_m = std::isfinite(distance_m) ? std::max(parity.largest_other_m, distance_m)
                                                           : std::numeric_limits<double>::infinity();
    }
    return parity;
}
//! [parity]

}  // namespace first_kernels
