/// @file
/// The scenes of this chapter that hold water: a tank, a block of water, and what is in its way.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "06_gl_interop/tank_view.cuh"
#include "10_water_sph/run.cuh"
#include "12_obstacles/ghost_water.cuh"

namespace obstacles {

/// Water with obstacles.
struct WaterScene {
    sph::Scene water;
    std::vector<Obstacle> obstacles;
    double duration_s = 1.5;
};

/// Two legs that take a resting obstacle `way_m` farther in `time_s` and let it rest again.
inline void go(Path& path, glm::dvec3 way_m, double time_s) {
    const glm::dvec3 a = 4.0 / (time_s * time_s) * way_m;
    path.legs.push_back({time_s / 2, a});
    path.legs.push_back({time_s / 2, -a});
}

//! [scenes]
inline std::vector<WaterScene> water_scenes() {
    // A dam breaks, and the wave meets a sphere that stands in its way.
    WaterScene wave{{"wave_against_sphere", {{0, 0, 0}, {0.9f, 0.6f, 0.4f}}, {0, 0, 0}, {0.4f, 0.4f, 0.4f}}};
    Obstacle ball;
    ball.solid = sphere(0.09f);
    ball.path.start_m = {0.62, 0.09, 0.2};
    wave.obstacles = {ball};

    // A box dives into a pool, goes to and fro, and comes out again.
    WaterScene stir{{"box_in_water", {{0, 0, 0}, {0.9f, 0.6f, 0.4f}}, {0, 0, 0}, {0.9f, 0.2f, 0.4f}}};
    Obstacle paddle;
    paddle.solid = box({0.06f, 0.11f, 0.09f});
    paddle.path.start_m = {0.2, 0.42, 0.2};
    go(paddle.path, {0, -0.26, 0}, 0.5);
    go(paddle.path, {0.5, 0, 0}, 0.7);
    go(paddle.path, {-0.5, 0, 0}, 0.7);
    go(paddle.path, {0, 0.26, 0}, 0.5);
    stir.obstacles = {paddle};
    stir.duration_s = 2.2;

    // A ball of half the water's density falls into a pool, dives, and comes up to float.
    WaterScene drop{{"floating_ball", {{0, 0, 0}, {0.6f, 0.6f, 0.4f}}, {0, 0, 0}, {0.6f, 0.25f, 0.4f}}};
    Obstacle buoy;
    buoy.solid = sphere(0.08f);
    buoy.control = Control::free;
    buoy.mass_kg = 500 * volume_m3(buoy.solid);
    buoy.path.start_m = {0.3, 0.45, 0.2};
    drop.obstacles = {buoy};
    drop.duration_s = 2;
    return {wave, stir, drop};
}
//! [scenes]

//! [fastest]
/// Part of the water's sound speed that an obstacle may reach: see the stability map `push`.
constexpr double kFastestPerSound = 0.25;
//! [fastest]

/// Everything that a run with water depends on.
struct WaterSettings {
    WaterScene scene;
    Skin skin = Skin::ghost;
    Control control = Control::path;  ///< hand: obstacle 0 follows the mouse, whatever its scene says
    std::uint32_t particles = 12000;
    float dt_s = 0;    ///< 0: the largest that the water allows
    double speed = 1;  ///< factor on the speed of written paths
    std::uint64_t seed = 1;
    double fastest_per_sound = kFastestPerSound;
};

/// The same path, run through `factor` times as fast. @throws course::BadInput if that is no factor
inline Path faster(Path path, double factor) {
    if (!(factor > 0 && factor <= 1e6))
        throw course::BadInput("the speed must be a factor above 0, and at most 1000000");
    path.start_velocity_m_per_s *= factor;
    for (Leg& leg : path.legs) {
        leg.duration_s /= factor;
        leg.acceleration_m_per_s2 *= factor * factor;
    }
    return path;
}

/// @throws course::BadInput if a particle starts nearer to an obstacle than the gap
inline void require_room(const std::vector<float4>& position, const ObstacleSet& obstacles, float spacing_m) {
    for (const float4& x : position)
        for (int k = 0; k < obstacles.size(); ++k) {
            const Moving& o = obstacles.now().obstacle[k];
            if (signed_distance(o.solid, grid::xyz(x) - o.to_m) >= -1e-4f * spacing_m) continue;
            throw course::BadInput("obstacle " + std::to_string(k) +
                                   " takes room where particles start: make it smaller, or put it elsewhere");
        }
}

/// Water and its obstacles, moved together.
class WaterRun {
  public:
    /// @throws course::BadInput if the obstacles or the water are not what a run can start from
    explicit WaterRun(const WaterSettings& settings)
        : settings_(settings),
          start_(sph::make_start(water_settings(settings))),
          obstacles_(make_obstacles(settings, start_)) {
        require_room(start_.water.positions().download(), obstacles_, start_.spacing_m);
    }

    void step() { obstacles::step(start_.water, obstacles_, settings_.skin); }
    /// @throws course::Unstable naming the step, the particle, and the likely cause
    void check_state(int step) {
        sph::check_state(start_.water, summarize_(start_.water), step, start_.dt_s);
    }

    const sph::Water& water() const { return start_.water; }
    ObstacleSet& obstacles() { return obstacles_; }
    const ObstacleSet& obstacles() const { return obstacles_; }
    const float4* position() const { return start_.water.position(); }
    const float4* velocity() const { return start_.water.velocity(); }
    std::uint32_t size() const { return start_.water.size(); }
    float dt_s() const { return start_.dt_s; }
    float spacing_m() const { return start_.spacing_m; }
    double particle_mass_kg() const { return start_.water.fluid().mass_kg; }
    double duration_s() const { return settings_.scene.duration_s / settings_.speed; }
    /// As chapter 10 would be asked for the same water.
    sph::Settings water_settings() const { return water_settings(settings_); }
    interop::TankScene view() const {
        interop::TankScene view;
        view.tank = {corner(settings_.scene.water.tank.low_m), corner(settings_.scene.water.tank.high_m)};
        view.radius_m = 0.55f * start_.spacing_m;
        // White where water is as fast as a free fall from the top of the block makes it.
        view.white_at_m_per_s = 1.1f * start_.water.fluid().sound_speed_m_per_s / 6 * 1.4142f;
        return view;
    }

  private:
    static glm::vec3 corner(float3 x) { return {x.x, x.y, x.z}; }
    static sph::Settings water_settings(const WaterSettings& settings) {
        sph::Settings water;
        water.scene = settings.scene.water;
        water.particles = settings.particles;
        water.dt_s = settings.dt_s;
        water.seed = settings.seed;
        return water;
    }
    static ObstacleSet make_obstacles(const WaterSettings& settings, const sph::Start& start) {
        const sph::Fluid& fluid = start.water.fluid();
        Setting setting;
        setting.particles = start.water.size();
        setting.particle_mass_kg = fluid.mass_kg;
        setting.gap_m = 0.5f * start.spacing_m;
        setting.low_m = corner(settings.scene.water.tank.low_m);
        setting.high_m = corner(settings.scene.water.tank.high_m);
        setting.gravity_m_per_s2 = {fluid.gravity_m_per_s2.x, fluid.gravity_m_per_s2.y,
                                    fluid.gravity_m_per_s2.z};
        setting.dt_s = start.dt_s;
        setting.fastest_m_per_s = settings.fastest_per_sound * fluid.sound_speed_m_per_s;
        setting.why_fastest =
            "a quarter of the speed of sound in this water, beyond which it is no water any more";
        std::vector<Obstacle> obstacles = settings.scene.obstacles;
        for (Obstacle& o : obstacles) o.path = faster(o.path, settings.speed);
        if (settings.control == Control::hand && !obstacles.empty()) obstacles[0].control = Control::hand;
        return ObstacleSet(obstacles, setting);
    }

    WaterSettings settings_;
    sph::Start start_;
    ObstacleSet obstacles_;
    sph::Summarizer summarize_{start_.water.size()};
};

}  // namespace obstacles
