/// @file
/// The fires of this chapter: what burns, in which air, how it looks, from where it is seen.
#pragma once
#include <string>
#include <vector>

#include "07_fire_particles/fire_look.h"
#include "07_fire_particles/flame.cuh"
#include "common/camera.h"
#include "common/errors.h"

namespace fire {

/// Everything that makes one scene. Look k belongs to kind k of the fire.
struct FireScene {
    std::string name;
    Fire fire;
    bool curl = false;  ///< is there curl noise? If not, no kernel computes it
    std::vector<SpriteLook> looks;
    Stage stage;
    std::vector<FireLight> lights;  ///< their mean; see lights_at()
    float flicker = 0;              ///< how much the lights waver, relative
    course::OrbitCamera view;
    float field_of_view_rad = 0.5f;
    float dt_s = 1.0f / 120;
    int warm_up_steps = 240;  ///< until the fire has reached its full height
};

/// Ids of one more kind, after those there are.
inline ParticleKind& add_kind(FireScene& scene, std::uint32_t count, const SpriteLook& look) {
    ParticleKind& kind = scene.fire.kind[scene.fire.kind_count];
    kind = {};
    kind.first = particle_count(scene.fire);
    kind.count = count;
    ++scene.fire.kind_count;
    scene.looks.push_back(look);
    return kind;
}

//! [soot]
/// What soot scatters of the light that meets it; it absorbs the rest. Single particles scatter more, but
/// what is deep in a plume lies in the others' shadow, which nobody computes here: chapter 13 does.
const glm::vec3 kSootAlbedo{0.010f, 0.011f, 0.012f};
//! [soot]

/// A share of the particles; at least one.
inline std::uint32_t share(std::uint32_t particles, float part) {
    const std::uint32_t count = std::uint32_t(double(particles) * part);
    return count < 1 ? 1 : count;
}

/// Smoke: soot that covers what is behind it, and reflects next to nothing.
/// @param opacity of all puffs together
inline SpriteLook smoke_look(std::uint32_t puffs, float opacity, float radius_start_m, float radius_end_m) {
    SpriteLook smoke;
    smoke.blend = Blend::alpha;
    smoke.radius_start_m = radius_start_m, smoke.radius_end_m = radius_end_m;
    smoke.fade_in = 0.25f, smoke.fade_out = 0.6f;
    smoke.wisps = 0.8f;
    smoke.colour = kSootAlbedo;
    smoke.opacity = opacity / float(puffs);
    return smoke;
}

/// Sparks: small, hot, drawn out by their flight.
inline SpriteLook spark_look(float radius_m, float stretch_s) {
    SpriteLook spark;
    spark.radius_start_m = radius_m, spark.radius_end_m = 0.7f * radius_m;
    spark.stretch_s = stretch_s;
    spark.fade_in = 0.02f, spark.fade_out = 0.3f;
    spark.wisps = 0;
    spark.temperature_start_K = 1650, spark.temperature_end_K = 1350;
    spark.light = 40;
    return spark;
}

//! [candle]
/// A candle in still air: no turbulence at all. Its shape is the air that the plume draws in, and fuel that
/// lives longer the nearer to the middle it was born.
inline FireScene candle(std::uint32_t particles) {
    FireScene scene;
    scene.name = "candle";
    scene.dt_s = 1.0f / 500;
    scene.warm_up_steps = 120;
    scene.fire.wind.updraft_m_per_s = 0.9f;
    scene.fire.wind.updraft_height_m = 0.035f;

    SpriteLook body;
    const std::uint32_t bright = share(particles, 0.85f);
    body.radius_start_m = 0.0026f, body.radius_end_m = 0.0016f;
    body.stretch_s = 0.012f;
    body.fade_in = 0.62f, body.fade_out = 0.16f;
    body.wisps = 0;
    body.softness_m = 0.002f;
    body.temperature_start_K = 1950, body.temperature_end_K = 1750;
    body.light = 190.0f / float(bright);
    ParticleKind& flame = add_kind(scene, bright, body);
    flame.emitter = {Emitter::disc, {0, 0.0025f, 0}, {0, 1, 0}, 0.0030f};
    flame.velocity_m_per_s = {0, 0.10f, 0};
    flame.outward_m_per_s = 0.16f;
    flame.spread_m_per_s = 0.05f;
    flame.life_s = 0.092f, flame.life_spread = 0.08f, flame.edge_life = 0.4f;
    flame.drag_time_s = 0.02f;
    flame.buoyancy_m_per_s2 = 14, flame.cooling_time_s = 0.08f;

    // Where the fuel meets air first it burns without soot: blue, and no black body.
    SpriteLook base = body;
    const std::uint32_t blue = share(particles, 0.15f);
    base.temperature_start_K = 0;
    base.colour = {0.03f, 0.13f, 1.0f};
    base.radius_start_m = 0.0016f, base.radius_end_m = 0.0012f;
    base.fade_in = 0.1f, base.fade_out = 0.8f;
    base.light = 5.0f / float(blue);
    ParticleKind& ring = add_kind(scene, blue, base);
    ring = {ring.first, ring.count, {Emitter::ring, {0, 0.0010f, 0}, {0, 1, 0}, 0.0032f}};
    ring.velocity_m_per_s = {0, 0.08f, 0};
    ring.outward_m_per_s = 0.17f;
    ring.spread_m_per_s = 0.02f;
    ring.life_s = 0.04f, ring.life_spread = 0.2f;
    ring.drag_time_s = 0.02f;
    ring.buoyancy_m_per_s2 = 14, ring.cooling_time_s = 0.08f;

    scene.stage.rods = {{{0, -0.080f, 0}, {0, -0.010f, 0}, 0.012f, Rod::wax},
                        {{0, -0.011f, 0}, {0.0009f, 0.0045f, 0}, 0.0007f, Rod::wick, 1}};
    scene.stage.ground = false;
    scene.stage.sky_low = scene.stage.sky_high = glm::vec3(0.0012f, 0.0016f, 0.0026f);  // a dark room
    scene.lights = {{{0, 0.018f, 0}, glm::vec3(1.0f, 0.45f, 0.12f) * 6e-4f, 0.008f}};
    scene.flicker = 0.03f;
    scene.view = {{0, 0.010f, 0}, 0.17f, 0.0f, 0.16f};
    return scene;
}
//! [candle]

/// A torch: fuel on a stick, flames torn by their own turbulence.
inline FireScene torch(std::uint32_t particles) {
    FireScene scene;
    scene.name = "torch";
    scene.curl = true;
    scene.dt_s = 1.0f / 180;
    scene.warm_up_steps = 240;
    scene.fire.wind.updraft_m_per_s = 1.4f;
    scene.fire.wind.updraft_height_m = 0.22f;
    scene.fire.wind.steady_m_per_s = {-0.16f, 0, 0};  // somebody carries it
    scene.fire.noise = make_curl_noise(0.50f, 0.24f, 1.1f, 0.10f, 11);

    SpriteLook body;
    const std::uint32_t count = share(particles, 0.93f);
    body.radius_start_m = 0.010f, body.radius_end_m = 0.007f;
    body.stretch_s = 0.03f;
    body.fade_in = 0.20f, body.fade_out = 0.35f;
    body.wisps = 0.85f;
    body.temperature_start_K = 1900, body.temperature_end_K = 1400;
    body.light = 600.0f / float(count);
    ParticleKind& flame = add_kind(scene, count, body);
    flame.emitter = {Emitter::disc, {0, -0.055f, 0}, {0, 1, 0}, 0.030f};
    flame.emitter.roots = 9;
    flame.emitter.root_m = 0.013f;
    flame.velocity_m_per_s = {0, 0.25f, 0};
    flame.outward_m_per_s = 0.15f;
    flame.spread_m_per_s = 0.2f;
    flame.life_s = 0.56f, flame.life_spread = 0.40f, flame.decay_spread = 0.2f, flame.edge_life = 0.5f;
    flame.drag_time_s = 0.05f;
    flame.buoyancy_m_per_s2 = 9, flame.cooling_time_s = 0.4f;

    // What burns incompletely goes up as smoke, dark and thin.
    const std::uint32_t puffs = share(particles, 0.065f);
    ParticleKind& plume = add_kind(scene, puffs, smoke_look(puffs, 45, 0.018f, 0.065f));
    plume.emitter = {Emitter::disc, {-0.04f, 0.12f, 0}, {0, 1, 0}, 0.022f};
    plume.velocity_m_per_s = {-0.1f, 0.8f, 0};
    plume.spread_m_per_s = 0.12f;
    plume.life_s = 0.6f;
    plume.drag_time_s = 0.06f;
    plume.buoyancy_m_per_s2 = 3, plume.cooling_time_s = 0.6f;

    ParticleKind& ember = add_kind(scene, share(particles, 0.004f), spark_look(0.0010f, 0.012f));
    ember.emitter = {Emitter::disc, {0, -0.05f, 0}, {0, 1, 0}, 0.035f};
    ember.velocity_m_per_s = {0, 0.9f, 0};
    ember.spread_m_per_s = 0.5f;
    ember.life_s = 0.6f, ember.life_spread = 0.5f, ember.decay_spread = 0.4f;
    ember.rest_s = 4;
    ember.drag_time_s = 0.2f;
    ember.buoyancy_m_per_s2 = 2, ember.cooling_time_s = 0.5f;

    scene.stage.rods = {{{0.02f, -0.75f, 0}, {0, -0.05f, 0}, 0.016f, Rod::wood, 0},
                        {{0.0f, -0.115f, 0}, {0, -0.06f, 0}, 0.028f, Rod::wood, 0.7f}};
    scene.stage.ground = false;
    scene.lights = {{{0, 0.08f, 0}, glm::vec3(1.0f, 0.42f, 0.10f) * 0.05f, 0.05f}};
    scene.flicker = 0.2f;
    scene.view = {{0, 0.15f, 0}, 1.05f, 0.0f, 0.03f};
    return scene;
}

/// A campfire: flames from between logs, sparks, and the smoke above.
inline FireScene campfire(std::uint32_t particles) {
    FireScene scene;
    scene.name = "campfire";
    scene.curl = true;
    scene.dt_s = 1.0f / 120;
    scene.warm_up_steps = 410;
    scene.fire.wind.updraft_m_per_s = 2.4f;
    scene.fire.wind.updraft_height_m = 0.7f;
    scene.fire.noise = make_curl_noise(0.95f, 0.50f, 1.6f, 0.25f, 5);

    SpriteLook body;
    const std::uint32_t count = share(particles, 0.85f);
    body.radius_start_m = 0.034f, body.radius_end_m = 0.020f;
    body.stretch_s = 0.045f;
    body.fade_in = 0.10f, body.fade_out = 0.35f;
    body.wisps = 0.7f;
    body.temperature_start_K = 1880, body.temperature_end_K = 1340;
    body.light = 1900.0f / float(count);
    ParticleKind& flame = add_kind(scene, count, body);
    flame.emitter = {Emitter::disc, {0, 0.07f, 0}, {0, 1, 0}, 0.19f};
    flame.emitter.roots = 11;
    flame.emitter.root_m = 0.05f;
    flame.velocity_m_per_s = {0, 0.4f, 0};
    flame.spread_m_per_s = 0.3f;
    flame.life_s = 0.75f, flame.life_spread = 0.4f, flame.decay_spread = 0.2f, flame.edge_life = 0.4f;
    flame.drag_time_s = 0.08f;
    flame.buoyancy_m_per_s2 = 9, flame.cooling_time_s = 0.6f;

    const std::uint32_t puffs = share(particles, 0.14f);
    ParticleKind& plume = add_kind(scene, puffs, smoke_look(puffs, 110, 0.05f, 0.17f));
    plume.emitter = {Emitter::disc, {0, 0.40f, 0}, {0, 1, 0}, 0.09f};
    plume.velocity_m_per_s = {0, 1.2f, 0};
    plume.spread_m_per_s = 0.3f;
    plume.life_s = 0.9f;
    plume.drag_time_s = 0.08f;
    plume.buoyancy_m_per_s2 = 5, plume.cooling_time_s = 1.0f;

    ParticleKind& ember = add_kind(scene, share(particles, 0.01f), spark_look(0.0028f, 0.016f));
    ember.emitter = {Emitter::disc, {0, 0.12f, 0}, {0, 1, 0}, 0.18f};
    ember.velocity_m_per_s = {0, 1.8f, 0};
    ember.spread_m_per_s = 0.9f;
    ember.life_s = 1.1f, ember.life_spread = 0.5f, ember.decay_spread = 0.4f;
    ember.rest_s = 3;
    ember.drag_time_s = 0.25f;
    ember.buoyancy_m_per_s2 = 3, ember.cooling_time_s = 0.8f;

    const auto log_at = [&](float angle, float inner, float outer, float low, float high, float radius) {
        const glm::vec3 way(std::cos(angle), 0, std::sin(angle));
        scene.stage.rods.push_back({way * outer + glm::vec3(0, low, 0), way * inner + glm::vec3(0, high, 0),
                                    radius, Rod::wood, 0.8f});
    };
    log_at(0.35f, -0.02f, 0.42f, 0.05f, 0.17f, 0.045f);
    log_at(1.75f, 0.03f, 0.40f, 0.05f, 0.15f, 0.05f);
    log_at(2.85f, -0.03f, 0.44f, 0.05f, 0.19f, 0.042f);
    log_at(4.15f, 0.02f, 0.40f, 0.045f, 0.16f, 0.045f);
    log_at(5.35f, -0.02f, 0.45f, 0.05f, 0.14f, 0.05f);
    scene.lights = {{{0, 0.15f, 0}, glm::vec3(1.0f, 0.36f, 0.07f) * 0.12f, 0.15f},
                    {{0, 0.50f, 0}, glm::vec3(1.0f, 0.42f, 0.10f) * 0.28f, 0.20f}};
    scene.flicker = 0.2f;
    scene.view = {{0, 0.66f, 0}, 3.2f, 0.2f, 0.12f};
    return scene;
}

/// A burning log in a gusty wind.
inline FireScene wind(std::uint32_t particles) {
    FireScene scene = campfire(particles);
    scene.name = "wind";
    scene.fire.wind.steady_m_per_s = {1.6f, 0, 0.1f};
    scene.fire.wind.boundary_m = 0.13f;
    scene.fire.wind.gust = 0.35f;
    scene.fire.wind.gust_s = 1.7f;
    scene.fire.wind.updraft_m_per_s = 1.2f;
    scene.fire.kind[0].life_s = 0.62f;
    scene.fire.kind[0].emitter = {Emitter::line, {0, 0.10f, 0}, {1, 0, 0}, 0.35f, 9, 0.055f};
    scene.stage.rods = {{{-0.6f, 0.06f, 0}, {0.6f, 0.06f, 0.02f}, 0.06f, Rod::wood, 0.9f}};
    scene.fire.kind[1].emitter = {Emitter::disc, {0.30f, 0.34f, 0}, {0, 1, 0}, 0.13f};
    scene.lights[0].position_m.x = 0.1f, scene.lights[1].position_m = {0.35f, 0.4f, 0};
    scene.view.target_m = {0.32f, 0.40f, 0};
    return scene;
}

inline std::vector<std::string> scene_names() {
    return {"candle", "torch", "campfire", "wind"};
}

/// @throws course::BadInput for a name that no scene has
inline FireScene make_scene(const std::string& name, std::uint32_t particles, std::uint64_t seed) {
    FireScene scene;
    if (name == "candle")
        scene = candle(particles);
    else if (name == "torch")
        scene = torch(particles);
    else if (name == "campfire")
        scene = campfire(particles);
    else if (name == "wind")
        scene = wind(particles);
    else
        throw course::BadInput("there is no fire '" + name + "'");
    scene.fire.seed = seed;
    return scene;
}

//! [needs]
/// What a scene needs, and what it leaves out. Tests hold it against what a run really does.
struct Needs {
    int kernels_per_step = 1;
    std::size_t gl_bytes = 0;      ///< of a particle's state, in OpenGL buffers
    std::size_t device_bytes = 0;  ///< of a particle's state, from cudaMalloc
    int sorts_per_picture = 0;     ///< kinds that cover what is behind them
    int curl_waves = 0;            ///< sines and cosines a particle and step
};
inline Needs needs(const FireScene& scene, bool draws) {
    Needs needs;
    needs.gl_bytes = draws ? 2 * sizeof(float4) : 0;
    needs.device_bytes = kFlameBytes - needs.gl_bytes;
    needs.curl_waves = scene.curl ? kWaves : 0;
    for (const SpriteLook& look : scene.looks)
        if (draws && look.blend == Blend::alpha) ++needs.sorts_per_picture;
    return needs;
}
//! [needs]

/// The answer to --explain for one scene.
inline std::string explain(const FireScene& scene, bool draws) {
    const Needs n = needs(scene, draws);
    std::string text = scene.name + ": " + std::to_string(particle_count(scene.fire)) + " particles of " +
                       std::to_string(scene.fire.kind_count) + " kinds\n";
    text += "  each step: " + std::to_string(n.kernels_per_step) + " kernel (flame_step_kernel<" +
            (scene.curl ? "true" : "false") + ">), curl noise of " + std::to_string(n.curl_waves) +
            " waves\n";
    text += "  each particle: " + std::to_string(n.gl_bytes) + " bytes in OpenGL buffers, " +
            std::to_string(n.device_bytes) + " from cudaMalloc\n";
    text += "  each picture: " + std::to_string(n.sorts_per_picture) + " sorts by depth" +
            (n.sorts_per_picture ? " (smoke)\n" : " (light adds up in any order)\n");
    text +=
        "  left out: neighbours and grid (particles do not know each other), colour and size arrays (they "
        "follow from the age)";
    if (!scene.curl) text += ", curl noise";
    if (!draws) text += ", OpenGL";
    return text + "\n";
}

/// Ages are floats: one of a second does not grow by less than 6e-8 s. With this step it does, within 6 %.
constexpr float kShortestStep_s = 1e-6f;

//! [check]
/// @throws course::BadInput if a life could end in the step in which it begins, or a number makes no sense
inline void check(const Fire& fire, const std::string& name, float dt_s) {
    const auto want = [&](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput("the " + name + ": " + sentence);
    };
    want(dt_s >= kShortestStep_s,
         "the time step must be at least 0.000001 s: with less, ages would not grow");
    for (int k = 0; k < fire.kind_count; ++k) {
        const ParticleKind& kind = fire.kind[k];
        const auto part = [](float x) { return x >= 0 && x < 1; };  // false for NaN, too
        want(part(kind.life_spread) && part(kind.decay_spread),
             "spreads of life and decay must be from 0 to below 1");
        want(kind.drag_time_s > 0 && kind.cooling_time_s >= 0 && kind.rest_s >= 0,
             "times of drag, cooling and rest must not be negative, and drag's not 0");
        want(std::isfinite(kind.buoyancy_m_per_s2) && kind.emitter.size_m > 0 && kind.edge_life > 0,
             "buoyancy must be a number, and an emitter's size and the life at its edge above 0");
        const float shortest_s = kind.life_s * (1 - kind.life_spread) / (1 + kind.decay_spread) *
                                 (kind.edge_life < 1 ? kind.edge_life : 1.0f);
        want(dt_s <= 0.5f * shortest_s, "some particles live only " + std::to_string(shortest_s) +
                                            " s: the time step must be at most half of that, not " +
                                            std::to_string(dt_s) + " s");
    }
}
//! [check]
inline void check(const FireScene& scene) {
    check(scene.fire, scene.name, scene.dt_s);
}

/// The lights at one moment: they waver as a flame does, faster than a wave and slower than a flash.
inline std::vector<FireLight> lights_at(const FireScene& scene, float time_s) {
    std::vector<FireLight> lights = scene.lights;
    for (std::size_t k = 0; k < lights.size(); ++k) {
        const float t = time_s + 3.7f * float(k);
        const float waver =
            std::sin(11 * t) + 0.7f * std::sin(17.3f * t + 1) + 0.5f * std::sin(29.1f * t + 2);
        lights[k].intensity *= 1 + 0.45f * scene.flicker * waver;
        lights[k].position_m += 0.2f * scene.flicker * lights[k].size_m *
                                glm::vec3(std::sin(7.1f * t), std::sin(9.7f * t), std::sin(8.3f * t));
    }
    return lights;
}

inline course::Camera camera_of(const FireScene& scene, const course::OrbitCamera& orbit) {
    course::Camera lens;
    lens.field_of_view_rad = scene.field_of_view_rad;
    lens.near_m = 0.02f * scene.view.distance_m;
    return orbit.camera(lens);
}
inline course::Camera camera_of(const FireScene& scene) {
    return camera_of(scene, scene.view);
}

}  // namespace fire
