// Exercise 01.1: the exact step.
//
// Gravity and linear drag are simple enough to be solved by hand, so a step of any length can land exactly
// where the droplet would be. The chapter's README has the solution of the equation for a whole flight; a
// step is a short flight.
#pragma once
#include <cmath>

#include "01_particle_loop/particle_loop.h"
#include "common/todo.h"

namespace particle_loop {

// What a step of dt does to every droplet:
//     new velocity = keep * velocity + reach_s * gravity
//     new position = position + reach_s * velocity + fall_s2 * gravity
struct ExactStep {
    float keep;     // dimensionless
    float reach_s;  // dt, shortened by drag
    float fall_s2;  // dt^2 / 2, shortened by drag
};

inline ExactStep exact_step(float drag_per_s, float dt_s) {
    // TODO(1.1): the three factors. Mind drag 0, and drag that is nearly 0: a difference of two nearly equal
    // numbers has few digits left. About 6 lines.
    // <solution>
    const double k = drag_per_s, dt = dt_s, h = k * dt;
    if (h < 1e-6) return {float(1 - h), dt_s, float(0.5 * dt * dt)};  // what is left out is below h / 2
    const double reach_s = -std::expm1(-h) / k;
    return {float(std::exp(-h)), float(reach_s), float((dt - reach_s) / k)};
    // <stub>
    //| (void)drag_per_s, (void)dt_s;
    //| return {course::kTodo, course::kTodo, course::kTodo};
    // </solution>
}

// Moves a droplet in flight. (The floor stays as it is in move(); it is not asked for here.)
inline void move_exactly(const Fountain& fountain, const ExactStep& step, glm::vec3& position,
                         glm::vec3& velocity) {
    // TODO(1.1): use the three factors. About 3 lines.
    // <solution>
    const glm::vec3 gravity(0.0f, -fountain.gravity_m_per_s2, 0.0f);
    position += step.reach_s * velocity + step.fall_s2 * gravity;
    velocity = step.keep * velocity + step.reach_s * gravity;
    // <stub>
    //| (void)fountain, (void)step;
    //| position = velocity = glm::vec3(float(course::kTodo));
    // </solution>
}

}  // namespace particle_loop
