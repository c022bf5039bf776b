/// @file
/// The fires of this chapter: chapter 07's particles, loaded with soot and heat.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "07_fire_particles/fire_scene.cuh"
#include "08_fire_vortex/vortex_scene.cuh"
#include "13_volume_rendering/fire_volume.cuh"

namespace volume {

/// What burns, what it carries, from where it is seen.
struct VolumeScene {
    std::string name;
    fire::Fire fire;
    bool curl = true;
    std::optional<vortex::VortexModel> stirred;  ///< if set, chapter 08's vortons move the air
    VolumeLook look;
    course::OrbitCamera view;
    float field_of_view_rad = 0.5f;
    float dt_s = 1.0f / 90;
    float detail_rises_m_per_s = 1.6f;  ///< the detail goes up with the gas
    int warm_up_steps = 200;            ///< until the smoke has filled the picture
};

/// One more kind of particle and what it carries.
inline fire::ParticleKind& add_kind(VolumeScene& scene, std::uint32_t count, const Cargo& cargo) {
    fire::Fire& f = scene.fire;
    fire::ParticleKind& kind = f.kind[f.kind_count];
    kind = {};
    kind.first = fire::particle_count(f);
    kind.count = count;
    Cargos& cargos = scene.look.cargos;
    cargos.cargo[cargos.count] = cargo;
    cargos.first[cargos.count++] = kind.first;
    ++f.kind_count;
    return kind;
}

//! [campfire]
/// Flames between logs, and the smoke above them. Totals are those of the whole fire: with more particles
/// each one carries less, and the picture gets finer, not brighter.
inline VolumeScene campfire(std::uint32_t particles) {
    VolumeScene scene;
    scene.name = "campfire";
    scene.fire.wind.updraft_m_per_s = 2.4f;
    scene.fire.wind.updraft_height_m = 0.75f;
    scene.fire.wind.steady_m_per_s = {0.25f, 0, 0};
    scene.fire.wind.boundary_m = 1.2f;
    scene.fire.noise = fire::make_curl_noise(0.90f, 0.40f, 1.6f, 0.32f, 5);

    const std::uint32_t flames = fire::share(particles, 0.8f), puffs = fire::share(particles, 0.2f);
    Cargo flame;
    flame.radius_m[0] = 0.040f, flame.radius_m[1] = 0.026f;
    flame.soot_kg[0] = 4.5e-5f / float(flames), flame.soot_kg[1] = 3.5e-5f / float(flames);
    flame.heat_K_m3[0] = 300.0f / float(flames), flame.heat_K_m3[1] = 210.0f / float(flames);
    flame.fade_in = 0.06f, flame.fade_out = 0.3f;
    fire::ParticleKind& body = add_kind(scene, flames, flame);
    body.emitter = {fire::Emitter::disc, {0, 0.07f, 0}, {0, 1, 0}, 0.20f};
    body.emitter.roots = 9;
    body.emitter.root_m = 0.06f;
    body.velocity_m_per_s = {0, 0.4f, 0};
    body.spread_m_per_s = 0.3f;
    body.life_s = 1.0f, body.life_spread = 0.4f, body.decay_spread = 0.2f, body.edge_life = 0.4f;
    body.drag_time_s = 0.08f;
    body.buoyancy_m_per_s2 = 9, body.cooling_time_s = 0.6f;

    Cargo smoke;
    smoke.radius_m[0] = 0.06f, smoke.radius_m[1] = 0.12f;
    smoke.soot_kg[0] = smoke.soot_kg[1] = 4.5e-4f / float(puffs);
    smoke.fade_in = 0.25f, smoke.fade_out = 0.3f;
    fire::ParticleKind& plume = add_kind(scene, puffs, smoke);
    plume.emitter = {fire::Emitter::disc, {0, 0.35f, 0}, {0, 1, 0}, 0.14f};
    plume.velocity_m_per_s = {0, 1.0f, 0};
    plume.spread_m_per_s = 0.3f;
    plume.life_s = 1.6f;
    plume.drag_time_s = 0.08f;
    plume.buoyancy_m_per_s2 = 5, plume.cooling_time_s = 1.0f;

    scene.look.low_m = {-0.8f, 0, -0.8f};
    scene.look.high_m = {1.0f, 2.5f, 0.8f};
    scene.look.film = {3.6f, 0.06f};
    scene.look.stage = make_solid(fire::campfire(100).stage, scene.look.film.exposure);
    scene.look.albedo = 0.5f;
    scene.look.detail.reach_m = 0.045f;
    scene.look.detail.length_m = 0.13f;
    scene.look.detail.full_height_m = 0.4f;
    scene.view = {{0, 0.72f, 0}, 3.2f, 0.2f, 0.12f};
    return scene;
}
//! [campfire]

/// Fuel on a stick, and the black smoke that it makes.
inline VolumeScene torch(std::uint32_t particles) {
    VolumeScene scene;
    scene.name = "torch";
    scene.fire.wind.updraft_m_per_s = 1.6f;
    scene.fire.wind.updraft_height_m = 0.30f;
    scene.fire.noise = fire::make_curl_noise(0.60f, 0.13f, 1.0f, 0.12f, 11);

    const std::uint32_t flames = fire::share(particles, 0.8f), puffs = fire::share(particles, 0.2f);
    Cargo flame;
    flame.radius_m[0] = 0.013f, flame.radius_m[1] = 0.008f;
    flame.soot_kg[0] = 1.7e-6f / float(flames), flame.soot_kg[1] = 1.6e-6f / float(flames);
    flame.heat_K_m3[0] = 6.0f / float(flames), flame.heat_K_m3[1] = 4.0f / float(flames);
    flame.fade_in = 0.04f, flame.fade_out = 0.3f;
    fire::ParticleKind& body = add_kind(scene, flames, flame);
    body.emitter = {fire::Emitter::disc, {0, -0.045f, 0}, {0, 1, 0}, 0.036f};
    body.velocity_m_per_s = {0, 0.25f, 0};
    body.spread_m_per_s = 0.2f;
    body.life_s = 0.60f, body.life_spread = 0.35f, body.decay_spread = 0.2f, body.edge_life = 0.5f;
    body.drag_time_s = 0.05f;
    body.buoyancy_m_per_s2 = 9, body.cooling_time_s = 0.4f;

    Cargo smoke;
    smoke.radius_m[0] = 0.022f, smoke.radius_m[1] = 0.06f;
    smoke.soot_kg[0] = smoke.soot_kg[1] = 3e-5f / float(puffs);
    smoke.fade_in = 0.25f, smoke.fade_out = 0.3f;
    fire::ParticleKind& plume = add_kind(scene, puffs, smoke);
    plume.emitter = {fire::Emitter::disc, {0, 0.12f, 0}, {0, 1, 0}, 0.035f};
    plume.velocity_m_per_s = {0, 0.7f, 0};
    plume.spread_m_per_s = 0.15f;
    plume.life_s = 0.8f;
    plume.drag_time_s = 0.05f;
    plume.buoyancy_m_per_s2 = 4, plume.cooling_time_s = 0.6f;

    scene.look.low_m = {-0.24f, -0.08f, -0.24f};
    scene.look.high_m = {0.24f, 0.9f, 0.24f};
    scene.look.cell_m = 0.0042f;
    fire::Stage stick = fire::torch(100).stage;
    for (fire::Rod& rod : stick.rods) rod.embers *= 0.3f;
    scene.look.film = {2.5f, 0.06f};
    scene.look.stage = make_solid(stick, scene.look.film.exposure);
    scene.look.albedo = 0.5f;
    scene.look.detail.reach_m = 0.020f;
    scene.look.detail.length_m = 0.05f;
    scene.look.detail.full_height_m = 0.15f;
    scene.view = {{0, 0.22f, 0}, 1.2f, 0.0f, 0.0f};
    scene.detail_rises_m_per_s = 1.0f;
    scene.dt_s = 1.0f / 120;
    scene.warm_up_steps = 150;
    return scene;
}

//! [vortex]
/// Chapter 08's campfire, loaded in the same way: its vortices tear the flames, no noise does.
inline VolumeScene vortex_campfire(std::uint32_t particles) {
    const vortex::VortexScene from = vortex::make_scene("campfire", particles, 1);
    VolumeScene scene = campfire(particles);
    scene.name = "vortex";
    scene.curl = false;
    scene.fire = from.fire.fire;
    scene.stirred = from.model;
    scene.dt_s = from.fire.dt_s;
    scene.warm_up_steps = from.fire.warm_up_steps;

    Cargos& cargos = scene.look.cargos;
    cargos.count = scene.fire.kind_count;
    for (int k = 0; k < cargos.count; ++k) cargos.first[k] = scene.fire.kind[k].first;
    // The same fire as campfire(), a little less of it: eddies mix less than noise does, and keep it hot.
    const float flames = float(fire::share(particles, 0.8f)) / float(scene.fire.kind[0].count);
    const float puffs = float(fire::share(particles, 0.2f)) / float(scene.fire.kind[1].count);
    for (int end = 0; end < 2; ++end) {
        cargos.cargo[0].soot_kg[end] *= 0.6f * flames;
        cargos.cargo[0].heat_K_m3[end] *= 0.68f * flames;
        cargos.cargo[1].soot_kg[end] *= puffs;
    }
    for (int k = 2; k < cargos.count; ++k) cargos.cargo[k] = {};  // sparks carry nothing
    return scene;
}
//! [vortex]

inline std::vector<std::string> scene_names() {
    return {"campfire", "torch", "vortex"};
}

/// @throws course::BadInput for a name that no scene has
inline VolumeScene make_scene(const std::string& name, std::uint32_t particles, std::uint64_t seed) {
    VolumeScene scene;
    if (name == "campfire")
        scene = campfire(particles);
    else if (name == "torch")
        scene = torch(particles);
    else if (name == "vortex")
        scene = vortex_campfire(particles);
    else
        throw course::BadInput("there is no fire '" + name + "'");
    scene.fire.seed = seed;
    return scene;
}

inline course::Camera camera_of(const VolumeScene& scene) {
    course::Camera lens;
    lens.field_of_view_rad = scene.field_of_view_rad;
    return scene.view.camera(lens);
}

/// The particles of a scene on the device, moved by chapter 07's air or by chapter 08's.
class Particles {
  public:
    explicit Particles(const VolumeScene& scene)
        : fire_(scene.fire),
          curl_(scene.curl),
          dt_s_(scene.dt_s),
          position_(fire::particle_count(scene.fire)),
          velocity_(position_.size()),
          generation_(position_.size()) {
        fire::launch_flame_clear(arrays(), fire_);
        if (scene.stirred) vortons_ = std::make_unique<vortex::VortexFire>(scene.fire, *scene.stirred);
    }
    void step() {
        if (vortons_)
            vortons_->step(arrays(), dt_s_);
        else
            fire::launch_flame_step(arrays(), fire_, curl_, time_s(), dt_s_);
        ++steps_;
    }
    /// @throws course::Unstable if chapter 08's vortons have run away. Chapter 07's step is exact: it cannot.
    void check_state() {
        if (vortons_) vortons_->check_state(arrays(), dt_s_);
    }
    const float4* position() const { return position_.data(); }
    const float4* velocity() const { return velocity_.data(); }
    const course::DeviceBuffer<float4>& positions() const { return position_; }
    const course::DeviceBuffer<float4>& velocities() const { return velocity_; }
    std::uint32_t size() const { return std::uint32_t(position_.size()); }
    float time_s() const { return float(steps_ * double(dt_s_)); }  // counted, never summed

  private:
    fire::FlameArrays arrays() { return {position_.data(), velocity_.data(), generation_.data()}; }

    fire::Fire fire_;
    bool curl_;
    float dt_s_;
    std::uint32_t steps_ = 0;
    course::DeviceBuffer<float4> position_, velocity_;
    course::DeviceBuffer<std::uint32_t> generation_;
    std::unique_ptr<vortex::VortexFire> vortons_;
};

}  // namespace volume
