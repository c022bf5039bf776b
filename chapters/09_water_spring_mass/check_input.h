/// @file
/// What can be said of a body of marbles before its first step: whether its numbers are numbers, its box a
/// box, and its marbles inside.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "04_parallel_patterns/bounds.cuh"
#include "09_water_spring_mass/contact.cuh"
#include "common/errors.h"

namespace spring_mass {

/// Largest distance between neighbouring fp32 coordinates that is accepted, in diameters. Marbles at rest
/// are pressed together by about 1/1000 of their diameter: here a force is known to a tenth.
constexpr float kCoarsestCoordinate = 1e-4f;

/// Distance from |x| to the next larger fp32 number.
inline float coordinate_resolution_m(float x_m) {
    const float magnitude = std::fabs(x_m);
    return std::nextafter(magnitude, INFINITY) - magnitude;
}

inline void want(bool good, const char* what, float value) {
    if (good) return;
    char text[192];
    std::snprintf(text, sizeof text, "%s, not %g", what, value);
    throw course::BadInput(text);
}

/// @throws course::BadInput naming what is wrong with the material
inline void check_material(const Material& material) {
    const auto positive = [](float x) { return x > 0 && std::isfinite(x); };
    const auto not_negative = [](float x) { return x >= 0 && std::isfinite(x); };
    want(positive(material.diameter_m), "the diameter must be above 0", material.diameter_m);
    want(positive(material.mass_kg), "a marble's mass must be above 0", material.mass_kg);
    want(not_negative(material.stiffness_N_per_m), "the stiffness must be 0 or above",
         material.stiffness_N_per_m);
    want(not_negative(material.normal_damping_per_s), "the normal damping must be 0 or above",
         material.normal_damping_per_s);
    want(not_negative(material.tangential_damping_per_s), "the tangential damping must be 0 or above",
         material.tangential_damping_per_s);
    want(not_negative(material.friction), "the friction must be 0 or above", material.friction);
    want(not_negative(material.attraction_N_per_m), "the attraction must be 0 or above",
         material.attraction_N_per_m);
    want(not_negative(material.drag_per_s), "the drag must be 0 or above", material.drag_per_s);
    const glm::vec3 g = material.gravity_m_per_s2;
    want(patterns::is_finite(g), "gravity must be finite", g.x + g.y + g.z);
}

/// @throws course::BadInput if the skin is none that cells could be made for
inline void check_skin(float skin) {
    want(skin >= 0 && skin <= 10, "the list's skin must be from 0 to 10 diameters", skin);
}

/// @throws course::BadInput if the box is too narrow for a marble, or so far from the origin that fp32
/// coordinates in it are too coarse
inline void check_box(const Box& box, float diameter_m) {
    const float low[3] = {box.low_m.x, box.low_m.y, box.low_m.z},
                high[3] = {box.high_m.x, box.high_m.y, box.high_m.z};
    for (int axis = 0; axis < 3; ++axis) {
        char text[256];
        const float width_m = high[axis] - low[axis];
        if (!(width_m >= diameter_m) || !std::isfinite(width_m)) {
            std::snprintf(text, sizeof text,
                          "the box is %g m wide along %c: a marble of %g m does not fit in, or the width is "
                          "no number",
                          width_m, "xyz"[axis], diameter_m);
            throw course::BadInput(text);
        }
        const float farthest_m = std::max(std::fabs(low[axis]), std::fabs(high[axis]));
        const float resolution_m = coordinate_resolution_m(farthest_m);
        if (!(resolution_m <= kCoarsestCoordinate * diameter_m)) {
            std::snprintf(text, sizeof text,
                          "the box reaches %g m from the origin along %c, where fp32 coordinates are %g m "
                          "apart: too coarse for marbles of %g m; put the box nearer to the origin",
                          farthest_m, "xyz"[axis], resolution_m, diameter_m);
            throw course::BadInput(text);
        }
    }
}

/// @throws course::BadInput naming the first marble that is no number or lies outside the box
inline void check_particles(const std::vector<float4>& position, const std::vector<float4>& velocity,
                            const Box& box) {
    if (position.size() != velocity.size())
        throw course::BadInput(std::to_string(position.size()) + " positions and " +
                               std::to_string(velocity.size()) + " velocities: each marble needs both");
    for (std::size_t i = 0; i < position.size(); ++i) {
        const float4 x = position[i], v = velocity[i];
        // Written so that NaN, for which every comparison is false, lies outside.
        const bool inside = x.x >= box.low_m.x && x.x <= box.high_m.x && x.y >= box.low_m.y &&
                            x.y <= box.high_m.y && x.z >= box.low_m.z && x.z <= box.high_m.z;
        if (inside && patterns::is_finite(patterns::xyz(v))) continue;
        char text[256];
        std::snprintf(text, sizeof text, "marble %zu starts at (%g, %g, %g) m with (%g, %g, %g) m/s: %s", i,
                      x.x, x.y, x.z, v.x, v.y, v.z,
                      inside ? "that is no velocity" : "that is not inside the box");
        throw course::BadInput(text);
    }
}

}  // namespace spring_mass
