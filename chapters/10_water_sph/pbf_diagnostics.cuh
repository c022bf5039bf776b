/// @file
/// Whether water of position based fluids still means anything.
#pragma once
#include <cstdio>
#include <string>

#include "10_water_sph/diagnostics.cuh"
#include "10_water_sph/pbf_water.cuh"

namespace sph {

/// Water without sound has no speed that it must stay below, but a particle that crosses its own support in a
/// step has flown through others unseen. Twice the rest density is as much the end as with sound.
inline bool is_water(const Fluid& fluid, const Summary& summary, float dt_s) {
    return summary.highest_speed * dt_s < fluid.support_m &&
           summary.highest_density < 2 * fluid.rest_density_kg_per_m3;
}

/// @throws course::Unstable naming the step, the particle, its values, and the step that it would have needed
inline void check_state(const PbfWater& water, const Summary& summary, int step, float dt_s) {
    const Fluid& fluid = water.fluid();
    if (is_water(fluid, summary, dt_s)) return;
    const bool slow = summary.highest_speed * dt_s < fluid.support_m;
    const std::uint32_t place = slow ? summary.densest : summary.fastest;
    const float4 x = water.positions().download()[place], v = water.velocities().download()[place];
    char text[512];
    const int length = std::snprintf(text, sizeof text, "step %d: particle %u at (%g, %g, %g) m ", step,
                                     water.ids().download()[place], x.x, x.y, x.z);
    if (slow)
        std::snprintf(text + length, sizeof text - length,
                      "is pressed to %g times the rest density after %d corrections; more corrections or a "
                      "smaller step may help, unless particles lie at one point",
                      summary.highest_density / fluid.rest_density_kg_per_m3, water.report().corrections);
    else
        std::snprintf(text + length, sizeof text - length,
                      "moves at (%g, %g, %g) m/s, more than the support radius of %g m in a step of %g s; at "
                      "that speed a step of %g s would do",
                      v.x, v.y, v.z, fluid.support_m, dt_s,
                      pbf_step_limit_s(fluid, water.choice().tolerance, summary.highest_speed));
    throw course::Unstable(text);
}

}  // namespace sph
