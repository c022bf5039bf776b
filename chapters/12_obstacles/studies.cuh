/// @file
/// Studies `bounce` and `skin`; stability maps `tunnel` and `push`.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "10_water_sph/stability_maps.cuh"
#include "10_water_sph/study_water.cuh"
#include "12_obstacles/end_of_step.cuh"
#include "12_obstacles/scene.cuh"
#include "common/gpu_timer.h"
#include "common/program.h"

namespace obstacles {

enum class Test { swept, end_of_step };

inline void launch_test(Test test, float4* position, float4* velocity, ObstacleSet& obstacles,
                        std::uint32_t n) {
    if (test == Test::swept) return obstacles.contact(position, velocity, n, WholeStep{obstacles.now().dt_s});
    end_of_step_kernel<<<patterns::blocks_for(n, ObstacleSet::kThreads), ObstacleSet::kThreads>>>(
        position, velocity, obstacles.now(), n);
    CUDA_CHECK(cudaGetLastError());
}

/// One thread per particle: nothing acts on it.
inline __global__ void fly_kernel(float4* position, const float4* velocity, float dt_s, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = grid::xyz(position[i]) + dt_s * grid::xyz(velocity[i]);
    position[i] = make_float4(x.x, x.y, x.z, position[i].w);
}

// ---------------------------------------------------------------------------------------------- bounce

/// A ball that starts to move, and a shower of particles that it meets: where should each of them be at the
/// end? Between its contact and the end a particle flies straight, so the only thing to find is the contact.
struct Shower {
    static constexpr std::uint32_t kParticles = 4096;
    static constexpr double kTime_s = 0.2;
    Obstacle ball;
    std::vector<float4> position, velocity;

    Shower() {
        ball.solid = sphere(0.1f);
        ball.surface.restitution = 1;
        ball.path.legs = {{kTime_s, {10, 0, 0}}};
        for (std::uint32_t i = 0; i < kParticles; ++i) {
            const auto random = r123::Philox4x32()({{i, 0, 0, 0}}, {{12, 0}});
            const auto unit = [&](int k) { return random[k] * 0x1p-32f; };
            position.push_back(
                make_float4(0.35f + 0.2f * unit(0), 0.12f * (2 * unit(1) - 1), 0.12f * (2 * unit(2) - 1), 0));
            velocity.push_back(make_float4(-2 - unit(3), 0, 0, 0));
        }
    }

    //! [shower_exact]
    /// The contact is where the distance along the particle's line first equals the radius: looked for in
    /// 4000 short pieces, then halved down to the last bit of a double.
    glm::dvec3 exact(std::uint32_t i) const {
        const glm::dvec3 x0 = grid::xyz(position[i]), v0 = grid::xyz(velocity[i]);
        const auto gap = [&](double t) {
            return glm::length(x0 + t * v0 - ball.path.at(t).position_m) - ball.solid.half_size_m.x;
        };
        double before = 0, after = 0;
        for (int k = 1; k <= 4000 && after == 0; ++k) {
            const double t = kTime_s * k / 4000;
            if (gap(t) < 0)
                after = t;
            else
                before = t;
        }
        if (after == 0) return x0 + kTime_s * v0;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (before + after);
            (gap(middle) < 0 ? after : before) = middle;
        }
        const Motion now = ball.path.at(before);
        const glm::dvec3 hit = x0 + before * v0, n = glm::normalize(hit - now.position_m);
        const glm::dvec3 v = v0 - 2 * glm::dot(v0 - now.velocity_m_per_s, n) * n;
        return hit + (kTime_s - before) * v;
    }
    //! [shower_exact]
};

inline void study_bounce(course::Study& study) {
    course::on_device(study);
    const Shower shower;
    const std::vector<int> steps =
        study.quick ? std::vector<int>{4, 16, 64} : std::vector<int>{2, 4, 8, 16, 32, 64, 128, 256, 512};
    study.expect(2 * int(steps.size()));
    std::vector<glm::dvec3> exact;
    for (std::uint32_t i = 0; i < Shower::kParticles; ++i) exact.push_back(shower.exact(i));
    for (const Test test : {Test::swept, Test::end_of_step})
        for (const int count : steps) {
            Setting setting;
            setting.particles = Shower::kParticles;
            setting.dt_s = Shower::kTime_s / count;
            std::vector<float4> x;
            const auto run = [&] {
                ObstacleSet obstacles({shower.ball}, setting);
                course::DeviceBuffer<float4> position(shower.position), velocity(shower.velocity);
                for (int step = 0; step < count; ++step) {
                    fly_kernel<<<patterns::blocks_for(Shower::kParticles), patterns::kThreads>>>(
                        position.data(), velocity.data(), float(setting.dt_s), Shower::kParticles);
                    CUDA_CHECK(cudaGetLastError());
                    obstacles.move();
                    launch_test(test, position.data(), velocity.data(), obstacles, Shower::kParticles);
                }
                x = position.download();
            };
            const course::Timing timing = course::time_work(study.quick ? 3 : 7, run);
            double sum = 0;
            for (std::uint32_t i = 0; i < Shower::kParticles; ++i) {
                const double off = glm::length(glm::dvec3(grid::xyz(x[i])) - exact[i]);
                sum += off * off;
            }
            study.add({test == Test::swept ? "swept" : "end of the step", setting.dt_s,
                       double(Shower::kParticles), std::sqrt(sum / Shower::kParticles), timing.per(count),
                       double(count)});
        }
}

// ------------------------------------------------------------------------------------------------ skin

/// A ball held under water that has come to rest: what Archimedes knows about it.
struct StillTank {
    double buoyancy = 0;  ///< measured force upwards / weight of the water in the ball's place
    double layer = 0;     ///< mass of water within one support of the ball / what belongs there
    std::uint32_t particles = 0;
    course::Timing per_step;
};

//! [still_tank]
inline StillTank still_tank(Skin skin, std::uint32_t particles, double settle_s, double look_s) {
    const sph::Scene scene{"still", {{0, 0, 0}, {0.4f, 0.6f, 0.4f}}, {0, 0, 0}, {0.4f, 0.4f, 0.4f}};
    Obstacle ball;
    ball.solid = sphere(0.1f);
    ball.path.start_m = {0.2, 0.2, 0.2};
    float spacing_m = 0;
    std::vector<float4> position;
    for (const float4& x : sph::fill_block(scene, particles, 1, spacing_m))
        if (signed_distance(ball.solid, grid::xyz(x) - glm::vec3(ball.path.start_m)) >= 0.5f * spacing_m)
            position.push_back(x);
    sph::FluidChoice calm;
    calm.viscosity = 3;  // it comes to rest sooner
    const sph::Fluid fluid = sph::make_fluid(scene, spacing_m, calm);
    sph::Water water(fluid, scene.tank, sph::EquationOfState::linear, position,
                     sph::at_rest(position.size()));
    Setting setting;
    setting.particles = water.size();
    setting.particle_mass_kg = fluid.mass_kg;
    setting.gap_m = 0.5f * spacing_m;
    setting.low_m = {0, 0, 0};
    setting.high_m = {0.4f, 0.6f, 0.4f};
    setting.dt_s = sph::time_step_limit(fluid).smallest_s();
    setting.measure_forces = true;
    ObstacleSet obstacles({ball}, setting);

    for (int step = 0; step * setting.dt_s < settle_s; ++step) obstacles::step(water, obstacles, skin);
    StillTank seen;
    seen.particles = water.size();
    double upwards = 0, layer_kg = 0;
    int steps = 0;
    seen.per_step = course::time_work(5, [&] {
        for (int step = 0; step < 4; ++step) obstacles::step(water, obstacles, skin);
    });
    seen.per_step = seen.per_step.per(4);
    for (; steps * setting.dt_s < look_s; ++steps) {
        obstacles::step(water, obstacles, skin);
        upwards += obstacles.impulse(0).y;
        if (steps % 10 != 0) continue;
        for (const float4& x : water.positions().download())
            if (signed_distance(ball.solid, grid::xyz(x) - glm::vec3(ball.path.start_m)) < fluid.support_m)
                layer_kg += 10.0 * fluid.mass_kg;
    }
    const double r = ball.solid.half_size_m.x, far = r + fluid.support_m, rho = fluid.rest_density_kg_per_m3;
    seen.buoyancy = upwards / (steps * setting.dt_s) / (rho * 9.81 * volume_m3(ball.solid));
    seen.layer = layer_kg / steps / (rho * 4.1887902047863905 * (far * far * far - r * r * r));
    return seen;
}
//! [still_tank]

inline void study_skin(course::Study& study) {
    course::on_device(study);
    const std::vector<std::uint32_t> sizes = study.quick
                                                 ? std::vector<std::uint32_t>{512, 1000, 1728}
                                                 : std::vector<std::uint32_t>{512, 1000, 1728, 4096, 8000};
    study.expect(2 * int(sizes.size()));
    for (const Skin skin : {Skin::ghost, Skin::bare})
        for (const std::uint32_t particles : sizes) {
            const StillTank seen =
                still_tank(skin, particles, study.quick ? 0.6 : 1, study.quick ? 0.3 : 0.5);
            study.add({skin == Skin::ghost ? "ghost water" : "bare", double(seen.particles),
                       double(seen.particles), std::abs(seen.buoyancy - 1), seen.per_step, 1});
        }
}

// ---------------------------------------------------------------------------------------------- tunnel

//! [tunnel]
/// A thin plate sweeps through a cloud at rest. Holds if nobody is left behind it.
inline bool nobody_gets_through(Test test, double speed_m_per_s, double dt_s) {
    constexpr std::uint32_t kParticles = 512;
    Obstacle plate;
    plate.solid = box({0.01f, 0.5f, 0.5f});
    plate.path.start_m = {-0.1, 0, 0};
    plate.path.start_velocity_m_per_s = {speed_m_per_s, 0, 0};
    std::vector<float4> x;
    for (std::uint32_t i = 0; i < kParticles; ++i)
        x.push_back(
            make_float4((i + 0.5f) / kParticles, 0.4f * std::sin(1.0f + i), 0.4f * std::cos(3.0f * i), 0));
    Setting setting;
    setting.particles = kParticles;
    setting.dt_s = dt_s;
    ObstacleSet obstacles({plate}, setting);
    course::DeviceBuffer<float4> position(x), velocity(sph::at_rest(kParticles));
    const int steps = int(std::ceil(1.3 / (speed_m_per_s * dt_s)));
    for (int step = 0; step < steps; ++step) {
        fly_kernel<<<patterns::blocks_for(kParticles), patterns::kThreads>>>(position.data(), velocity.data(),
                                                                             float(dt_s), kParticles);
        CUDA_CHECK(cudaGetLastError());
        obstacles.move();
        launch_test(test, position.data(), velocity.data(), obstacles, kParticles);
    }
    for (const float4& p : position.download())
        if (!(p.x > obstacles.motion(0).position_m.x)) return false;
    return true;
}
//! [tunnel]

inline void map_tunnel(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<double> speeds =
        map.quick ? std::vector<double>{1, 100} : std::vector<double>{0.1, 1, 10, 100, 1000, 1e6};
    map.expect(2 * int(speeds.size()));
    for (const double speed : speeds) {
        const double theory_s = 0.01 / speed;  // half the plate
        map.column("end of the step", speed, theory_s, {0.25, 0.5, 0.7, 0.9, 0.98, 1.02, 1.1, 1.5, 2, 4}, 3,
                   [&](double dt_s) { return nobody_gets_through(Test::end_of_step, speed, dt_s); });
        map.column("swept", speed, theory_s, {0.5, 0.98, 1.02, 2, 4, 10, 30, 100, 300, 900}, 3,
                   [&](double dt_s) { return nobody_gets_through(Test::swept, speed, dt_s); });
    }
}

// ------------------------------------------------------------------------------------------------ push

//! [push]
/// A box is pushed through a pool at a part of the speed of sound, from rest and back to rest. Holds if the
/// water stays water.
inline bool water_stays_water(Skin skin, double speed_per_sound, double dt_s, std::uint32_t particles) {
    WaterSettings settings;
    settings.scene.water = {"pool", {{0, 0, 0}, {0.9f, 1.2f, 0.3f}}, {0, 0, 0}, {0.9f, 0.2f, 0.3f}};
    settings.particles = particles;
    settings.dt_s = float(dt_s);
    settings.skin = skin;
    settings.fastest_per_sound = 2;
    Obstacle plunger;
    plunger.solid = box({0.06f, 0.06f, 0.09f});
    plunger.path.start_m = {0.2, 0.29, 0.15};
    settings.scene.obstacles = {plunger};
    const double sound = WaterRun(settings).water().fluid().sound_speed_m_per_s,
                 speed = speed_per_sound * sound;
    Path& path = settings.scene.obstacles[0].path;
    go(path, {0, -0.15, 0}, 0.4);  // gently into the water, then along it
    const double ramp_s = 0.04, cruise_s = std::max(0.0, (0.4 - speed * ramp_s) / speed);
    path.legs.push_back({ramp_s, {speed / ramp_s, 0, 0}});
    path.legs.push_back({cruise_s, {0, 0, 0}});
    path.legs.push_back({ramp_s, {-speed / ramp_s, 0, 0}});
    WaterRun run(settings);
    const int steps = int((path.duration_s() + 0.1) / run.dt_s());
    try {
        for (int step = 1; step <= steps; ++step) {
            run.step();
            if (step % 5 == 0) run.check_state(step);
        }
    } catch (const course::Unstable&) {
        return false;
    }
    return true;
}
//! [push]

inline void map_push(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<double> speeds =
        map.quick ? std::vector<double>{0.1, 0.3} : std::vector<double>{0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0};
    const std::uint32_t particles = map.quick ? 400 : 800;
    map.expect(2 * int(speeds.size()));
    for (const Skin skin : {Skin::ghost, Skin::bare})
        for (const double speed : speeds) {
            WaterSettings settings;
            settings.scene.water = {"pool", {{0, 0, 0}, {0.9f, 1.2f, 0.3f}}, {0, 0, 0}, {0.9f, 0.2f, 0.3f}};
            settings.particles = particles;
            const WaterRun still(settings);
            const sph::Fluid& fluid = still.water().fluid();
            const double c = fluid.sound_speed_m_per_s,
                         theory_s = sph::kLatticeSoundLimit * fluid.support_m / c;
            map.column(skin == Skin::ghost ? "ghost water" : "bare", speed, theory_s,
                       map.quick ? std::vector<double>{0.2, 0.4, 0.8, 1.1}
                                 : std::vector<double>{0.05, 0.2, 0.4, 0.6, 0.8, 1.0},
                       map.quick ? 1 : 2,
                       [&](double dt_s) { return water_stays_water(skin, speed, dt_s, particles); });
        }
}

inline void declare_studies(course::Program& program) {
    program.study({"bounce", "Which test for contact needs the least time for a bounce in the right place?",
                   "place after 0.2 s: rms distance from the exact one (m)", "dt_s"},
                  study_bounce);
    program.study({"skin", "What must water feel of an obstacle for the obstacle to float as it should?",
                   "buoyancy: relative difference from Archimedes", "n"},
                  study_skin);
    program.stability({"tunnel", "How far may an obstacle move in a step before particles get through it?",
                       "no particle is behind a plate of 2 cm that has swept through 512 of them",
                       "end of the step: half the plate / speed, where the nearer face is the wrong one. The "
                       "swept test has no limit; it is tried up to 900 times that",
                       "speed of the plate (m/s)"},
                      map_tunnel);
    program.stability(
        {"push", "How fast may an obstacle push water, and with which step?",
         "no particle is as fast as sound or twice as dense as at rest",
         "chapter 10: sound in a lattice at rest, 0.985 h / c", "speed of the box / speed of sound"},
        map_push);
}

}  // namespace obstacles
