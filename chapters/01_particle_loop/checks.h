/// @file
/// Does it make sense: before the run, and while it runs?
#pragma once
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "01_particle_loop/particle_loop.h"
#include "common/errors.h"

namespace particle_loop {

inline std::string to_text(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}
inline std::string to_text(glm::vec3 v) {
    return "(" + to_text(v.x) + ", " + to_text(v.y) + ", " + to_text(v.z) + ")";
}

constexpr float kWorld_m = 1000.0f;  // a droplet of these fountains gets no further than a hundredth of it

/// @throws course::BadInput, naming the value, if the fountain can't be computed at all
inline void check(const Fountain& f) {
    const auto want = [](bool good, const std::string& what, float value) {
        if (!good) throw course::BadInput(what + ", not " + to_text(value));
    };
    want(f.lifetime_s > 0.0f && std::isfinite(f.lifetime_s), "a droplet must live for some seconds",
         f.lifetime_s);
    want(f.dt_s >= 1e-6f * f.lifetime_s && f.dt_s <= f.lifetime_s,
         "a droplet lives " + to_text(f.lifetime_s) +
             " s: the time step must be from a millionth of that to all of it",
         f.dt_s);
    want(f.drag_per_s >= 0.0f && f.drag_per_s < 1e6f, "the drag must be from 0 to 1000000 per second",
         f.drag_per_s);
    want(f.restitution >= 0.0f && f.restitution <= 1.0f, "the restitution must be from 0 to 1",
         f.restitution);
    want(f.floor_grip >= 0.0f && f.floor_grip <= 1.0f, "the grip of the floor must be from 0 to 1",
         f.floor_grip);
    want(std::isfinite(f.gravity_m_per_s2), "gravity must be a number", f.gravity_m_per_s2);
    want(std::isfinite(f.spread_m_per_s), "the spread of the jets must be a number", f.spread_m_per_s);
    // At 10 km two neighbouring floats are 1 mm apart: what is slower than that per step never moves.
    const float nozzle_m = glm::length(f.nozzle_m);
    want(nozzle_m < kWorld_m, "the nozzle must be less than 1000 m from the origin", nozzle_m);
    want(f.jet_count >= 1 && f.jet_count <= kMaxJets, "a fountain has 1 to 16 jets", float(f.jet_count));
    for (int jet = 0; jet < f.jet_count; ++jet) {
        const float speed_m_per_s = glm::length(f.jet_m_per_s[jet]);
        want(std::isfinite(speed_m_per_s), "the speed of a jet must be a number", speed_m_per_s);
    }
}

/// What most probably drove a droplet out of the world.
inline std::string likely_cause(const Fountain& f, const Particle& droplet) {
    if (f.dt_s * f.drag_per_s > 2.0f)
        return "the time step " + to_text(f.dt_s) +
               " s is over the limit 2 / drag = " + to_text(2.0f / f.drag_per_s) + " s";
    if (f.restitution > 1.0f)
        return "a restitution of " + to_text(f.restitution) + " adds energy in each bounce";
    if (f.dt_s > f.lifetime_s)
        return "the time step " + to_text(f.dt_s) + " s is longer than a life of " + to_text(f.lifetime_s) +
               " s";
    if (!std::isfinite(glm::length(droplet.position_m)) ||
        !std::isfinite(glm::length(droplet.velocity_m_per_s)))
        return "it started with a number that is none, or the fountain has one";
    return "it must have started out there, or that fast: no step of this fountain does it";
}

//! [watch]
/// Looks for the first of `count` droplets that left the world or is not a number.
/// @throws course::Unstable naming the step, the droplet, its state and the likely cause
inline void watch(const std::vector<Particle>& particles, std::uint32_t count, const Fountain& f, int step) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 x = particles[i].position_m, v = particles[i].velocity_m_per_s;
        const bool in_the_world = glm::dot(x, x) < kWorld_m * kWorld_m;
        if (in_the_world && glm::dot(v, v) < INFINITY) continue;  // both are false for NaN, too
        throw course::Unstable("step " + std::to_string(step) + ": droplet " + std::to_string(i) + " is at " +
                               to_text(x) + " m with a velocity of " + to_text(v) + " m/s; " +
                               likely_cause(f, particles[i]));
    }
}
//! [watch]

}  // namespace particle_loop
