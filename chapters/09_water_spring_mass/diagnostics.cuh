/// @file
/// Looking at the state from outside: energy, contacts, extremes, and whether the numbers still mean
/// anything.
#pragma once
#include <cuda_runtime.h>

#include <cstdio>
#include <string>
#include <vector>

#include "04_parallel_patterns/reduce.cuh"
#include "09_water_spring_mass/limits.h"
#include "09_water_spring_mass/marbles.cuh"
#include "common/errors.h"

namespace spring_mass {

/// Sums and extremes over all marbles, or over some of them.
struct Summary {
    double kinetic_J;    ///< of motion
    double potential_J;  ///< in gravity, zero in the box's lower corner
    double elastic_J;    ///< in pressed and pulled contacts
    double front_m;      ///< largest x
    double contacts;     ///< of marbles with marbles, both ends counted: per marble divide by n
    float deepest_m;     ///< largest overlap of two marbles
    std::uint32_t most_contacts;
    float highest_speed;    ///< m/s; infinite if any marble is not finite
    std::uint32_t fastest;  ///< place of that marble

    double energy_J() const { return kinetic_J + potential_J + elastic_J; }
};

//! [Summing]
/// Two summaries as one, for chapter 04's tree.
struct Summing {
    using Value = Summary;
    static __host__ __device__ Summary nothing() { return {0, 0, 0, -1e30, 0, 0, 0, 0, 0}; }
    static __host__ __device__ Summary combine(Summary a, const Summary& b) {
        a.kinetic_J += b.kinetic_J;
        a.potential_J += b.potential_J;
        a.elastic_J += b.elastic_J;
        a.front_m = fmax(a.front_m, b.front_m);
        a.contacts += b.contacts;
        a.deepest_m = fmaxf(a.deepest_m, b.deepest_m);
        if (b.most_contacts > a.most_contacts) a.most_contacts = b.most_contacts;
        if (b.highest_speed > a.highest_speed) {
            a.highest_speed = b.highest_speed;
            a.fastest = b.fastest;
        }
        return a;
    }
};

/// The marbles as an array of summaries of one marble each, none of which is ever stored.
struct SummariesOfOne {
    const float4 *position, *velocity;
    NeighbourList list;
    Material material;
    Box box;

    __device__ Summary operator[](std::uint32_t i) const {
        const float d = material.diameter_m, k = material.stiffness_N_per_m;
        const glm::vec3 low = as_vec3(box.low_m), high = as_vec3(box.high_m);
        const glm::vec3 x = grid::xyz(position[i]), v = grid::xyz(velocity[i]);
        const float speed_squared = glm::dot(v, v);
        const bool finite = grid::is_finite(x) && grid::is_finite(v) && speed_squared < 1e30f;
        Summary one = Summing::nothing();
        one.kinetic_J = 0.5 * material.mass_kg * speed_squared;
        one.potential_J = -double(material.mass_kg) * glm::dot(material.gravity_m_per_s2, x - low);
        one.front_m = x.x;
        one.highest_speed = finite ? sqrtf(speed_squared) : INFINITY;
        one.fastest = i;
        for (int axis = 0; axis < 3; ++axis)
            for (const float overlap : {0.5f * d - (x[axis] - low[axis]), 0.5f * d - (high[axis] - x[axis])})
                if (overlap > 0) one.elastic_J += 0.5 * k * overlap * overlap;
        const auto touches = [&](std::uint32_t j) {
            const glm::vec3 apart = x - grid::xyz(position[j]);
            return glm::dot(apart, apart) < d * d;
        };
        list.for_each_near(i, touches, [&](std::uint32_t j) {
            const float distance = glm::length(x - grid::xyz(position[j])), overlap = d - distance;
            ++one.most_contacts;
            one.deepest_m = fmaxf(one.deepest_m, overlap);
            // Each pair is met twice: half of its energy each time. Attraction pulls from distance d inwards.
            one.elastic_J += 0.25 * k * overlap * overlap -
                             0.25 * material.attraction_N_per_m * (d * d - distance * distance);
        });
        one.contacts = one.most_contacts;
        return one;
    }
};
//! [Summing]

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
    explicit Summarizer(std::uint32_t max_particles) : reduce_(max_particles) {}

    Summary operator()(const Marbles& marbles) {
        reduce_(SummariesOfOne{marbles.position(), marbles.velocity(), marbles.list(), marbles.material(),
                               marbles.box()},
                marbles.size());
        return reduce_.download();
    }

  private:
    patterns::TreeReduction<Summing> reduce_;
};

/// What went wrong with this marble, and whether the step is to blame.
[[noreturn]] inline void stop(const Marbles& marbles, std::uint32_t place, int step, float dt_s,
                              const std::string& what) {
    const float limit_s = time_step_limit_s(marbles.material());
    const float4 x = marbles.positions().download()[place], v = marbles.velocities().download()[place];
    char who[192], why[128];
    std::snprintf(who, sizeof who, "step %d: marble %u at (%g, %g, %g) m moves at (%g, %g, %g) m/s; ", step,
                  marbles.ids().download()[place], x.x, x.y, x.z, v.x, v.y, v.z);
    std::snprintf(why, sizeof why, "; dt %g s is %s the limit %g s of this stiffness in a dense packing",
                  dt_s, dt_s > limit_s ? "over" : "within", limit_s);
    throw course::Unstable(who + what + why);
}

//! [check_state]
/// Nothing in this model makes energy: springs give back what they took, dashpots, friction and drag only
/// take. So the energy at the start is a bound for ever. Leapfrog moves around the true energy by up to
/// (omega dt)^2 / 4 of what is in the contacts: within the limit of the step at most all of it.
///
/// And a marble that moves by half a diameter in one step can pass another without a contact.
/// @param start_J  energy of the first state
/// @throws course::Unstable naming the step, the marble, its values, and whether dt is over the limit
inline void check_state(const Marbles& marbles, const Summary& now, double start_J, int step, float dt_s) {
    const Material& material = marbles.material();
    const double tremble_J =  // so that a single marble at rest on the floor may have rounding errors
        1e-6 * marbles.size() * material.mass_kg * 9.81 * material.diameter_m;
    const double most_J = start_J + 0.02 * std::fabs(start_J) + now.elastic_J + tremble_J;
    char what[160];
    if (!(now.highest_speed * dt_s <= 0.5f * material.diameter_m)) {
        std::snprintf(what, sizeof what, "that is %g diameters per step: it can pass others unseen",
                      now.highest_speed * dt_s / material.diameter_m);
        stop(marbles, now.fastest, step, dt_s, what);
    }
    if (!(now.energy_J() <= most_J)) {
        std::snprintf(what, sizeof what, "all energy together is %g J, more than the %g J of the start",
                      now.energy_J(), start_J);
        stop(marbles, now.fastest, step, dt_s, what);
    }
}
//! [check_state]

}  // namespace spring_mass
