// Exercise 13.1: smoke scatters forward.
//
// This chapter's smoke scatters light evenly to all sides. Real smoke sends most of it on, nearly straight
// ahead: that is why smoke between you and a fire shines, and smoke behind it is dull. How much goes where is
// told by the phase function. The most used one is that of Henyey and Greenstein (1941), with one parameter
// g:
//
//     p(cos) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2))
//
// g is the mean cosine of the angle by which light is turned: 0 evenly, towards 1 forward, towards -1
// backward. Over all directions p adds up to 1: no light is made, none is lost.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/glm.hpp>

#include "common/cuda_check.h"
#include "common/todo.h"

namespace volume {

constexpr float kPi = 3.14159265f;

// Part of the light that goes into each unit of solid angle. @param cosine of the angle between the direction
// in which the light flew and the one in which it leaves: 1 is straight on. @param g from above -1 to below 1
__host__ __device__ inline float phase(float cosine, float g) {
    // TODO(13.1): the formula above. About 2 lines.
    // <solution>
    const float d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (4 * kPi * d * std::sqrt(d));
    // <stub>
    //| return course::kTodo;
    // </solution>
}

// Light that smoke at x sends to the eye, for each unit of light that reaches x from the lamp.
__host__ __device__ inline float scattered(glm::vec3 lamp_m, glm::vec3 x_m, glm::vec3 eye_m, float g) {
    // TODO(13.1): find the cosine, then ask phase(). Light flies from lamp to smoke to eye.
    // About 2 lines.
    // <solution>
    const glm::vec3 arrives = glm::normalize(x_m - lamp_m), leaves = glm::normalize(eye_m - x_m);
    return phase(glm::dot(arrives, leaves), g);
    // <stub>
    //| return course::kTodo;
    // </solution>
}

// One thread per puff of smoke.
inline __global__ void scattered_kernel(float* light, const float4* puff, glm::vec3 lamp_m, glm::vec3 eye_m,
                                        float g, int count) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= count) return;
    light[i] = scattered(lamp_m, glm::vec3(puff[i].x, puff[i].y, puff[i].z), eye_m, g);
}

}  // namespace volume
