/// @file
/// Looking at the state from outside: energy, extremes, and whether the numbers still mean anything.
#pragma once
#include <cuda_runtime.h>

#include <cstdio>
#include <string>
#include <vector>

#include "10_water_sph/water.cuh"
#include "common/errors.h"

namespace sph {

/// Sums and extremes over all particles, or over one chunk of them.
struct Summary {
    double kinetic_J = 0;    ///< of motion
    double potential_J = 0;  ///< in gravity, zero at the box's floor
    double front_m = -1e30;  ///< largest x
    double density_sum = 0;  ///< of all particles, kg/m^3
    float highest_density = 0;
    float highest_speed = 0;    ///< infinite if any particle is not finite
    std::uint32_t fastest = 0;  ///< place of that particle
};

constexpr std::uint32_t kSummaryChunk = 256;

//! [summary_kernel]
/// One thread per chunk of 256 particles. Sums in double and in a fixed order: an atomicAdd of floats would
/// give another last digit in each run.
inline __global__ void summary_kernel(Summary* chunks, const float4* position, const float4* velocity,
                                      const float* density, Fluid fluid, float floor_m, std::uint32_t n) {
    const std::uint32_t chunk = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t first = chunk * kSummaryChunk;
    if (first >= n) return;
    Summary sum;
    for (std::uint32_t i = first; i < min(n, first + kSummaryChunk); ++i) {
        const glm::vec3 x = grid::xyz(position[i]), v = grid::xyz(velocity[i]);
        const float speed_squared = v.x * v.x + v.y * v.y + v.z * v.z;
        const bool finite = grid::is_finite(x) && grid::is_finite(v) && speed_squared < 1e30f;
        const float speed = finite ? sqrtf(speed_squared) : INFINITY;
        if (speed > sum.highest_speed) {
            sum.highest_speed = speed;
            sum.fastest = i;
        }
        sum.highest_density = fmaxf(sum.highest_density, density[i]);
        sum.density_sum += density[i];
        sum.kinetic_J += 0.5 * fluid.mass_kg * speed_squared;
        sum.potential_J -= double(fluid.mass_kg) * fluid.gravity_m_per_s2.y * (x.y - floor_m);
        sum.front_m = fmax(sum.front_m, double(x.x));
    }
    chunks[chunk] = sum;
}
//! [summary_kernel]

/// Makes summaries, again and again, in memory made once.
class Summarizer {
  public:
    explicit Summarizer(std::uint32_t max_particles)
        : chunks_(grid::blocks_for(max_particles, kSummaryChunk)) {}

    Summary operator()(const Water& water) {
        const std::uint32_t count = grid::blocks_for(water.size(), kSummaryChunk);
        Summary total;
        if (count == 0) return total;
        summary_kernel<<<grid::blocks_for(count, 64), 64>>>(chunks_.data(), water.position(),
                                                            water.velocity(), water.densities().data(),
                                                            water.fluid(), water.box().low_m.y, water.size());
        CUDA_CHECK(cudaGetLastError());
        for (const Summary& chunk : chunks_.download()) {
            if (chunk.highest_speed > total.highest_speed) {
                total.highest_speed = chunk.highest_speed;
                total.fastest = chunk.fastest;
            }
            total.highest_density = std::fmax(total.highest_density, chunk.highest_density);
            total.density_sum += chunk.density_sum;
            total.kinetic_J += chunk.kinetic_J;
            total.potential_J += chunk.potential_J;
            total.front_m = std::fmax(total.front_m, chunk.front_m);
        }
        return total;
    }

  private:
    course::DeviceBuffer<Summary> chunks_;
};

//! [check_state]
/// Water of this model is nearly incompressible only while it is much slower than sound. A particle as fast
/// as sound, or one that is not a number, means that the run has left the model.
/// @throws course::Unstable naming the step, the particle, its values, and the limit that dt broke, if it
/// broke one.
inline void check_state(const Water& water, const Summary& summary, int step, float dt_s) {
    const Fluid& fluid = water.fluid();
    if (summary.highest_speed < fluid.sound_speed_m_per_s) return;
    const float4 x = water.positions().download()[summary.fastest],
                 v = water.velocities().download()[summary.fastest];
    const std::uint32_t id = water.ids().download()[summary.fastest];
    const TimeStepLimit limit = time_step_limit(fluid);
    char text[512];
    std::snprintf(
        text, sizeof text,
        "step %d: particle %u at (%g, %g, %g) m moves at (%g, %g, %g) m/s, faster than sound in this water "
        "(%g m/s); ",
        step, id, x.x, x.y, x.z, v.x, v.y, v.z, fluid.sound_speed_m_per_s);
    std::string message = text;
    if (dt_s > limit.smallest_s()) {
        const char* reason = dt_s > limit.sound_s       ? "0.4 h / c, set by the sound speed"
                             : dt_s > limit.viscosity_s ? "0.0625 h^2 / nu, set by the viscosity"
                                                        : "0.25 sqrt(h / g), set by gravity";
        std::snprintf(text, sizeof text, "dt %g s is over the limit %g s (%s)", dt_s, limit.smallest_s(),
                      reason);
    } else {
        const char* suspect =
            fluid.viscosity_m2_per_s > 0
                ? "particles that start too close together, or a scene faster than its sound"
                : "no viscosity: nothing takes the energy of collisions (--viscosity 1 is the scene's)";
        std::snprintf(text, sizeof text, "dt %g s is within the limit %g s, so the likely cause is %s", dt_s,
                      limit.smallest_s(), suspect);
    }
    throw course::Unstable(message + text);
}
//! [check_state]

}  // namespace sph
