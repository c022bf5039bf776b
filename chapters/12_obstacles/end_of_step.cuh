/// @file
/// The contact test that comes to mind first, to compare: look where particles are when the step is over.
#pragma once
#include "12_obstacles/contact.cuh"

namespace obstacles {

//! [end_of_step_kernel]
/// One thread per particle: who is inside an obstacle at the end of the step goes out by the shortest way,
/// and bounces there. Right in the limit of small steps. A particle that was in and out again within the step
/// has not been in, and one that got deeper than the middle leaves on the far side.
inline __global__ void end_of_step_kernel(float4* position, float4* velocity, Obstacles all,
                                          std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    glm::vec3 x = grid::xyz(position[i]), v = grid::xyz(velocity[i]);
    for (int k = 0; k < all.count; ++k) {
        const Moving& o = all.obstacle[k];
        const float depth = signed_distance(o.solid, x - o.to_m);
        if (!(depth < 0)) continue;
        const glm::vec3 normal = outward(o.solid, x - o.to_m);
        x -= depth * normal;
        v = bounce(v, o.to_m_per_s, normal, o.surface);
    }
    position[i] = make_float4(x.x, x.y, x.z, position[i].w);
    velocity[i] = make_float4(v.x, v.y, v.z, velocity[i].w);
}
//! [end_of_step_kernel]

}  // namespace obstacles
