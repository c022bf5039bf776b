/// @file
/// The water's motion, by chapter 09's model or chapter 10's, as pictures need it: particles, and one step
/// more.
#pragma once
#include <memory>
#include <optional>

#include "09_water_spring_mass/run.cuh"
#include "15_water_rendering/scene.cuh"

namespace water {

enum class Model { sph, marbles };

/// A run of one scene. Arrays are in device memory.
class Run {
  public:
    virtual ~Run() = default;
    virtual void step() = 0;
    virtual const float4* position() const = 0;
    virtual const float4* velocity() const = 0;
    virtual std::uint32_t size() const = 0;
    /// @throws course::Unstable naming the step, the particle, and the likely cause
    virtual void check(int step) = 0;
    virtual Ball ball() const { return {}; }
    /// The ball follows a hand, as fast as the water allows.
    virtual void lead_ball(glm::vec3 /*to_m*/) {}

    float spacing_m = 0, dt_s = 0;
    double white_m_per_s = 3;  ///< speed at which spheres and points are white
};

//! [pump]
/// One thread per particle: what is in the pump's throat rises at least as fast as the pump says.
inline __global__ void pump_kernel(float4* velocity, const float4* position, Pump pump, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 off = grid::xyz(position[i]) - pump.middle_m;
    if (off.x * off.x + off.z * off.z > pump.radius_m * pump.radius_m) return;
    if (off.y < 0 || off.y > pump.height_m) return;
    velocity[i].y = fmaxf(velocity[i].y, pump.speed_m_per_s);
}

/// The pump as a guest of chapter 10's water.
struct PumpGuest {
    Pump pump;
    void after_drift(sph::WaterArrays a) {
        constexpr std::uint32_t kThreads = 128;
        if (pump.radius_m == 0 || a.n == 0) return;
        pump_kernel<<<grid::blocks_for(a.n, kThreads), kThreads>>>(a.velocity, a.position, pump, a.n);
        CUDA_CHECK(cudaGetLastError());
    }
    void after_density(sph::WaterArrays) {}
};
//! [pump]

inline float3 as_float3(glm::vec3 x) {
    return {x.x, x.y, x.z};
}

/// Chapter 10's water.
class SphRun : public Run {
  public:
    SphRun(const WaterScene& scene, const Start& start, float wanted_dt_s)
        : guest_{scene.pump}, water_(make_water(scene, start)), summarize_(water_.size()) {
        spacing_m = start.spacing_m;
        dt_s = wanted_dt_s > 0 ? wanted_dt_s : sph::time_step_limit(water_.fluid()).smallest_s();
        white_m_per_s = 1.1 * water_.fluid().sound_speed_m_per_s / 6 * 1.4142;
    }
    void step() override {
        if (guest_.pump.radius_m > 0)
            water_.step(dt_s, guest_);
        else
            water_.step(dt_s);  // not even a guest
    }
    const float4* position() const override { return water_.position(); }
    const float4* velocity() const override { return water_.velocity(); }
    std::uint32_t size() const override { return water_.size(); }
    void check(int step) override { sph::check_state(water_, summarize_(water_), step, dt_s); }

  private:
    static sph::Water make_water(const WaterScene& scene, const Start& start) {
        const sph::Box tank{as_float3(scene.stage.tank_low_m), as_float3(scene.stage.tank_high_m)};
        float top_m = 0, fastest = 0;
        for (const Body& body : scene.bodies) {
            top_m = std::max(top_m, body.low_m.y + body.size_m.y);
            fastest = std::max(fastest, std::max(body.falls_m_per_s, scene.pump.speed_m_per_s));
        }
        top_m += fastest * fastest / (2 * 9.81f);  // as high as that speed would throw it
        sph::Fluid fluid = sph::make_fluid({scene.name, tank, {0, 0, 0}, {1, top_m, 1}}, start.spacing_m);
        return {fluid, tank, sph::EquationOfState::linear, start.position, start.velocity};
    }

    PumpGuest guest_;
    sph::Water water_;
    sph::Summarizer summarize_;
};

/// Chapter 09's marbles: smooth ones, which run like water.
class MarbleRun : public Run {
  public:
    MarbleRun(const WaterScene& scene, const Start& start, float wanted_dt_s)
        : marbles_(make_marbles(scene, start)), summarize_(marbles_.size()) {
        spacing_m = start.spacing_m;
        const float limit_s = spring_mass::time_step_limit_s(marbles_.material());
        dt_s = wanted_dt_s > 0 ? wanted_dt_s : spring_mass::kStepInLimits * limit_s;
        start_J_ = summarize_(marbles_).energy_J();
    }
    void step() override { marbles_.step(dt_s); }
    const float4* position() const override { return marbles_.position(); }
    const float4* velocity() const override { return marbles_.velocity(); }
    std::uint32_t size() const override { return marbles_.size(); }
    void check(int step) override {
        spring_mass::check_state(marbles_, summarize_(marbles_), start_J_, step, dt_s);
    }

  private:
    static spring_mass::Marbles make_marbles(const WaterScene& scene, const Start& start) {
        spring_mass::Scene like = spring_mass::find_scene(spring_mass::all_scenes(), "dam_break");
        like.tank = {as_float3(scene.stage.tank_low_m), as_float3(scene.stage.tank_high_m)};
        return {spring_mass::make_material(like, start.spacing_m), like.tank, start.position, start.velocity};
    }
    spring_mass::Marbles marbles_;
    spring_mass::Summarizer summarize_;
    double start_J_ = 0;
};

/// Chapter 12's water with a ball in it, which follows a hand.
class BallRun : public Run {
  public:
    BallRun(const WaterScene& scene, std::uint32_t particles, float wanted_dt_s, std::uint64_t seed)
        : run_(settings(scene, particles, wanted_dt_s, seed)), radius_m_(scene.stage.ball.radius_m) {
        spacing_m = run_.spacing_m();
        dt_s = run_.dt_s();
        white_m_per_s = run_.view().white_at_m_per_s;
        lead_ball(scene.stage.ball.middle_m);
    }
    void step() override { run_.step(); }
    const float4* position() const override { return run_.position(); }
    const float4* velocity() const override { return run_.velocity(); }
    std::uint32_t size() const override { return run_.size(); }
    void check(int step) override { run_.check_state(step); }
    Ball ball() const override { return {glm::vec3(run_.obstacles().motion(0).position_m), radius_m_}; }
    void lead_ball(glm::vec3 to_m) override { run_.obstacles().lead(0, glm::dvec3(to_m)); }

  private:
    static obstacles::WaterSettings settings(const WaterScene& scene, std::uint32_t particles, float dt_s,
                                             std::uint64_t seed) {
        const Body& block = scene.bodies.front();
        obstacles::WaterSettings s;
        s.scene.water = {scene.name,
                         {as_float3(scene.stage.tank_low_m), as_float3(scene.stage.tank_high_m)},
                         as_float3(block.low_m),
                         as_float3(block.size_m)};
        obstacles::Obstacle ball;
        ball.solid = obstacles::sphere(scene.stage.ball.radius_m);
        ball.path.start_m = glm::dvec3(scene.stage.ball.middle_m);
        s.scene.obstacles = {ball};
        s.control = obstacles::Control::hand;
        s.particles = particles;
        s.dt_s = dt_s;
        s.seed = seed;
        return s;
    }
    obstacles::WaterRun run_;
    float radius_m_;
};

/// @throws course::BadInput if the model can't do the scene
inline std::unique_ptr<Run> make_run(const WaterScene& scene, Model model, std::uint32_t particles,
                                     float dt_s, std::uint64_t seed) {
    const bool plain = scene.stage.ball.radius_m == 0 && scene.pump.radius_m == 0;
    if (model == Model::marbles && !plain)
        throw course::BadInput("--model marbles knows neither pump nor ball: take dam_break or drop");
    if (scene.stage.ball.radius_m > 0) return std::make_unique<BallRun>(scene, particles, dt_s, seed);
    const Start start = fill(scene, particles, seed);
    if (model == Model::marbles) return std::make_unique<MarbleRun>(scene, start, dt_s);
    return std::make_unique<SphRun>(scene, start, dt_s);
}

}  // namespace water
