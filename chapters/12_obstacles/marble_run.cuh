/// @file
/// Chapter 09's marbles with the same obstacles. They ask for less than water does: a marble is its own skin.
#pragma once
#include "06_gl_interop/tank_view.cuh"
#include "09_water_spring_mass/run.cuh"
#include "12_obstacles/scene.cuh"

namespace obstacles {

/// Marbles with obstacles.
struct MarbleScene {
    spring_mass::Scene marbles;
    std::vector<Obstacle> obstacles;
    double duration_s = 1.2;
};

//! [marble_scene]
/// A block of glass marbles falls on a ball, and runs off it.
inline MarbleScene marbles_on_sphere() {
    spring_mass::Touch glass;
    glass.friction = 0.3f;
    MarbleScene scene{{"marbles_on_sphere",
                       {{0, 0, 0}, {0.6f, 0.6f, 0.6f}},
                       {0.17f, 0.32f, 0.17f},
                       {0.26f, 0.26f, 0.26f},
                       glass},
                      {}};
    Obstacle ball;
    ball.solid = sphere(0.13f);
    ball.surface = {0.5f, 0.3f};  // glass, too
    ball.path.start_m = {0.3, 0.15, 0.3};
    scene.obstacles = {ball};
    return scene;
}
//! [marble_scene]

/// Everything that a run with marbles depends on.
struct MarbleSettings {
    MarbleScene scene;
    Control control = Control::path;  ///< hand: obstacle 0 follows the mouse
    std::uint32_t particles = 5832;
    float dt_s = 0;    ///< 0: the marbles' own
    double speed = 1;  ///< factor on the speed of written paths
    std::uint64_t seed = 1;
};

/// Marbles and their obstacles, moved together.
class MarbleRun {
  public:
    /// @throws course::BadInput if the obstacles or the marbles are not what a run can start from
    explicit MarbleRun(const MarbleSettings& settings)
        : settings_(settings),
          start_(spring_mass::make_start(marble_settings(settings))),
          obstacles_(make_obstacles(settings, start_)) {
        require_room(start_.marbles.positions().download(), obstacles_, start_.spacing_m);
        start_J_ = summarize_(start_.marbles).energy_J();
    }

    //! [marble_step]
    /// The marbles' whole step, then those that met an obstacle. Their velocity at its end stands for the one
    /// they moved with: half a kick of difference, which moves the start of their way by a fraction of what
    /// springs give way.
    void step() {
        start_.marbles.step(start_.dt_s);
        if (obstacles_.empty()) return;
        obstacles_.move();
        obstacles_.contact(start_.marbles.position(), start_.marbles.velocity(), size(),
                           WholeStep{start_.dt_s});
        obstacles_.finish(size());
    }
    //! [marble_step]

    /// @throws course::Unstable naming the step, the marble, and the likely cause
    void check_state(int step) {
        // An obstacle that moves brings energy of its own; at rest it can only take.
        double moving_J = 0;
        for (int k = 0; k < obstacles_.size(); ++k) {
            const double u = glm::length(obstacles_.motion(k).velocity_m_per_s);
            moving_J += 2 * size() * particle_mass_kg() * u * u;
        }
        most_J_ = std::max(most_J_, start_J_ + moving_J);
        spring_mass::check_state(start_.marbles, summarize_(start_.marbles), most_J_, step, start_.dt_s);
    }

    const spring_mass::Marbles& marbles() const { return start_.marbles; }
    ObstacleSet& obstacles() { return obstacles_; }
    const ObstacleSet& obstacles() const { return obstacles_; }
    const float4* position() const { return marbles().position(); }
    const float4* velocity() const { return marbles().velocity(); }
    std::uint32_t size() const { return start_.marbles.size(); }
    float dt_s() const { return start_.dt_s; }
    double particle_mass_kg() const { return start_.marbles.material().mass_kg; }
    static constexpr int kStepsPerFrame = 20;  // springs want short steps
    double duration_s() const { return settings_.scene.duration_s / settings_.speed; }
    interop::TankScene view() const {
        const spring_mass::Box& tank = settings_.scene.marbles.tank;
        interop::TankScene view;
        view.tank = {spring_mass::as_vec3(tank.low_m), spring_mass::as_vec3(tank.high_m)};
        view.radius_m = 0.5f * start_.marbles.material().diameter_m;
        view.white_at_m_per_s = 3;
        return view;
    }

  private:
    static spring_mass::Settings marble_settings(const MarbleSettings& settings) {
        spring_mass::Settings marbles;
        marbles.scene = settings.scene.marbles;
        marbles.particles = settings.particles;
        marbles.dt_s = settings.dt_s;
        marbles.seed = settings.seed;
        return marbles;
    }
    static ObstacleSet make_obstacles(const MarbleSettings& settings, const spring_mass::Start& start) {
        const spring_mass::Material& material = start.marbles.material();
        Setting setting;
        setting.particles = start.marbles.size();
        setting.particle_mass_kg = material.mass_kg;
        setting.gap_m = 0.5f * material.diameter_m;
        setting.low_m = spring_mass::as_vec3(settings.scene.marbles.tank.low_m);
        setting.high_m = spring_mass::as_vec3(settings.scene.marbles.tank.high_m);
        setting.gravity_m_per_s2 = material.gravity_m_per_s2;
        setting.dt_s = start.dt_s;
        // A push by a tenth of a diameter in a step is what the springs are made for.
        setting.fastest_m_per_s = 0.1 * material.diameter_m / start.dt_s;
        setting.why_fastest = "a tenth of a marble in a step, which is as far as its springs may be pressed";
        std::vector<Obstacle> obstacles = settings.scene.obstacles;
        for (Obstacle& o : obstacles) o.path = faster(o.path, settings.speed);
        if (settings.control == Control::hand && !obstacles.empty()) obstacles[0].control = Control::hand;
        return ObstacleSet(obstacles, setting);
    }

    MarbleSettings settings_;
    spring_mass::Start start_;
    ObstacleSet obstacles_;
    spring_mass::Summarizer summarize_{start_.marbles.size()};
    double start_J_ = 0, most_J_ = -1e300;
};

}  // namespace obstacles
