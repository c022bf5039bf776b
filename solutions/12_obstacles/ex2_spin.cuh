// Exercise 12.2: a ball that spins.
//
// The chapter's free obstacles do not turn. A rough ball does: where a particle touches it, its surface moves
// with the ball *and* with its spin, and the friction that slows the particle makes the ball turn.
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "12_obstacles/contact.cuh"
#include "common/todo.h"

namespace obstacles {

struct SpinningBall {
    glm::vec3 middle_m{0}, velocity_m_per_s{0};
    glm::vec3 spin_rad_per_s{0};  // along its axis; counterclockwise seen from the axis's tip
    float radius_m = 0.1f, mass_kg = 1;
    Surface surface;
};

// Resistance of a solid ball to being spun, in kg m^2: 2/5 of its mass times its radius squared.
inline float moment_of_inertia(const SpinningBall& ball) {
    return 0.4f * ball.mass_kg * ball.radius_m * ball.radius_m;
}

// Velocity in m/s of the ball's material at x.
inline glm::vec3 surface_velocity(const SpinningBall& ball, glm::vec3 x) {
    // TODO(12.2): the ball's own velocity, and that of turning about its middle. 1 line.
    // <solution>
    return ball.velocity_m_per_s + glm::cross(ball.spin_rad_per_s, x - ball.middle_m);
    // <stub>
    //| (void)ball, (void)x;
    //| return glm::vec3(course::kTodo);
    // </solution>
}

// A particle at x, on the ball's surface, meets it. Changes the particle's velocity v and the ball's velocity
// and spin, so that neither momentum nor angular momentum gets lost.
inline void spinning_bounce(SpinningBall& ball, float particle_kg, glm::vec3 x, glm::vec3& v) {
    // TODO(12.2): bounce() does the particle, if you give it the surface's velocity, the normal, and the
    // share that a ball of this mass leaves: M / (M + m). What the particle loses of its momentum the ball
    // gets, at x: it moves the ball, and turns it about its middle. About 6 lines.
    // <solution>
    const glm::vec3 arm = x - ball.middle_m;
    const float share = ball.mass_kg / (ball.mass_kg + particle_kg);
    const glm::vec3 after = bounce(v, surface_velocity(ball, x), arm / glm::length(arm), ball.surface, share);
    const glm::vec3 impulse = particle_kg * (v - after);
    ball.velocity_m_per_s += impulse / ball.mass_kg;
    ball.spin_rad_per_s += glm::cross(arm, impulse) / moment_of_inertia(ball);
    v = after;
    // <stub>
    //| (void)ball, (void)particle_kg, (void)x;
    //| v = glm::vec3(course::kTodo);
    // </solution>
}

}  // namespace obstacles
