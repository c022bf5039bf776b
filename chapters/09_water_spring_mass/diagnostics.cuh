/// @file
/// Looking at the state from outside: energy, contacts, extremes, and whether the numbers still mean
/// anything.
#pragma once
#include <cuda_runtime.h>

#include <cstdio>
#include <string>
#include <vector>

#include "09_water_spring_mass/limits.h"
#include "09_water_spring_mass/marbles.cuh"
#include "common/errors.h"

namespace spring_mass {

/// Sums and extremes over all marbles, or over one chunk of them.
struct Summary {
    double kinetic_J = 0;    ///< of motion
    double potential_J = 0;  ///< in gravity, zero in the box's lower corner
    double elastic_J = 0;    ///< in pressed and pulled contacts
    double front_m = -1e30;  ///< largest x
    double contacts = 0;     ///< of marbles with marbles, both ends counted: per marble divide by n
    float deepest_m = 0;     ///< largest overlap of two marbles
    std::uint32_t most_contacts = 0;
    float highest_speed = 0;    ///< infinite if any marble is not finite
    std::uint32_t fastest = 0;  ///< place of that marble

    double energy_J() const { return kinetic_J + potential_J + elastic_J; }
};

constexpr std::uint32_t kSummaryChunk = 256;

//! [summary_kernel]
/// One thread per chunk of 256 marbles. Sums in double and in a fixed order: an atomicAdd of floats would
/// give another last digit in each run.
inline __global__ void summary_kernel(Summary* chunks, const float4* position, const float4* velocity,
                                      NeighbourList list, Material material, Box box, std::uint32_t n) {
    const std::uint32_t chunk = blockIdx.x * blockDim.x + threadIdx.x;
    const std::uint32_t first = chunk * kSummaryChunk;
    if (first >= n) return;
    const float d = material.diameter_m, radius = 0.5f * d, k = material.stiffness_N_per_m;
    const glm::vec3 low = as_vec3(box.low_m), high = as_vec3(box.high_m), g = material.gravity_m_per_s2;
    Summary sum;
    for (std::uint32_t i = first; i < min(n, first + kSummaryChunk); ++i) {
        const glm::vec3 x = grid::xyz(position[i]), v = grid::xyz(velocity[i]);
        const float speed_squared = glm::dot(v, v);
        const bool finite = grid::is_finite(x) && grid::is_finite(v) && speed_squared < 1e30f;
        const float speed = finite ? sqrtf(speed_squared) : INFINITY;
        if (speed > sum.highest_speed) {
            sum.highest_speed = speed;
            sum.fastest = i;
        }
        sum.kinetic_J += 0.5 * material.mass_kg * speed_squared;
        sum.potential_J -= double(material.mass_kg) * glm::dot(g, x - low);
        sum.front_m = fmax(sum.front_m, double(x.x));
        for (int axis = 0; axis < 3; ++axis)
            for (const float overlap : {radius - (x[axis] - low[axis]), radius - (high[axis] - x[axis])})
                if (overlap > 0) sum.elastic_J += 0.5 * k * overlap * overlap;
        std::uint32_t contacts = 0;
        list.for_each(i, [&](std::uint32_t j) {
            const float distance = glm::length(x - grid::xyz(position[j])), overlap = d - distance;
            if (!(overlap > 0)) return;
            ++contacts;
            sum.deepest_m = fmaxf(sum.deepest_m, overlap);
            // Each pair is met twice: half of its energy each time. Attraction pulls from distance d inwards.
            sum.elastic_J += 0.25 * k * overlap * overlap -
                             0.25 * material.attraction_N_per_m * (d * d - distance * distance);
        });
        sum.contacts += contacts;
        sum.most_contacts = max(sum.most_contacts, contacts);
    }
    chunks[chunk] = sum;
}
//! [summary_kernel]

/// Values by particle number, whatever order the marbles are kept in.
template <class T>
std::vector<T> by_id(const Marbles& marbles, const course::DeviceBuffer<T>& buffer) {
    const std::vector<T> values = buffer.download();
    const std::vector<std::uint32_t> ids = marbles.ids().download();
    std::vector<T> sorted(values.size());
    for (std::size_t k = 0; k < ids.size(); ++k) sorted[ids[k]] = values[k];
    return sorted;
}

/// Makes summaries, again and again, in memory made once.
class Summarizer {
  public:
    explicit Summarizer(std::uint32_t max_particles)
        : chunks_(grid::blocks_for(max_particles, kSummaryChunk)) {}

    Summary operator()(const Marbles& marbles) {
        const std::uint32_t count = grid::blocks_for(marbles.size(), kSummaryChunk);
        Summary total;
        if (count == 0) return total;
        summary_kernel<<<grid::blocks_for(count, 8), 8>>>(chunks_.data(), marbles.position(),
                                                          marbles.velocity(), marbles.list(),
                                                          marbles.material(), marbles.box(), marbles.size());
        CUDA_CHECK(cudaGetLastError());
        for (const Summary& chunk : chunks_.download()) {
            if (chunk.highest_speed > total.highest_speed) {
                total.highest_speed = chunk.highest_speed;
                total.fastest = chunk.fastest;
            }
            total.kinetic_J += chunk.kinetic_J;
            total.potential_J += chunk.potential_J;
            total.elastic_J += chunk.elastic_J;
            total.contacts += chunk.contacts;
            total.front_m = std::fmax(total.front_m, chunk.front_m);
            total.deepest_m = std::fmax(total.deepest_m, chunk.deepest_m);
            total.most_contacts = std::max(total.most_contacts, chunk.most_contacts);
        }
        return total;
    }

  private:
    course::DeviceBuffer<Summary> chunks_;
};

//! [check_state]
/// Nothing in this model makes energy: springs give back what they took, dashpots, friction and drag only
/// take. So the energy at the start is a bound for ever. Leapfrog moves around the true energy by up to
/// (omega dt)^2 / 4 of what is in the contacts: within the limit of the step at most all of it.
/// @param start_J  energy of the first state
/// @throws course::Unstable naming the step, the marble, its values, and whether dt is over the limit
inline void check_state(const Marbles& marbles, const Summary& now, double start_J, int step, float dt_s) {
    const Material& material = marbles.material();
    const double quantum_J =  // so that a single marble at rest on the floor may tremble
        1e-6 * marbles.size() * material.mass_kg * 9.81 * material.diameter_m;
    const double most_J = start_J + 0.02 * std::fabs(start_J) + now.elastic_J + quantum_J;
    if (std::isfinite(now.highest_speed) && now.energy_J() <= most_J) return;
    const float4 x = marbles.positions().download()[now.fastest],
                 v = marbles.velocities().download()[now.fastest];
    const float limit_s = time_step_limit_s(material);
    char text[512];
    std::snprintf(
        text, sizeof text,
        "step %d: energy %g J, more than the %g J of the start, which nothing here can do; marble %u "
        "at (%g, %g, %g) m moves at (%g, %g, %g) m/s; dt %g s is %s the limit %g s of this stiffness "
        "in a dense packing%s",
        step, now.energy_J(), start_J, marbles.ids().download()[now.fastest], x.x, x.y, x.z, v.x, v.y, v.z,
        dt_s, dt_s > limit_s ? "over" : "within", limit_s,
        dt_s > limit_s ? ""
                       : ": likely causes are marbles pressed far into each other, or faster "
                         "than a tenth of a diameter per step");
    throw course::Unstable(text);
}
//! [check_state]

}  // namespace spring_mass
