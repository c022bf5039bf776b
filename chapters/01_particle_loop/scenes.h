/// @file
/// The fountains that chapters 01, 03 and 06 show.
#pragma once
#include <cmath>
#include <string>

#include "01_particle_loop/particle_loop.h"
#include "common/errors.h"

namespace particle_loop {

/// Adds a jet that leaves at `speed` towards `azimuth` (around the vertical) and `tilt` away from it.
inline void add_jet(Fountain& fountain, float speed_m_per_s, float azimuth_rad, float tilt_rad) {
    const float sideways = speed_m_per_s * std::sin(tilt_rad);
    fountain.jet_m_per_s[fountain.jet_count++] = {sideways * std::cos(azimuth_rad),
                                                  speed_m_per_s * std::cos(tilt_rad),
                                                  sideways * std::sin(azimuth_rad)};
}

/// "crown": a tall jet in the middle and a ring of arcs. "spray": one wide jet.
/// @throws course::BadInput for another name
inline Fountain make_scene(const std::string& name) {
    Fountain fountain;
    if (name == "crown") {
        constexpr int kRing = 12;
        fountain.lifetime_s = 1.85f;
        for (int k = 0; k < 3; ++k) add_jet(fountain, 8.1f, 0.0f, 0.0f);  // a fifth of the water
        for (int k = 0; k < kRing; ++k) add_jet(fountain, 6.9f, 6.2831853f * (k + 0.5f) / kRing, 0.36f);
    } else if (name == "spray") {
        fountain.spread_m_per_s = 1.5f;
        fountain.lifetime_s = 1.75f;
        add_jet(fountain, 7.0f, 0.0f, 0.0f);
    } else {
        throw course::BadInput("there is no fountain '" + name + "'");
    }
    return fountain;
}

}  // namespace particle_loop
