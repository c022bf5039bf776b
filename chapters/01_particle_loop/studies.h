/// @file
/// What this chapter measures: what a smaller time step buys and what it costs, in float and in double; the
/// two layouts; and the largest time step that is stable.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "01_particle_loop/scenes.h"
#include "01_particle_loop/stopwatch.h"
#include "common/study.h"

namespace particle_loop {

// ---------------------------------------------------------------------------------- error against run time

/// Height after t seconds by the formula, in double precision (the README derives it).
inline double exact_height_m(const Fountain& f, double y0_m, double vy_m_per_s, double t_s) {
    const double k = f.drag_per_s, g = f.gravity_m_per_s2;
    if (k == 0) return y0_m + vy_m_per_s * t_s - 0.5 * g * t_s * t_s;
    return y0_m + (vy_m_per_s + g / k) * -std::expm1(-k * t_s) / k - g / k * t_s;
}

//! [move_in_double]
/// The same step with twice the digits, in free air. What it and `move` differ in is rounding.
inline void move_in_double(const Fountain& fountain, glm::dvec3& position, glm::dvec3& velocity) {
    const double dt = fountain.dt_s, g = fountain.gravity_m_per_s2, k = fountain.drag_per_s;
    velocity += dt * (glm::dvec3(0, -g, 0) - k * velocity);
    position += dt * velocity;
}
//! [move_in_double]

/// One second of free flight of some droplets, in `steps` steps: adds the largest error of a height.
/// @param start_m height at the start, high enough that no droplet meets the floor
template <class Vec, class Move>
void add_flight(course::Study& study, const std::string& method, double start_m, int steps, Move&& move_one) {
    constexpr int kDroplets = 64;
    struct Droplet {
        Vec position_m, velocity_m_per_s;
    };
    Fountain fountain = make_scene("crown");
    fountain.dt_s = 1.0f / float(steps);
    std::vector<Droplet> start, droplets;
    for (int i = 0; i < kDroplets; ++i) {
        Particle p;
        emit(fountain, random_start(fountain.seed, i, 0), p.position_m, p.velocity_m_per_s);
        start.push_back({Vec(0, start_m, 0), Vec(p.velocity_m_per_s)});
    }
    const int flights =
        std::max(1, 200000 / (steps * kDroplets));  // so many that the clock's own cost vanishes
    const course::Timing timing = course::time_work(study.quick ? 3 : 9, [&] {
        for (int k = 0; k < flights; ++k) {
            droplets = start;
            for (int s = 0; s < steps; ++s)
                for (Droplet& d : droplets) move_one(fountain, d.position_m, d.velocity_m_per_s);
        }
    });
    double error_m = 0;
    for (int i = 0; i < kDroplets; ++i) {
        const double exact_m = exact_height_m(fountain, start_m, start[i].velocity_m_per_s.y, 1.0);
        error_m = std::max(error_m, std::abs(double(droplets[i].position_m.y) - exact_m));
    }
    study.add(
        {method, fountain.dt_s, kDroplets, error_m, timing.per(double(flights) * steps), double(steps)});
}

inline void study_time_step(course::Study& study) {
    // Powers of two: 1 / steps is exact in a float, and the sum of the steps is one second to the last bit.
    const std::vector<int> steps{1 << 5, 1 << 7, 1 << 9, 1 << 11, 1 << 13, 1 << 15, 1 << 17, 1 << 19};
    study.expect(3 * int(steps.size()));
    const auto move_in_float = [](const Fountain& f, glm::vec3& x, glm::vec3& v) { move(f, x, v); };
    for (const int s : steps) add_flight<glm::vec3>(study, "near the ground, float", 20, s, move_in_float);
    for (const int s : steps) add_flight<glm::dvec3>(study, "near the ground, double", 20, s, move_in_double);
    for (const int s : steps) add_flight<glm::vec3>(study, "10 km up, float", 1e4, s, move_in_float);
}

// ------------------------------------------------------------------------------------------------- layouts

/// One size of both layouts: a step, and a question that needs one of six numbers.
inline void add_layouts(course::Study& study, std::uint32_t n) {
    const Fountain fountain = make_scene("crown");
    std::vector<Particle> aos(n);
    ParticleArrays soa(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        emit(fountain, random_start(fountain.seed, i, 0), aos[i].position_m, aos[i].velocity_m_per_s);
        soa.store(i, aos[i]);
    }
    const int calls = std::max(1u, 200000u / n);  // so many at once that the clock's own cost vanishes
    std::uint32_t s_aos = life_steps(fountain), s_soa = s_aos;  // from here on, all droplets are in flight
    // Counts at another height each time, and a sum that is used: else the compiler would do the work once,
    // or never.
    std::int64_t above_aos = 0, above_soa = 0;
    const std::vector<course::Timing> timings =
        by_turns(study.quick ? 7 : 15, {[&] {
                                            for (int k = 0; k < calls; ++k) step(aos, fountain, s_aos++);
                                        },
                                        [&] {
                                            for (int k = 0; k < calls; ++k) step(soa, fountain, s_soa++);
                                        },
                                        [&] {
                                            for (int k = 0; k < calls; ++k)
                                                above_aos += count_above(aos, n, 1e-3f * float(k));
                                        },
                                        [&] {
                                            for (int k = 0; k < calls; ++k)
                                                above_soa += count_above(soa, n, 1e-3f * float(k));
                                        }});
    int different = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Particle p = soa.load(i);
        different += std::memcmp(&p, &aos[i], sizeof p) != 0;
    }
    const double miscounted = double(std::abs(above_aos - above_soa));
    const auto add = [&](const std::string& method, const course::Timing& timing, double error) {
        study.add({method, double(n), double(n), error, timing.per(calls)});
    };
    add("step, array of structs", timings[0], different);
    add("step, struct of arrays", timings[1], different);
    add("count, array of structs", timings[2], miscounted);
    add("count, struct of arrays", timings[3], miscounted);
}

inline void study_layout(course::Study& study) {
    std::vector<std::uint32_t> sizes{1000, 10000, 100000, 1000000};
    if (!study.quick) sizes.push_back(4000000);
    study.expect(4 * int(sizes.size()));
    for (const std::uint32_t n : sizes) add_layouts(study, n);
}

// ----------------------------------------------------------------------------------------------- stability

/// Is a droplet that only drag acts on slower after 200 steps than it was?
inline bool drag_is_stable(float drag_per_s, float dt_s) {
    Fountain fountain = make_scene("crown");
    fountain.gravity_m_per_s2 = 0;
    fountain.drag_per_s = drag_per_s;
    fountain.dt_s = dt_s;
    Particle p{{0, 1, 0}, {1, 0, 0}};
    for (int s = 0; s < 200; ++s) move(fountain, p.position_m, p.velocity_m_per_s);
    return std::abs(p.velocity_m_per_s.x) < 1.0f;  // false for NaN, too
}

inline void map_drag(course::StabilityMap& map) {
    const std::vector<double> drags{0.35, 3.5, 35, 350, 3500, 35000};
    map.expect(int(drags.size()));
    for (const double drag_per_s : drags)
        map.column("semi-implicit Euler", drag_per_s, 2 / drag_per_s,
                   {0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 1.01, 1.1, 1.5, 2, 4}, map.quick ? 2 : 6,
                   [&](double dt_s) { return drag_is_stable(float(drag_per_s), float(dt_s)); });
}

}  // namespace particle_loop
