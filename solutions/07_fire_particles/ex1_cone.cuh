// Exercise 07.1: an emitter that sprays.
//
// Sparks leave a grinder in a cone. Their directions are to be even: a patch of sky of a given size gets as
// many sparks wherever it lies in the cone. You turn two even numbers into such a direction.
#pragma once
#include "07_fire_particles/flame.cuh"
#include "common/device_buffer.h"
#include "common/todo.h"

namespace fire {

// A direction of length 1, at most half_angle_rad (0 to pi) from `axis` (length 1), evenly spread over all
// those. u and v are even in [0, 1).
__host__ __device__ inline glm::vec3 cone_direction(glm::vec3 axis, float half_angle_rad, float u, float v) {
    const glm::vec3 other = std::abs(axis.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(axis, other)), y = glm::cross(axis, x);
    const float turn = 6.2831853f * v;
    // TODO(7.1): u decides how far from the axis, v where around it; x and y stand on the axis. On a sphere,
    // a ring between two planes across the axis has an area that goes with the planes' distance alone
    // (Archimedes), so what has to be even is not the angle. Keep the digits of narrow cones:
    // 1 - cos(a) = 2 sin^2(a / 2). About 4 lines.
    // <solution>
    const float half_sine = std::sin(0.5f * half_angle_rad);
    const float below_top = 2 * half_sine * half_sine * u;  // 1 - cosine of the angle
    const float sine = std::sqrt(below_top * (2 - below_top));
    return (1 - below_top) * axis + sine * (std::cos(turn) * x + std::sin(turn) * y);
    // <stub>
    //| (void)half_angle_rad, (void)u, (void)turn;
    //| return float(course::kTodo) * (x + y + axis);
    // </solution>
}

// One thread per spark: its direction, from the numbers of its life.
inline __global__ void cone_kernel(float4* direction, std::uint32_t n, glm::vec3 axis, float half_angle_rad,
                                   std::uint64_t seed) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const Uniforms r = random_life(seed, i, 0);
    const glm::vec3 way = cone_direction(axis, half_angle_rad, r.u[0], r.u[1]);
    direction[i] = make_float4(way.x, way.y, way.z, 0);
}

}  // namespace fire
