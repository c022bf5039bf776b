/// @file
/// A ball in chapter 07's campfire: the same obstacles, in particles that know nothing of each other.
#pragma once
#include <memory>

#include "07_fire_particles/fire_view.cuh"
#include "12_obstacles/scene.cuh"

namespace obstacles {

/// A fire with obstacles: spheres, which is all that the fire's stage can show.
struct FireObstacles {
    fire::FireScene fire;
    std::vector<Obstacle> obstacles;
    double duration_s = 2;
};

//! [flame_scene]
/// A ball is lowered into the campfire, and swings there.
inline FireObstacles flame_around_ball(std::uint32_t particles, std::uint64_t seed) {
    FireObstacles scene{fire::make_scene("campfire", particles, seed), {}};
    scene.fire.name = "flame_around_ball";
    Obstacle ball;
    ball.solid = sphere(0.14f);
    ball.path.start_m = {0, 1.3, 0};
    ball.path.legs.push_back({0.7, {0, 0, 0}});  // until the fire has grown
    go(ball.path, {0, -0.8, 0}, 0.9);
    for (const double way_m : {0.2, -0.4, 0.4}) go(ball.path, {way_m, 0, 0}, 0.7);
    scene.obstacles = {ball};
    // The stage's last solid is the ball: a rod that is as good as without length.
    scene.fire.stage.rods.push_back({glm::vec3(0), glm::vec3(0), ball.solid.half_size_m.x, fire::Rod::wood});
    scene.fire.lights[1].position_m = {0.05f, 0.22f, 0.20f};  // not inside the ball
    scene.fire.view.distance_m = 2.5f;
    scene.duration_s = ball.path.duration_s();
    return scene;
}
//! [flame_scene]

/// Half a millimetre: a flame has no size, but its sprite is not to start inside the ball.
constexpr float kFlameGap_m = 5e-4f;

/// Flames and what is in their way. Where the particles lie is the caller's business: in OpenGL's memory when
/// they are drawn, in the device's when only numbers are wanted.
class FireRun {
  public:
    FireRun(const FireObstacles& scene, double speed)
        : scene_(scene), obstacles_(make_obstacles(scene, speed)) {}

    //! [fire_step]
    /// One step of the flames, and then those that met an obstacle. A flame that was born in this step has
    /// come only as far as its age allows.
    void step(fire::FlameArrays flames) {
        const float time_s = float(steps_++ * double(scene_.fire.dt_s));
        fire::launch_flame_step(flames, scene_.fire.fire, scene_.fire.curl, time_s, scene_.fire.dt_s);
        if (obstacles_.empty()) return;
        obstacles_.move();
        obstacles_.contact(flames.position, flames.velocity, fire::particle_count(scene_.fire.fire),
                           SinceBirth{scene_.fire.dt_s});
    }
    //! [fire_step]

    ObstacleSet& obstacles() { return obstacles_; }
    const ObstacleSet& obstacles() const { return obstacles_; }
    const fire::FireScene& fire() const { return scene_.fire; }

  private:
    static ObstacleSet make_obstacles(const FireObstacles& scene, double speed) {
        Setting setting;
        setting.particles = fire::particle_count(scene.fire.fire);
        setting.gap_m = kFlameGap_m;
        setting.dt_s = scene.fire.dt_s;
        setting.fastest_m_per_s = 34;
        setting.why_fastest =
            "a tenth of the speed of sound in air, beyond which air would be pressed together";
        std::vector<Obstacle> obstacles = scene.obstacles;
        for (Obstacle& o : obstacles) o.path = faster(o.path, speed);
        return ObstacleSet(obstacles, setting);
    }

    FireObstacles scene_;
    ObstacleSet obstacles_;
    std::uint64_t steps_ = 0;
};

/// Puts the stage's last rod where the ball is.
inline void place_ball(fire::Stage& stage, glm::vec3 middle_m) {
    fire::Rod& last = stage.rods.back();
    last.from_m = middle_m - glm::vec3(0, 5e-4f, 0);
    last.to_m = middle_m + glm::vec3(0, 5e-4f, 0);
}

}  // namespace obstacles
