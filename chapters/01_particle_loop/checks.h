/// @file
/// Does it make sense: before the run, and while it runs?
#pragma once
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

/// @throws course::BadInput, naming the value, if the fountain can't be computed at all
inline void check(const Fountain& f) {
    const auto want = [](bool good, const std::string& what, float value) {
        if (!good) throw course::BadInput(what + ", not " + to_text(value));
    };
    want(f.dt_s >= 1e-6f * f.lifetime_s && f.dt_s <= f.lifetime_s,
         "a droplet lives " + to_text(f.lifetime_s) +
             " s: the time step must be from a millionth of that to all of it",
         f.dt_s);
    want(f.drag_per_s >= 0.0f && f.drag_per_s < 1e6f, "the drag must be from 0 to 1000000 per second",
         f.drag_per_s);
    want(f.restitution >= 0.0f && f.restitution <= 1.0f, "the restitution must be from 0 to 1",
         f.restitution);
    want(f.jet_count >= 1 && f.jet_count <= kMaxJets, "a fountain has 1 to 16 jets", float(f.jet_count));
}

//! [watch]
/// Looks for the first of `count` droplets that left the world or is not a number.
/// @throws course::Unstable naming the step, the droplet, its state and the likely cause
inline void watch(const std::vector<Particle>& particles, std::uint32_t count, const Fountain& f, int step) {
    constexpr float kWorld_m = 1000.0f;  // no droplet of these fountains gets a hundredth as far
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec3 x = particles[i].position_m, v = particles[i].velocity_m_per_s;
        if (glm::dot(x, x) < kWorld_m * kWorld_m) continue;  // false for NaN, too
        std::string what = "step " + std::to_string(step) + ": droplet " + std::to_string(i) + " is at " +
                           to_text(x) + " m with a velocity of " + to_text(v) + " m/s";
        if (f.dt_s * f.drag_per_s > 2.0f)
            what += "; the time step " + to_text(f.dt_s) +
                    " s is over the limit 2 / drag = " + to_text(2.0f / f.drag_per_s) + " s";
        throw course::Unstable(what);
    }
}
//! [watch]

}  // namespace particle_loop
