// Exercise 15.2: the bright lines on the floor of a pool.
//
// GLSL has refract(); CUDA has not. With it, a whole pool of caustics is one kernel: the sun shines straight
// down on ripples, and each photon is bent once and lands on the floor. Where many land, there is a bright
// line.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/glm.hpp>

#include "common/todo.h"

namespace water {

// The direction of a ray after it has crossed a surface. All directions have length 1.
// @param normal  of the surface, against the ray: dot(normal, towards) < 0
// @param ratio   refractive index before the surface over the one beyond it
// @returns (0, 0, 0) if the light does not cross at all: total reflection
__host__ __device__ inline glm::vec3 bend(glm::vec3 towards, glm::vec3 normal, float ratio) {
    // TODO(15.2): Snell in vectors. The part of the ray along the surface is multiplied by `ratio`; the part
    // against the normal is what is left for a length of 1. About 4 lines.
    // <solution>
    const float against = -glm::dot(normal, towards);
    const glm::vec3 along = ratio * (towards + against * normal);
    const float left = 1 - glm::dot(along, along);
    if (!(left > 0)) return glm::vec3(0);
    return along - sqrtf(left) * normal;
    // <stub>
    //| (void)towards, (void)normal, (void)ratio;
    //| return glm::vec3(course::kTodo);
    // </solution>
}

// A pool with waves that run along x: y = level + height cos(waves x). The floor is y = 0.
struct Ripples {
    float level_m, height_m, waves_per_m;  // waves_per_m: radians per metre
};

// One thread per photon: it comes down at (x_m[i], 0) along `towards`, and lands on the floor at
// landing_m[i].
inline __global__ void land_kernel(float2* landing_m, const float* x_m, glm::vec3 towards, float index,
                                   Ripples ripples, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    // TODO(15.2): where the photon meets the water, the normal there (out of the water, length 1), its way
    // on, and where that meets the floor: x in landing_m[i].x, z in landing_m[i].y. About 6 lines.
    // <solution>
    const float phase = ripples.waves_per_m * x_m[i];
    const float height_m = ripples.level_m + ripples.height_m * cosf(phase);
    const float slope = -ripples.height_m * ripples.waves_per_m * sinf(phase);
    const glm::vec3 way = bend(towards, glm::normalize(glm::vec3(-slope, 1, 0)), 1 / index);
    const float t_m = height_m / -way.y;
    landing_m[i] = make_float2(x_m[i] + t_m * way.x, t_m * way.z);
    // <stub>
    //| (void)x_m, (void)towards, (void)index, (void)ripples;
    //| landing_m[i] = make_float2(course::kTodo, course::kTodo);
    // </solution>
}

}  // namespace water
