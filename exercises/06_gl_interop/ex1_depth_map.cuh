// Exercise 06.1: a depth map without OpenGL.
//
// The chapter's fragment shader answers for one pixel of one sphere: how deep is the surface here? Answer it
// for a whole picture with a kernel: one thread per pixel, all spheres by turns, the nearest wins. That is
// what OpenGL's depth test does, and it is how a ray tracer begins.
#pragma once
#include <cuda_runtime.h>

#include <glm/glm.hpp>

#include "common/cuda_check.h"
#include "common/todo.h"

namespace interop {

// Camera coordinates: the eye is the origin and looks along -z; x is right, y is up.
struct Lens {
    int width_px, height_px;
    float half_width, half_height;  // of the picture on the plane z = -1
    float near_m, far_m;
};

// How far from the eye's plane (not from the eye) the ray first meets the sphere, in metres; infinity if it
// does not, or only behind the near plane. ray.z is -1.
__device__ inline float sphere_depth_m(glm::vec3 ray, glm::vec3 centre_m, float radius_m, float near_m) {
    // TODO(6.1): the depth of the nearer of the two points. One of the tests looks at a sphere of 5 mm from
    // 10 m away: there the textbook's b*b - 4*a*c has no correct digit left. About 5 lines.
    return course::kTodo;
}

// What OpenGL stores for this depth: 0 on the near plane, 1 on the far plane and beyond.
__device__ inline float stored_depth(float depth_m, const Lens& lens) {
    // TODO(6.1): not proportional to the depth, but to 1 / depth, so that near things get most of the digits.
    // 1 line.
    return course::kTodo;
}

// One thread per pixel, row 0 at the bottom. A sphere is its centre (xyz) and its radius (w), in metres.
inline __global__ void depth_map_kernel(float* stored, const float4* spheres, int sphere_count, Lens lens) {
    const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    if (x >= lens.width_px || y >= lens.height_px) return;
    const glm::vec3 ray((2 * (x + 0.5f) / lens.width_px - 1) * lens.half_width,
                        (2 * (y + 0.5f) / lens.height_px - 1) * lens.half_height, -1);
    float nearest_m = INFINITY;
    for (int k = 0; k < sphere_count; ++k) {
        const float4 s = spheres[k];
        nearest_m = fminf(nearest_m, sphere_depth_m(ray, {s.x, s.y, s.z}, s.w, lens.near_m));
    }
    stored[y * lens.width_px + x] = stored_depth(nearest_m, lens);
}

inline void depth_map(float* stored, const float4* spheres, int sphere_count, const Lens& lens) {
    const dim3 block(16, 16), grid((lens.width_px + 15) / 16, (lens.height_px + 15) / 16);
    depth_map_kernel<<<grid, block>>>(stored, spheres, sphere_count, lens);
    CUDA_CHECK(cudaGetLastError());
}

}  // namespace interop
