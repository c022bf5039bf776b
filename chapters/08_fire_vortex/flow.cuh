/// @file
/// The flow that carries everything in the fire: what the vortons stir, the wind, and the way round the ball.
#pragma once
#include "07_fire_particles/wind.h"
#include "08_fire_vortex/ball.cuh"
#include "08_fire_vortex/velocity_grid.cuh"

namespace vortex {

//! [Flow]
/// Passed to kernels by value.
struct Flow {
    const float4* field;  ///< of a VelocityGrid
    CellGrid grid;
    fire::Wind wind;
    float time_s = 0;
    Ball ball;
    float mirror_m = 0;  ///< the ground y = 0 is a mirror for what is nearer to it than this; 0: no ground

    __host__ __device__ glm::vec3 without_ball(glm::vec3 x_m) const {
        glm::vec3 u = xyz(sample(field, grid, x_m)) + fire::wind_at(wind, x_m, time_s);
        if (mirror_m > 0 && x_m.y < mirror_m) u += from_below(x_m);
        return u;
    }

    //! [mirror]
    /// No gas goes through the ground: as if under it, upside down, the same vortons turned the other way
    /// round. What they do at x is what the real ones do at x's mirror image, mirrored; so the grid has it
    /// already. With the distance from the ground this fades, so that the grid need not reach far below.
    __host__ __device__ glm::vec3 from_below(glm::vec3 x_m) const {
        const glm::vec3 u = xyz(sample(field, grid, {x_m.x, -x_m.y, x_m.z}));
        const float part = fminf(1.0f, 1 - x_m.y / mirror_m);
        return part * glm::vec3(u.x, -u.y, u.z);
    }
    //! [mirror]

    /// Velocity in m/s. Without a ball nothing of it is computed.
    template <bool kBall>
    __host__ __device__ glm::vec3 at(glm::vec3 x_m) const {
        const glm::vec3 u = without_ball(x_m);
        if constexpr (!kBall) return u;
        if (distance_m(ball, x_m) <= 0) return ball.velocity_m_per_s;  // taken along, until push_out()
        return u + round_the_ball(ball, without_ball(ball.centre_m) - ball.velocity_m_per_s, x_m);
    }

    /// Mean velocity over dt of something that goes with the flow: the midpoint method, so that a spark in a
    /// vortex circles in it. Euler's method would fling it out.
    template <bool kBall>
    __host__ __device__ glm::vec3 along_path(glm::vec3 x_m, float dt_s) const {
        return at<kBall>(x_m + 0.5f * dt_s * at<kBall>(x_m));
    }
};
//! [Flow]

}  // namespace vortex
