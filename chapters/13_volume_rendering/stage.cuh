/// @file
/// What is solid: logs and the ground, lit by the fire through its smoke. One ray per pixel, no OpenGL.
#pragma once
#include <cuda_runtime.h>

#include "07_fire_particles/fire_look.h"
#include "13_volume_rendering/fire_light.cuh"

namespace volume {

/// Chapter 07's Stage in a form that a kernel can take by value.
struct SolidStage {
    int rod_count = 0;
    fire::Rod rod[fire::kMaxRods];
    bool ground = false;
    glm::vec3 ground_colour{0};
    float ground_grain_m = 0.05f;
    glm::vec3 sky_low{0}, sky_high{0};  ///< radiance at the horizon and overhead
};

/// @param exposure of the film; chapter 07's stages are made for 1: a sky that gives as much less light looks
/// alike
inline SolidStage make_solid(const fire::Stage& stage, float exposure) {
    SolidStage s;
    if (stage.rods.size() > fire::kMaxRods) throw course::BadInput("a stage has at most 10 rods");
    for (const fire::Rod& rod : stage.rods) s.rod[s.rod_count++] = rod;
    s.ground = stage.ground;
    s.ground_colour = stage.ground_colour;
    s.ground_grain_m = stage.ground_grain_m > 0 ? stage.ground_grain_m : 0.05f;
    s.sky_low = stage.sky_low / exposure;
    s.sky_high = stage.sky_high / exposure;
    return s;
}

// ------------------------------------------------------------------------------------------------- noise

/// A number in [0, 1) for each point of a lattice.
__host__ __device__ inline float lattice(glm::ivec3 p) {
    std::uint32_t h = std::uint32_t(p.x) * 0x8da6b343u ^ std::uint32_t(p.y) * 0xd8163841u ^
                      std::uint32_t(p.z) * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return float((h ^ (h >> 15)) >> 8) * (1.0f / 16777216.0f);
}

/// Smooth noise between 0 and 1.
__host__ __device__ inline float noise(glm::vec3 x) {
    const glm::vec3 floor = glm::floor(x), f = x - floor, t = f * f * (3.0f - 2.0f * f);
    const glm::ivec3 cell(floor);
    float row[4];
    for (int k = 0; k < 4; ++k) {
        const glm::ivec3 c = cell + glm::ivec3(0, k & 1, k >> 1);
        const float a = lattice(c), b = lattice(c + glm::ivec3(1, 0, 0));
        row[k] = a + t.x * (b - a);
    }
    const float near = row[0] + t.y * (row[1] - row[0]), far = row[2] + t.y * (row[3] - row[2]);
    return near + t.z * (far - near);
}
__host__ __device__ inline float rough_noise(glm::vec3 x) {
    return 0.5333f * noise(x) + 0.2667f * noise(2.03f * x) + 0.1333f * noise(4.1f * x) +
           0.0667f * noise(8.3f * x);
}

// -------------------------------------------------------------------------------------------------- solid

/// Distance along the ray to a cylinder with round ends, or -1.
__host__ __device__ inline float rod_distance(const Ray<float>& ray, const fire::Rod& rod) {
    const glm::vec3 axis = rod.to_m - rod.from_m, start = ray.origin_m - rod.from_m;
    const float length2 = glm::dot(axis, axis), axis_ray = glm::dot(axis, ray.direction);
    const float axis_start = glm::dot(axis, start), r2 = rod.radius_m * rod.radius_m;
    const float a = length2 - axis_ray * axis_ray;
    const float b = length2 * glm::dot(start, ray.direction) - axis_start * axis_ray;
    const float c = length2 * (glm::dot(start, start) - r2) - axis_start * axis_start, root = b * b - a * c;
    if (root >= 0 && a > 1e-9f * length2) {
        const float t = (-b - std::sqrt(root)) / a, along = axis_start + t * axis_ray;
        if (along > 0 && along < length2) return t > 0 ? t : -1.0f;
    }
    float nearest = -1;
    for (int end = 0; end < 2; ++end) {
        const glm::vec3 from_centre = end == 0 ? start : ray.origin_m - rod.to_m;
        const float h = glm::dot(ray.direction, from_centre);
        const float q = h * h - glm::dot(from_centre, from_centre) + r2;
        const float t = -h - std::sqrt(fmaxf(q, 0.0f));
        if (q > 0 && t > 0 && (nearest < 0 || t < nearest)) nearest = t;
    }
    return nearest;
}

/// First solid thing on the ray: its distance and the rod's number; -1: the ground, -2: nothing.
struct SolidHit {
    float distance_m = 1e30f;
    int rod = -2;
};
__host__ __device__ inline SolidHit first_solid(const SolidStage& stage, const Ray<float>& ray,
                                                int except = -1) {
    SolidHit hit;
    if (stage.ground && ray.direction.y < 0 && ray.origin_m.y > 0)
        hit = {-ray.origin_m.y / ray.direction.y, -1};
    for (int k = 0; k < stage.rod_count; ++k) {
        if (k == except) continue;
        const float t = rod_distance(ray, stage.rod[k]);
        if (t > 0 && t < hit.distance_m) hit = {t, k};
    }
    return hit;
}

/// The normal, bent by the slope of some noise: bark and earth.
__host__ __device__ inline glm::vec3 bumpy(glm::vec3 place, glm::vec3 normal, float strength) {
    const float e = 0.35f, here = rough_noise(place);
    const glm::vec3 slope((rough_noise(place + glm::vec3(e, 0, 0)) - here) / e,
                          (rough_noise(place + glm::vec3(0, e, 0)) - here) / e,
                          (rough_noise(place + glm::vec3(0, 0, e)) - here) / e);
    return glm::normalize(normal - strength * (slope - glm::dot(slope, normal) * normal));
}

//! [light_on]
/// Light that falls on a surface: from each glow what the smoke lets through and no log hides, and the sky's.
/// A flame is no point: two places in it make its shadows softer.
template <class Field>
__host__ __device__ inline glm::vec3 light_on(const SolidStage& stage, const Field& field, const Glows& glows,
                                              glm::vec3 x, glm::vec3 normal, glm::vec3 bent, int except) {
    glm::vec3 sum = stage.sky_high * (0.5f + 0.5f * bent.y) * 3.14159265f;
    for (int k = 0; k < glows.count; ++k) {
        const Glow& g = glows.glow[k];
        float open = 0;
        for (int s = 0; s < 2; ++s) {
            const glm::vec3 to =
                g.position_m + 0.6f * g.size_m * glm::vec3(s ? 1 : -1, s ? 0.5f : -0.5f, s ? -1 : 1);
            const glm::vec3 start = x + 0.002f * normal;
            const float far = glm::length(to - start);
            const SolidHit hit = first_solid(stage, {start, (to - start) / far}, except);
            if (hit.rod < 0 || hit.distance_m > far) open += 0.5f;
        }
        if (open == 0) continue;
        const glm::vec3 way = g.position_m - x;
        const float d2 = glm::dot(way, way) + g.size_m * g.size_m;
        const float facing = (glm::dot(bent, way) / std::sqrt(d2) + 0.15f) / 1.15f;
        if (facing <= 0) continue;
        sum += open * facing * transmittance_between(field, x, g, 0.06f) / (4 * 3.14159265f * d2) * g.power;
    }
    return sum;
}
//! [light_on]

//! [stage_kernel]
/// One thread per pixel: what is solid there, how far away it is, and the light it sends to the eye. Behind
/// everything stands the evening sky.
template <class Field>
__global__ void stage_kernel(float4* light, float* solid_m, SolidStage stage, Field field, Glows glows,
                             Lens lens) {
    const int px = blockIdx.x * blockDim.x + threadIdx.x, py = blockIdx.y * blockDim.y + threadIdx.y;
    if (px >= lens.width || py >= lens.height) return;
    const Ray<float> ray = lens.ray(px, py);
    const SolidHit hit = first_solid(stage, ray);
    const float up = fmaxf(ray.direction.y, 0.0f), high = 1 - std::exp(-3.0f * up);
    const glm::vec3 sky = stage.sky_low + high * (stage.sky_high - stage.sky_low);
    glm::vec3 seen = sky;
    const glm::vec3 x = ray.at(fminf(hit.distance_m, 1e3f));
    if (hit.rod == -1) {
        const glm::vec3 place = x / stage.ground_grain_m;
        const glm::vec3 normal(0, 1, 0), bent = bumpy(place, normal, 0.6f);
        const float grains = 0.35f + 0.7f * rough_noise(place) + 0.5f * rough_noise(5.9f * place);
        seen =
            stage.ground_colour * grains * light_on(stage, field, glows, x, normal, bent, -1) / 3.14159265f;
        seen += (1 - std::exp(-0.06f * hit.distance_m)) * (stage.sky_low - seen);  // the evening's haze
    } else if (hit.rod >= 0) {
        const fire::Rod& rod = stage.rod[hit.rod];
        const glm::vec3 axis = rod.to_m - rod.from_m, unit = glm::normalize(axis);
        const float along = glm::clamp(glm::dot(x - rod.from_m, axis) / glm::dot(axis, axis), 0.0f, 1.0f);
        const glm::vec3 out = x - rod.from_m - along * axis, normal = glm::normalize(out);
        const glm::vec3 bark =
            (out + 0.25f * glm::dot(x - rod.from_m, unit) * unit) / (0.25f * rod.radius_m) +
            7.0f * float(hit.rod);
        const float crust = glm::smoothstep(0.35f, 0.75f, rough_noise(bark));
        const glm::vec3 colour =
            glm::mix(glm::vec3(0.025f, 0.02f, 0.017f), glm::vec3(0.17f, 0.11f, 0.065f), crust);
        seen = colour * light_on(stage, field, glows, x, normal, bumpy(bark, normal, 0.9f), hit.rod) /
               3.14159265f;
        // Embers in the cracks of the end that lies in the fire.
        const float crack = glm::smoothstep(0.12f, 0.0f, std::abs(rough_noise(bark * 1.3f) - 0.5f));
        const float hot = glm::smoothstep(0.30f, 0.95f, along + 0.5f * (noise(x / rod.radius_m) - 0.5f));
        seen += rod.embers * hot * (0.15f + crack) * glm::vec3(0.25f, 0.028f, 0.002f);
    }
    light[py * lens.width + px] = make_float4(seen.x, seen.y, seen.z, 1);
    solid_m[py * lens.width + px] = hit.distance_m;
}
//! [stage_kernel]

}  // namespace volume
