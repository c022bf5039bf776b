/// @file
/// What can be said of a body of water before its first step: whether its numbers are numbers, its box a box,
/// and its particles inside.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "10_water_sph/sph.cuh"
#include "common/errors.h"

namespace sph {

/// Largest distance between neighbouring fp32 coordinates that is accepted, in support radii. Forces are off
/// by about six times that (study `precision`): here by 0.6 %, a tenth of what the sums themselves are off
/// by. And particles slower than about c / 1000 no longer move.
constexpr float kCoarsestCoordinate = 1e-3f;

/// Distance from |x| to the next larger fp32 number.
inline float coordinate_resolution_m(float x_m) {
    const float magnitude = std::fabs(x_m);
    return std::nextafter(magnitude, INFINITY) - magnitude;
}

/// @throws course::BadInput naming what is wrong with the fluid
inline void check_fluid(const Fluid& fluid) {
    const auto want = [](bool good, const char* what, float value) {
        if (!good) throw course::BadInput(what + std::string(", not ") + std::to_string(value));
    };
    const auto positive = [](float x) { return x > 0 && std::isfinite(x); };
    want(positive(fluid.support_m), "the support radius must be above 0", fluid.support_m);
    want(positive(fluid.mass_kg), "a particle's mass must be above 0", fluid.mass_kg);
    want(positive(fluid.rest_density_kg_per_m3), "the rest density must be above 0",
         fluid.rest_density_kg_per_m3);
    want(positive(fluid.sound_speed_m_per_s),
         "the sound speed must be above 0: without it there is no pressure", fluid.sound_speed_m_per_s);
    want(fluid.viscosity_m2_per_s >= 0 && std::isfinite(fluid.viscosity_m2_per_s),
         "the viscosity must be 0 or above", fluid.viscosity_m2_per_s);
    const float3 g = fluid.gravity_m_per_s2;
    want(grid::is_finite({g.x, g.y, g.z}), "gravity must be finite", g.x + g.y + g.z);
}

/// @throws course::BadInput if the box is narrower than the support radius, so that its walls could not be
/// mirrors, or so far from the origin that fp32 coordinates in it are too coarse for that radius
inline void check_box(const Box& box, float support_m) {
    const float low[3] = {box.low_m.x, box.low_m.y, box.low_m.z},
                high[3] = {box.high_m.x, box.high_m.y, box.high_m.z};
    for (int axis = 0; axis < 3; ++axis) {
        char text[256];
        const float width_m = high[axis] - low[axis];
        if (!(width_m >= support_m)) {
            std::snprintf(
                text, sizeof text,
                "the box is %g m wide along %c, less than the support radius of %g m: use more, and so "
                "smaller, particles",
                width_m, "xyz"[axis], support_m);
            throw course::BadInput(text);
        }
        const float farthest_m = std::max(std::fabs(low[axis]), std::fabs(high[axis]));
        const float resolution_m = coordinate_resolution_m(farthest_m);
        if (!(resolution_m <= kCoarsestCoordinate * support_m)) {
            std::snprintf(
                text, sizeof text,
                "the box reaches %g m from the origin along %c, where fp32 coordinates are %g m apart: "
                "too coarse for a support radius of %g m; put the box nearer to the origin",
                farthest_m, "xyz"[axis], resolution_m, support_m);
            throw course::BadInput(text);
        }
    }
}

/// @throws course::BadInput naming the first particle that is no number or lies outside the box
inline void check_particles(const std::vector<float4>& position, const std::vector<float4>& velocity,
                            const Box& box) {
    if (position.size() != velocity.size())
        throw course::BadInput(std::to_string(position.size()) + " positions and " +
                               std::to_string(velocity.size()) + " velocities: each particle needs both");
    for (std::size_t i = 0; i < position.size(); ++i) {
        const float4 x = position[i], v = velocity[i];
        // Written so that NaN, for which every comparison is false, lies outside.
        const bool inside = x.x >= box.low_m.x && x.x <= box.high_m.x && x.y >= box.low_m.y &&
                            x.y <= box.high_m.y && x.z >= box.low_m.z && x.z <= box.high_m.z;
        if (inside && grid::is_finite(grid::xyz(v))) continue;
        char text[256];
        std::snprintf(text, sizeof text, "particle %zu starts at (%g, %g, %g) m with (%g, %g, %g) m/s: %s", i,
                      x.x, x.y, x.z, v.x, v.y, v.z,
                      inside ? "that is no velocity" : "that is not inside the box");
        throw course::BadInput(text);
    }
}

}  // namespace sph
