/// @file
/// The fires of this chapter: chapter 07's stages, with vortons in place of its noise.
#pragma once
#include <string>
#include <vector>

#include "07_fire_particles/fire_scene.cuh"
#include "08_fire_vortex/vortex_fire.cuh"

namespace vortex {

/// Everything that makes one scene.
struct VortexScene {
    fire::FireScene fire;
    VortexModel model;
    Shading shading{0.0f, 8.0f, 40};  ///< by vorticity
};

//! [stir]
/// Vortons for a fire whose flames come from `emitter`: as much gas as it gives off during a vorton's life,
/// divided among all of them.
/// @param gas_m_per_s  speed with which gas leaves the emitter
/// @param hot_m_per_s2 its buoyancy: g times the density it lacks
inline void stir(VortexModel& m, const fire::Emitter& emitter, std::uint32_t vortons, float gas_m_per_s,
                 float hot_m_per_s2, float life_s) {
    m.vortons = vortons;
    m.birth.emitter = emitter;
    m.birth.life_s = life_s;
    m.birth.life_spread = 0.15f;
    m.hot_m_per_s2 = hot_m_per_s2;
    const float size = emitter.size_m;
    const float area =
        emitter.shape == fire::Emitter::line ? 2 * size * 2 * m.physics.core_m : float(kPi) * size * size;
    m.physics.volume_m3 = area * gas_m_per_s * life_s / float(std::max(1u, vortons));
    m.heat_m4_per_s2 = hot_m_per_s2 * m.physics.volume_m3;
}
//! [stir]

/// As many flames as chapter 07 has here, carried by the air and by nothing else: what lifts them is in the
/// vortons now.
inline fire::ParticleKind carried_by_air(const fire::ParticleKind& flame) {
    fire::ParticleKind carried;
    carried.first = flame.first;
    carried.count = flame.count;
    carried.drag_time_s = 0.02f;
    return carried;
}

//! [campfire]
/// A campfire. Rings of vortices form at its foot, roll up along the flames and carry pieces of them away:
/// the flicker is not drawn, it happens.
inline VortexScene campfire(std::uint32_t particles) {
    VortexScene scene{fire::make_scene("campfire", particles, 1)};
    fire::FireScene& f = scene.fire;
    f.curl = false;
    f.dt_s = 1.0f / 100;
    f.warm_up_steps = 180;
    f.fire.wind = {};
    f.fire.wind.updraft_m_per_s = 0.5f;
    f.fire.wind.updraft_height_m = 0.5f;

    fire::ParticleKind& flame = f.fire.kind[0];
    flame = carried_by_air(flame);
    flame.emitter = {fire::Emitter::disc, {0, 0.07f, 0}, {0, 1, 0}, 0.24f};
    flame.velocity_m_per_s = {0, 0.4f, 0};
    flame.spread_m_per_s = 0.15f;
    flame.life_s = 1.2f, flame.life_spread = 0.3f, flame.decay_spread = 0.1f, flame.edge_life = 0.45f;
    fire::SpriteLook& body = f.looks[0] = {};
    body.temperature_start_K = 1950, body.temperature_end_K = 1320;
    body.radius_start_m = 0.026f, body.radius_end_m = 0.032f;
    body.stretch_s = 0.035f;
    body.wisps = 0.7f;
    body.fade_in = 0.18f, body.fade_out = 0.35f;
    body.light = 1100.0f / float(flame.count);

    fire::ParticleKind& puff = f.fire.kind[1];
    puff.emitter.centre_m.y = 0.40f;
    puff.life_s = 1.3f;
    f.looks[1] = fire::smoke_look(puff.count, 130, 0.05f, 0.15f);

    VortexModel& m = scene.model;
    m.physics.core_m = 0.04f;
    m.physics.cooling_time_s = 0.9f;
    m.physics.decay_time_s = 0.6f;
    m.physics.max_turn_rad_per_s = 25;
    m.birth_turn_rad_per_s = 1.5f;
    m.burn_out_per_s = 2;
    m.cell_m = 0.05f;
    m.mirror_m = 0.2f;
    m.reach_m = 1.7f;
    stir(m, flame.emitter, 4000, 0.45f, 13, 1.3f);
    // The flames burn from a few roots; the air they heat is stirred all over the fire.
    flame.emitter.size_m = 0.18f;
    flame.emitter.roots = 9;
    flame.emitter.root_m = 0.06f;
    f.view = {{0, 0.60f, 0}, 2.6f, 0.2f, 0.10f};
    return scene;
}
//! [campfire]

/// A torch, swung through the air by nobody: it stands still, and has its own eddies.
inline VortexScene torch(std::uint32_t particles) {
    VortexScene scene{fire::make_scene("torch", particles, 1)};
    fire::FireScene& f = scene.fire;
    f.curl = false;
    f.dt_s = 1.0f / 200;
    f.warm_up_steps = 170;
    f.fire.wind = {};
    f.fire.wind.updraft_m_per_s = 0.8f;
    f.fire.wind.updraft_height_m = 0.15f;

    f.stage.rods = {{{0.02f, -0.75f, 0}, {0, -0.07f, 0}, 0.018f, fire::Rod::wood, 0},
                    {{0, -0.10f, 0}, {0, -0.035f, 0}, 0.036f, fire::Rod::wood, 0.8f}};
    f.fire.kind_count = 1;
    f.looks.resize(1);
    fire::ParticleKind& flame = f.fire.kind[0];
    flame = carried_by_air(flame);
    flame.count = fire::share(particles, 0.95f);
    flame.emitter = {fire::Emitter::disc, {0, -0.003f, 0}, {0, 1, 0}, 0.033f};
    flame.velocity_m_per_s = {0, 0.4f, 0};
    flame.spread_m_per_s = 0.1f;
    flame.life_s = 0.6f, flame.life_spread = 0.3f, flame.decay_spread = 0.1f, flame.edge_life = 0.6f;
    fire::SpriteLook& body = f.looks[0] = {};
    body.temperature_start_K = 1950, body.temperature_end_K = 1370;
    body.radius_start_m = 0.008f, body.radius_end_m = 0.010f;
    body.stretch_s = 0.014f;
    body.wisps = 0.4f;
    body.fade_in = 0.08f, body.fade_out = 0.35f;
    body.softness_m = 0.01f;
    body.light = 520.0f / float(flame.count);

    const std::uint32_t puffs = fire::share(particles, 0.05f);
    fire::ParticleKind& puff = fire::add_kind(f, puffs, fire::smoke_look(puffs, 45, 0.015f, 0.05f));
    puff = carried_by_air(puff);
    puff.emitter = {fire::Emitter::disc, {0, 0.15f, 0}, {0, 1, 0}, 0.02f};
    puff.life_s = 0.7f;

    VortexModel& m = scene.model;
    m.physics.core_m = 0.0105f;
    m.physics.cooling_time_s = 0.6f;
    m.physics.decay_time_s = 0.4f;
    m.physics.max_turn_rad_per_s = 60;
    m.birth_turn_rad_per_s = 3;
    m.burn_out_per_s = 2;
    m.cell_m = 0.0125f;
    m.reach_m = 0.5f;
    // Hot gas comes from the whole head, flames from its top.
    stir(m, {fire::Emitter::disc, {0, 0, 0}, {0, 1, 0}, 0.040f}, 3000, 0.55f, 18, 0.65f);
    scene.shading = {0, 5, 115};
    f.view = {{0, 0.17f, 0}, 1.0f, 0.0f, 0.03f};
    return scene;
}

//! [ball]
/// A ball that swings through the flames of the campfire.
inline VortexScene ball(std::uint32_t particles) {
    VortexScene scene = campfire(particles);
    scene.fire.name = "ball";
    scene.model.ball = {{0, 0.45f, 0}, {0.25f, 0, 0}, 0.10f, 3.6f};
    // The last solid on the stage; VortexView takes it along.
    scene.fire.stage.rods.push_back({{0, 1, 0}, {0, 1.01f, 0}, scene.model.ball.radius_m, fire::Rod::wood});
    scene.fire.fire.kind[1].emitter.centre_m.y = 0.58f;
    scene.fire.lights[1].position_m = {0.05f, 0.25f, 0.16f};  // not inside the ball
    return scene;
}
//! [ball]

/// A burning log in the wind: the fire leans, and tears away from where it began. The grid goes with it.
inline VortexScene wind(std::uint32_t particles) {
    VortexScene scene = campfire(particles);
    fire::FireScene& f = scene.fire;
    f.name = "wind";
    f.warm_up_steps = 150;
    f.stage.rods = {{{-0.6f, 0.06f, 0}, {0.6f, 0.06f, 0.02f}, 0.06f, fire::Rod::wood, 0.9f}};
    f.fire.wind.steady_m_per_s = {1.5f, 0, 0.1f};
    f.fire.wind.boundary_m = 0.25f;
    f.fire.wind.gust = 0.35f;
    f.fire.wind.gust_s = 1.7f;
    fire::ParticleKind& flame = f.fire.kind[0];
    flame.emitter = {fire::Emitter::line, {-0.1f, 0.11f, 0}, {1, 0, 0}, 0.35f, 9, 0.055f};
    scene.model.reach_m = 2.5f;
    stir(scene.model, flame.emitter, 4000, 0.6f, 13, 1.1f);
    f.fire.kind[1].emitter = {fire::Emitter::disc, {0.22f, 0.33f, 0}, {0, 1, 0}, 0.20f};
    f.fire.kind[1].spread_m_per_s = 0.9f;
    f.looks[1].radius_end_m = 0.24f;
    f.looks[1].opacity *= 0.45f;
    f.view = {{0.4f, 0.45f, 0}, 2.6f, 0.2f, 0.12f};
    return scene;
}

inline std::vector<std::string> scene_names() {
    return {"campfire", "torch", "ball", "wind"};
}

/// @throws course::BadInput for a name that no scene has
inline VortexScene make_scene(const std::string& name, std::uint32_t particles, std::uint64_t seed) {
    VortexScene scene;
    if (name == "campfire")
        scene = campfire(particles);
    else if (name == "torch")
        scene = torch(particles);
    else if (name == "ball")
        scene = ball(particles);
    else if (name == "wind")
        scene = wind(particles);
    else
        throw course::BadInput("there is no vortex fire '" + name + "'");
    scene.fire.fire.seed = seed;
    return scene;
}

}  // namespace vortex
