/// @file
/// Looking at the state from outside: energy, extremes, and whether the numbers still mean anything.
#pragma once
#include <cuda_runtime.h>

#include <cstdio>
#include <string>
#include <vector>

#include "04_parallel_patterns/reduce.cuh"
#include "09_water_spring_mass/by_number.cuh"
#include "10_water_sph/water.cuh"
#include "common/errors.h"

namespace sph {

/// Sums and extremes over all particles, or over some of them.
struct Summary {
    double kinetic_J;       ///< of motion
    double potential_J;     ///< in gravity, zero at the box's floor
    double front_m;         ///< largest x
    double density_sum;     ///< of all particles, kg/m^3
    float highest_density;  ///< kg/m^3
    std::uint32_t densest;  ///< place of that particle
    float highest_speed;    ///< m/s; infinite if any particle is not finite
    std::uint32_t fastest;  ///< place of that particle
};

//! [Summing]
/// Two summaries as one, for chapter 04's tree. Sums are in double, and a tree adds in the same order each
/// time: an atomicAdd of floats would give another last digit in each run.
struct Summing {
    using Value = Summary;
    static __host__ __device__ Summary nothing() { return {0, 0, -1e30, 0, 0, 0, 0, 0}; }
    static __host__ __device__ Summary combine(Summary a, const Summary& b) {
        a.kinetic_J += b.kinetic_J;
        a.potential_J += b.potential_J;
        a.density_sum += b.density_sum;
        a.front_m = fmax(a.front_m, b.front_m);
        if (b.highest_density > a.highest_density) {
            a.highest_density = b.highest_density;
            a.densest = b.densest;
        }
        if (b.highest_speed > a.highest_speed) {
            a.highest_speed = b.highest_speed;
            a.fastest = b.fastest;
        }
        return a;
    }
};

/// The particles as an array of summaries of one particle each, none of which is ever stored.
struct SummariesOfOne {
    const float4 *position, *velocity;
    const float* density;
    float mass_kg, gravity_m_per_s2, floor_m;

    __device__ Summary operator[](std::uint32_t i) const {
        const glm::vec3 x = grid::xyz(position[i]), v = grid::xyz(velocity[i]);
        const float speed_squared = v.x * v.x + v.y * v.y + v.z * v.z;
        const bool finite = grid::is_finite(x) && grid::is_finite(v) && speed_squared < 1e30f;
        return {0.5 * mass_kg * speed_squared,
                -double(mass_kg) * gravity_m_per_s2 * (x.y - floor_m),
                double(x.x),
                double(density[i]),
                density[i],
                i,
                finite ? sqrtf(speed_squared) : INFINITY,
                i};
    }
};
//! [Summing]

using spring_mass::by_id;

/// Makes summaries, again and again, in memory made once.
class Summarizer {
  public:
    explicit Summarizer(std::uint32_t max_particles) : reduce_(max_particles) {}

    template <class AnyWater>
    Summary operator()(const AnyWater& water) {
        const Fluid& fluid = water.fluid();
        reduce_(SummariesOfOne{water.position(), water.velocity(), water.densities().data(), fluid.mass_kg,
                               fluid.gravity_m_per_s2.y, water.box().low_m.y},
                water.size());
        return reduce_.download();
    }

  private:
    patterns::TreeReduction<Summing> reduce_;
};

//! [is_water]
/// Water of this model is nearly incompressible, and that only while it is much slower than sound. With a
/// particle as fast as sound, or pressed to twice the rest density (a settled tank is within 3 % of it, the
/// hardest splash within 40 %), or one that is not a number, the run has left the model.
inline bool is_water(const Fluid& fluid, const Summary& summary) {
    return summary.highest_speed < fluid.sound_speed_m_per_s &&
           summary.highest_density < 2 * fluid.rest_density_kg_per_m3;
}
//! [is_water]

/// Which limit the time step breaks, as a sentence; empty if it breaks none.
inline std::string broken_limit(const Fluid& fluid, float dt_s) {
    const TimeStepLimit limit = time_step_limit(fluid);
    if (!(dt_s > limit.smallest_s())) return "";
    const char* reason = dt_s > limit.sound_s       ? "0.4 h / c, set by the sound speed"
                         : dt_s > limit.viscosity_s ? "0.0625 h^2 / nu, set by the viscosity"
                                                    : "0.25 sqrt(h / g), set by gravity";
    char text[128];
    std::snprintf(text, sizeof text, "dt %g s is over the limit %g s (%s)", dt_s, limit.smallest_s(), reason);
    return text;
}

//! [check_state]
/// @throws course::Unstable naming the step, the particle, its values, and the limit that dt broke, if it
/// broke one.
inline void check_state(const Water& water, const Summary& summary, int step, float dt_s) {
    const Fluid& fluid = water.fluid();
    if (is_water(fluid, summary)) return;
    const bool slow = summary.highest_speed < fluid.sound_speed_m_per_s;
    const std::uint32_t place = slow ? summary.densest : summary.fastest;
    const float4 x = water.positions().download()[place], v = water.velocities().download()[place];
    char who[128], what[256];
    std::snprintf(who, sizeof who, "step %d: particle %u at (%g, %g, %g) m ", step,
                  water.ids().download()[place], x.x, x.y, x.z);
    if (slow)
        std::snprintf(what, sizeof what, "is pressed to %g times the rest density; ",
                      summary.highest_density / fluid.rest_density_kg_per_m3);
    else
        std::snprintf(what, sizeof what,
                      "moves at (%g, %g, %g) m/s, faster than sound in this water (%g m/s); ", v.x, v.y, v.z,
                      fluid.sound_speed_m_per_s);
    std::string why = broken_limit(fluid, dt_s);
    if (why.empty()) {
        const char* suspect =
            !(fluid.viscosity_m2_per_s > 0)
                ? "no viscosity: nothing takes the energy of collisions (--viscosity 1 is the scene's)"
            : water.state() == EquationOfState::tait
                ? "Tait's equation: pressed water is stiffer than the limit knows (try half of dt)"
                : "particles that start too close together, or a scene faster than its sound";
        char text[256];
        std::snprintf(text, sizeof text, "dt %g s is within the limit %g s, so the likely cause is %s", dt_s,
                      time_step_limit(fluid).smallest_s(), suspect);
        why = text;
    }
    throw course::Unstable(who + std::string(what) + why);
}
//! [check_state]

}  // namespace sph
