/// @file
/// How vortons live: carried by the flow, turned and stretched by it, driven by hot gas, dying away.
#pragma once
#include "08_fire_vortex/flow.cuh"

namespace vortex {

/// Everything that acts on a vorton, in numbers.
struct VortonPhysics {
    float core_m = 0.05f;
    float volume_m3 = 0;           ///< gas that one vorton stands for
    float decay_time_s = 1;        ///< strength falls by the factor e: what small eddies take away
    float cooling_time_s = 1;      ///< the same for the heat
    float max_turn_rad_per_s = 0;  ///< of a core: no vorton gets stronger than that
    bool stretching = true, baroclinic = true;
};

/// Vortons as two arrays. position: xyz in m, w = life that is left, s. strength: see SortedVortons.
struct VortonState {
    float4* position;
    float4* strength;
};

//! [strength_rate]
/// d(alpha)/dt of a vorton at x.
///
/// Stretching, (alpha . grad) u: a column of gas that is drawn out spins faster, one that is tilted tilts its
/// spin. Baroclinic source, V grad(b) x up: where hot gas stands beside cold gas, the hot side rises, the
/// cold one does not, and what is between them starts to roll. That is where all the vorticity of a fire is
/// from.
template <bool kStretching, bool kBaroclinic>
__host__ __device__ glm::vec3 strength_rate(const Flow& flow, glm::vec3 x_m, glm::vec3 alpha,
                                            float volume_m3) {
    glm::vec3 rate(0);
    if constexpr (kStretching) {
        const float size = glm::length(alpha);
        if (size > 0) rate += size * xyz(slope(flow.field, flow.grid, x_m, alpha / size));
    }
    if constexpr (kBaroclinic) {
        const float db_dx = slope(flow.field, flow.grid, x_m, {1, 0, 0}).w;
        const float db_dz = slope(flow.field, flow.grid, x_m, {0, 0, 1}).w;
        rate += volume_m3 * glm::vec3(-db_dz, 0, db_dx);  // grad(b) x up
    }
    return rate;
}
//! [strength_rate]

//! [advance]
/// One thread per vorton: from `state`, with the rates at `at`, over dt, into `out` (which may be `state`).
template <bool kStretching, bool kBaroclinic, bool kBall>
__global__ void advance_vortons_kernel(VortonState out, VortonState state, VortonState at, Flow flow,
                                       VortonPhysics physics, float dt_s, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x_at = xyz(at.position[i]);
    const float4 old_position = state.position[i], old_strength = state.strength[i];

    glm::vec3 x = xyz(old_position) + dt_s * flow.at<kBall>(x_at);
    if constexpr (kBall) push_out(flow.ball, x);

    glm::vec3 alpha = xyz(old_strength);
    if constexpr (kStretching || kBaroclinic)
        alpha += dt_s *
                 strength_rate<kStretching, kBaroclinic>(flow, x_at, xyz(at.strength[i]), physics.volume_m3);
    alpha *= std::exp(-dt_s / physics.decay_time_s);  // exact, whatever dt
    // A vortex that is stretched for long gets thinner than a core can show; there it would break up.
    const float turn = core_turn_rad_per_s(glm::length(alpha), physics.core_m);
    if (turn > physics.max_turn_rad_per_s) alpha *= physics.max_turn_rad_per_s / turn;

    out.position[i] = make_float4(x.x, x.y, x.z, old_position.w - dt_s);
    out.strength[i] =
        make_float4(alpha.x, alpha.y, alpha.z, old_strength.w * std::exp(-dt_s / physics.cooling_time_s));
}
//! [advance]

/// Launches the kernel that has just the terms that this physics has.
inline void advance_vortons(VortonState out, VortonState state, VortonState at, const Flow& flow,
                            const VortonPhysics& physics, float dt_s, std::uint32_t n) {
    if (n == 0) return;
    const std::uint32_t threads = 64, blocks = grid::blocks_for(n, threads);
    const auto launch = [&](auto stretching, auto baroclinic, auto ball) {
        advance_vortons_kernel<decltype(stretching)::value, decltype(baroclinic)::value,
                               decltype(ball)::value>
            <<<blocks, threads>>>(out, state, at, flow, physics, dt_s, n);
        CUDA_CHECK(cudaGetLastError());
    };
    const auto with_ball = [&](auto stretching, auto baroclinic) {
        if (flow.ball.radius_m > 0)
            launch(stretching, baroclinic, std::true_type());
        else
            launch(stretching, baroclinic, std::false_type());
    };
    if (physics.stretching && physics.baroclinic)
        with_ball(std::true_type(), std::true_type());
    else if (physics.stretching)
        with_ball(std::true_type(), std::false_type());
    else if (physics.baroclinic)
        with_ball(std::false_type(), std::true_type());
    else
        with_ball(std::false_type(), std::false_type());
}

//! [Stepping]
/// How a step of the vortons is taken.
enum class Stepping {
    euler,    ///< the flow at its start: one grid a step
    midpoint  ///< half a step by Euler, and the whole step with the flow found there: two grids a step
};

/// Where vortons are, besides among themselves.
struct Surroundings {
    CellGrid cells;
    fire::Wind wind{};
    float time_s = 0;
    Ball ball{};
    float mirror_m = 0;
};

/// One step of n vortons that move in their own flow.
/// @param halfway scratch for the midpoint method, n elements each
/// @returns the flow that carried them
inline Flow step_vortons(VelocityGrid& velocity, VortonState state, VortonState halfway, std::uint32_t n,
                         const Surroundings& around, const VortonPhysics& physics, Stepping stepping,
                         float dt_s) {
    velocity.build(state.position, state.strength, n, around.cells, physics.core_m);
    Flow flow{velocity.field(), around.cells, around.wind, around.time_s, around.ball, around.mirror_m};
    if (stepping == Stepping::midpoint) {
        advance_vortons(halfway, state, state, flow, physics, 0.5f * dt_s, n);
        velocity.build(halfway.position, halfway.strength, n, around.cells, physics.core_m);
        flow.time_s += 0.5f * dt_s;
        advance_vortons(state, state, halfway, flow, physics, dt_s, n);
    } else {
        advance_vortons(state, state, state, flow, physics, dt_s, n);
    }
    return flow;
}
//! [Stepping]

}  // namespace vortex
