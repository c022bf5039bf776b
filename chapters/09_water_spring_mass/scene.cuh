/// @file
/// The scenes of this chapter: a tank, a block of marbles in it, and what the marbles are made of.
#pragma once
#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "09_water_spring_mass/limits.h"
#include "common/errors.h"

namespace spring_mass {

/// How marbles meet, apart from their size: numbers that stay the same however many there are.
struct Touch {
    float restitution = 0.5f;  ///< of two marbles that meet head on; 1: nothing is lost, and no dashpot
    float friction = 0;        ///< mu; 0: they slide freely, and there is no shear term
    float attraction = 0;      ///< pull of touching marbles, as a fraction of the stiffness
    float drag_per_s = 0;      ///< of the fluid around them
    float stiffness = 1;       ///< factor on the scene's
};

/// Everything that a run of this chapter depends on. Lengths in metres.
struct Scene {
    std::string name;
    Box tank;
    float3 block_low_m, block_size_m;  ///< the marbles at the start
    Touch touch;
};

//! [scenes]
inline std::vector<Scene> all_scenes() {
    const Box long_tank{{0, 0, 0}, {0.9f, 0.8f, 0.4f}}, square_tank{{0, 0, 0}, {0.8f, 0.8f, 0.8f}};
    const float3 cube{0.4f, 0.4f, 0.4f}, in_the_middle{0.2f, 0.25f, 0.2f};
    Touch glass, smooth, sticky, syrup;
    glass.friction = 0.3f;
    sticky.attraction = 0.02f;
    sticky.friction = 0.3f;
    syrup.drag_per_s = 8;
    return {
        // A cube of glass marbles in mid-air: it falls, bursts and comes to rest as a heap.
        {"drop", square_tank, in_the_middle, cube, glass},
        // A cube along the left wall, held by a gate that is gone at t = 0. Without friction it runs like
        // water.
        {"dam_break", long_tank, {0, 0, 0}, cube, smooth},
        // Marbles that hold on to each other: lumps.
        {"sticky", square_tank, in_the_middle, cube, sticky},
        // Smooth marbles in a fluid that slows them.
        {"syrup", square_tank, in_the_middle, cube, syrup},
    };
}
//! [scenes]

inline const Scene& find_scene(const std::vector<Scene>& scenes, const std::string& name) {
    for (const Scene& scene : scenes)
        if (scene.name == name) return scene;
    throw course::BadInput("there is no scene '" + name + "'");
}

//! [fill_block]
/// Exactly `particles` points on a cubic lattice, layer by layer from the floor of the block. Each is moved
/// by up to `jitter` spacings along each axis: a perfect lattice would collapse in perfect rows.
/// @param spacing_m  out: the lattice's spacing, from which size and mass of a particle follow
inline std::vector<float4> fill_block(float3 low_m, float3 size_m, std::uint32_t particles,
                                      std::uint64_t seed, float jitter, float& spacing_m) {
    const double volume = double(size_m.x) * size_m.y * size_m.z;
    std::uint32_t nx = std::max(1, int(std::lround(size_m.x / std::cbrt(volume / particles)))), nz;
    for (;; ++nx) {  // few particles can round to a tower far above the block: then take finer columns
        spacing_m = size_m.x / nx;
        nz = std::max(1, int(std::lround(size_m.z / spacing_m)));
        const std::uint32_t layers = (particles + nx * nz - 1) / (nx * nz);
        if (layers * spacing_m < 1.1f * size_m.y) break;
    }
    std::vector<float4> position;
    position.reserve(particles);
    for (std::uint32_t i = 0; i < particles; ++i) {
        const auto random =
            r123::Philox4x32()({{i, 0, 0, 0}}, {{std::uint32_t(seed), std::uint32_t(seed >> 32)}});
        const auto place = [&](float low, std::uint32_t index, std::uint32_t bits) {
            return low + (index + 0.5f + jitter * (bits * 0x1p-31f - 1.0f)) * spacing_m;
        };
        position.push_back(make_float4(place(low_m.x, i % nx, random[0]),
                                       place(low_m.y, i / (nx * nz), random[1]),
                                       place(low_m.z, i / nx % nz, random[2]), 0.0f));
    }
    return position;
}
//! [fill_block]

// Marbles start a twentieth of the spacing apart, and are moved so little that none touches another.
constexpr float kDiameterInSpacings = 0.95f, kJitter = 0.024f;

//! [make_material]
/// Marbles of glass for that scene. The stiffness is not that of glass, which would need ten thousand times
/// as many steps: a marble that hits another with the speed of a fall from the top of the block is pressed in
/// by a tenth of its diameter.
inline Material make_material(const Scene& scene, float spacing_m) {
    constexpr double kGlass_kg_per_m3 = 2500;
    const double d = kDiameterInSpacings * spacing_m;
    const double top_m = scene.block_low_m.y + scene.block_size_m.y - scene.tank.low_m.y;
    const Touch& touch = scene.touch;
    Material material;
    material.diameter_m = float(d);
    material.mass_kg = float(kGlass_kg_per_m3 * 3.14159265358979 / 6 * d * d * d);
    // m_eff v^2 = k overlap^2, with v^2 = 2 g top
    material.stiffness_N_per_m =
        float(touch.stiffness * 0.5 * material.mass_kg * 2 * 9.81 * top_m / (0.1 * d * 0.1 * d));
    material.normal_damping_per_s =
        damping_for_restitution(touch.restitution, material.stiffness_N_per_m, material.mass_kg);
    material.friction = touch.friction;
    // Half of it for sliding, as LAMMPS does when nothing else is said. All but the slowest sliding is up to
    // friction.
    if (touch.friction > 0) material.tangential_damping_per_s = 0.5f * material.normal_damping_per_s;
    material.attraction_N_per_m = touch.attraction * material.stiffness_N_per_m;
    material.drag_per_s = touch.drag_per_s;
    return material;
}
//! [make_material]

}  // namespace spring_mass
