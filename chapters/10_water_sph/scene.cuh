/// @file
/// The scenes of this chapter: a tank, a block of water in it, and how stiff and how viscous the water is.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "09_water_spring_mass/scene.cuh"
#include "10_water_sph/sph.cuh"
#include "common/errors.h"

namespace sph {

/// Everything that a run of this chapter depends on. Lengths in metres.
struct Scene {
    std::string name;
    Box tank;
    float3 block_low_m, block_size_m;  ///< the water at the start
};

//! [scenes]
inline std::vector<Scene> all_scenes() {
    return {
        // A cube of water along the left wall, held by a gate that is gone at t = 0.
        {"dam_break", {{0, 0, 0}, {0.9f, 0.8f, 0.4f}}, {0, 0, 0}, {0.4f, 0.4f, 0.4f}},
        // The same cube hanging in the middle of a square tank.
        {"drop", {{0, 0, 0}, {0.8f, 0.8f, 0.8f}}, {0.2f, 0.25f, 0.2f}, {0.4f, 0.4f, 0.4f}},
    };
}
//! [scenes]

inline const Scene& find_scene(const std::vector<Scene>& scenes, const std::string& name) {
    for (const Scene& scene : scenes)
        if (scene.name == name) return scene;
    throw course::BadInput("there is no scene '" + name + "'");
}

constexpr float kJitter = 0.05f;  ///< in spacings: a twentieth

/// Chapter 09's block of particles: exactly so many on a lattice, each moved a little.
/// @param spacing_m  out: the lattice's spacing, from which mass and support radius follow
inline std::vector<float4> fill_block(const Scene& scene, std::uint32_t particles, std::uint64_t seed,
                                      float& spacing_m) {
    return spring_mass::fill_block(scene.block_low_m, scene.block_size_m, particles, seed, kJitter,
                                   spacing_m);
}

/// Numbers that make a fluid of a scene; each has the value the scenes were tuned for.
struct FluidChoice {
    float support_in_spacings = 2;  ///< about 32 neighbours. More are more exact, and cost their cube
    float stiffness = 1;            ///< factor on the sound speed
    float viscosity = 1;            ///< factor on the viscosity; 0: none, and no code for it
};

//! [make_fluid]
/// Water of that spacing for that scene.
///
/// Sound speed: the fastest the water can get is by falling from the top of the block, sqrt(2 g H). Sound has
/// to be several times faster, or the water is squeezed: c = 6 sqrt(g H) keeps the settled tank within 3 % of
/// the rest density. Twice that would keep it within a quarter of the error, for twice as many steps.
///
/// Viscosity: the method's, not that of water (1e-6 m^2/s, which no spacing we can afford could show). It is
/// enough to calm neighbours that rattle against each other, and too little to slow the wave. Without it the
/// collisions' energy stays in that rattling: the water boils (try --viscosity 0).
inline Fluid make_fluid(const Scene& scene, float spacing_m, const FluidChoice& choice = {}) {
    Fluid fluid;
    const float top_m = scene.block_low_m.y + scene.block_size_m.y - scene.tank.low_m.y;
    fluid.support_m = choice.support_in_spacings * spacing_m;
    fluid.mass_kg = float(fluid.rest_density_kg_per_m3 * double(spacing_m) * spacing_m * spacing_m /
                          lattice_density(choice.support_in_spacings));
    fluid.sound_speed_m_per_s = choice.stiffness * 6.0f * std::sqrt(9.81f * top_m);
    fluid.viscosity_m2_per_s = choice.viscosity * 0.015f * fluid.support_m * fluid.sound_speed_m_per_s;
    return fluid;
}
//! [make_fluid]

}  // namespace sph
