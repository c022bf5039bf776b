/// @file
/// A ball in the fire: it moves as it is told to, and gas and flames go round it. The ball feels nothing of
/// it.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace vortex {

struct Ball {
    glm::vec3 centre_m{0};
    float radius_m = 0;  ///< 0: there is none
    glm::vec3 velocity_m_per_s{0};
};

/// A ball that swings to and fro.
struct BallPath {
    glm::vec3 middle_m{0}, swing_m{0};
    float radius_m = 0, period_s = 1;

    Ball at(double time_s) const {
        const double turn = 6.283185307179586 / period_s, angle = turn * time_s;
        return {middle_m + float(std::sin(angle)) * swing_m, radius_m,
                float(turn * std::cos(angle)) * swing_m};
    }
};

/// Signed distance: below 0 inside the ball.
inline __host__ __device__ float distance_m(const Ball& ball, glm::vec3 x_m) {
    return glm::length(x_m - ball.centre_m) - ball.radius_m;
}

//! [round_the_ball]
/// What the ball adds to the velocity at x, outside of it, given the flow `past_m_per_s` past it (flow at its
/// centre minus its own velocity): the dipole that makes an even flow go round a sphere,
/// (R^3 / 2 r^3)(W - 3 (W.n) n). On the surface the normal parts of W and of the dipole cancel exactly.
inline __host__ __device__ glm::vec3 round_the_ball(const Ball& ball, glm::vec3 past_m_per_s, glm::vec3 x_m) {
    const float r = glm::length(x_m - ball.centre_m), shrink = ball.radius_m / r;
    const glm::vec3 n = (x_m - ball.centre_m) / r;
    return 0.5f * shrink * shrink * shrink * (past_m_per_s - 3 * glm::dot(past_m_per_s, n) * n);
}
//! [round_the_ball]

//! [push_out]
/// Takes what is inside the ball to its surface, along the gradient of the signed distance. From the very
/// centre every way is as short: up.
inline __host__ __device__ void push_out(const Ball& ball, glm::vec3& x_m) {
    if (!(distance_m(ball, x_m) < 0)) return;
    const glm::vec3 away = x_m - ball.centre_m;
    const float r = glm::length(away);
    x_m = ball.centre_m + ball.radius_m * (r > 0 ? away / r : glm::vec3(0, 1, 0));
}
//! [push_out]

}  // namespace vortex
