/// @file
/// The fire's own light on its smoke: how much the flames give off, and what of it gets through to each
/// place.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>
#include <vector>

#include "13_volume_rendering/fire_field.cuh"

namespace volume {

/// A part of the fire, as what it lights sees it.
struct Glow {
    glm::vec3 position_m{0};
    float size_m = 0.1f;  ///< its light does not grow without bound near it
    glm::vec3 power{0};   ///< sent out to all sides together, linear RGB
};
constexpr int kMaxGlows = 6;
struct Glows {
    int count = 0;
    Glow glow[kMaxGlows];
};

//! [power_kernel]
/// One thread per block of cells: what its cells give off, emission x volume x all directions, as far as it
/// leaves the block: on its way out, half a block on average, soot takes some of it away again.
inline __global__ void power_kernel(float4* power, FireField<false> field, int edge, glm::ivec3 blocks) {
    const int b = int(blockIdx.x * blockDim.x + threadIdx.x);
    if (b >= blocks.x * blocks.y * blocks.z) return;
    const glm::ivec3 first =
        edge * glm::ivec3(b % blocks.x, b / blocks.x % blocks.y, b / (blocks.x * blocks.y));
    const glm::ivec3 last = glm::min(first + edge, field.cells.size);
    const float cell_m = 1 / field.cells.cells_per_m, out_m = 0.5f * float(edge) * cell_m;
    glm::vec3 sum(0);
    for (int z = first.z; z < last.z; ++z)
        for (int y = first.y; y < last.y; ++y)
            for (int x = first.x; x < last.x; ++x) {
                const float2 here = field.field[grid::cell_number(field.cells, {x, y, z})];
                if (here.x > 0)
                    sum += fire::mean_decay(here.x * out_m) * here.x * glow_at(field.glow, here.y);
            }
    const float scale = 4 * 3.14159265f * (1 - field.albedo) * cell_m * cell_m * cell_m;
    power[b] = make_float4(scale * sum.x, scale * sum.y, scale * sum.z, 0);
}
//! [power_kernel]

//! [make_glows]
/// Cuts the fire into `count` parts of equal power, from bottom to top, each with its centre and its spread.
/// @param power of each block, x fastest
inline Glows make_glows(const std::vector<float4>& power, const grid::CellGrid& cells, int edge,
                        glm::ivec3 blocks, int count) {
    const auto weight = [](float4 p) { return double(p.x) + double(p.y) + double(p.z); };
    double total = 0;
    for (const float4& p : power) total += weight(p);
    Glows glows;
    if (!(total > 0)) return glows;
    struct Part {
        glm::dvec3 power{0}, moment{0}, square{0};
        double weight = 0;
    } part[kMaxGlows];
    double before = 0;
    const double block_m = edge / double(cells.cells_per_m);
    for (int y = 0; y < blocks.y; ++y) {
        const int k = std::min(count - 1, int(before / total * count));
        for (int z = 0; z < blocks.z; ++z)
            for (int x = 0; x < blocks.x; ++x) {
                const float4 p = power[(std::size_t(z) * blocks.y + y) * blocks.x + x];
                const glm::dvec3 at = glm::dvec3(cells.origin_m) + block_m * (glm::dvec3(x, y, z) + 0.5);
                part[k].power += glm::dvec3(p.x, p.y, p.z);
                part[k].moment += weight(p) * at;
                part[k].square += weight(p) * at * at;
                part[k].weight += weight(p);
                before += weight(p);
            }
    }
    for (const Part& p : part)
        if (p.weight > 0) {
            const glm::dvec3 centre = p.moment / p.weight, spread2 = p.square / p.weight - centre * centre;
            const double size =
                std::sqrt(std::max(0.0, spread2.x + spread2.y + spread2.z) + block_m * block_m);
            glows.glow[glows.count++] = {glm::vec3(centre), float(size), glm::vec3(p.power)};
        }
    return glows;
}
//! [make_glows]

//! [transmittance]
/// What part of a glow's light gets to x_m through smoke and flame. Inside the glow itself nothing counts:
/// there the flame is what shines, not what stands in the way.
template <class Field>
__host__ __device__ inline float transmittance_between(const Field& field, glm::vec3 x_m, const Glow& glow,
                                                       float step_m) {
    const glm::vec3 way = glow.position_m - x_m;
    const float distance_m = glm::length(way) - glow.size_m;
    if (!(distance_m > 0)) return 1;
    const Ray<float> ray{x_m, glm::normalize(way)};
    Span<float> span = box_span(ray, field.low_m(), field.high_m());
    span.far_m = fminf(span.far_m, distance_m);
    if (span.empty()) return 1;
    const int steps = int(fminf(std::ceil((span.far_m - span.near_m) / step_m), float(kMaxSteps)));
    const float dx = (span.far_m - span.near_m) / float(steps);
    float depth = 0;
    for (int k = 0; k < steps; ++k)
        depth += read(field.field, field.cells, ray.at(span.near_m + (float(k) + 0.5f) * dx)).x;
    return std::exp(-depth * dx);
}
//! [transmittance]

//! [fluence]
/// Light of all glows at x_m. Within a glow the inverse square law ends: one is inside it.
template <class Field>
__host__ __device__ inline glm::vec3 fluence_at(const Field& field, const Glows& glows, glm::vec3 x_m,
                                                float step_m, bool shadows) {
    glm::vec3 sum(0);
    for (int k = 0; k < glows.count; ++k) {
        const Glow& g = glows.glow[k];
        const glm::vec3 way = g.position_m - x_m;
        const float through = shadows ? transmittance_between(field, x_m, g, step_m) : 1.0f;
        sum += through / (4 * 3.14159265f * (glm::dot(way, way) + g.size_m * g.size_m)) * g.power;
    }
    return sum;
}

/// One thread per cell of the coarse grid.
inline __global__ void fluence_kernel(float4* fluence, grid::CellGrid coarse, FireField<false> field,
                                      Glows glows, glm::vec3 ambient, float step_m, bool shadows) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= coarse.cell_count()) return;
    const glm::vec3 x_m = vortex::centre_m(coarse, vortex::cell_at(coarse.size, c));
    const glm::vec3 light = ambient + fluence_at(field, glows, x_m, step_m, shadows);
    fluence[c] = make_float4(light.x, light.y, light.z, 0);
}
//! [fluence]

/// CPU reference: the same sum, cell by cell. @param field that of a FieldOnHost
inline std::vector<float4> fluence_cpu(const grid::CellGrid& coarse, const FireField<false>& field,
                                       const Glows& glows, glm::vec3 ambient, float step_m, bool shadows) {
    std::vector<float4> fluence;
    for (std::uint32_t c = 0; c < coarse.cell_count(); ++c) {
        const glm::vec3 x_m = vortex::centre_m(coarse, vortex::cell_at(coarse.size, c));
        const glm::vec3 light = ambient + fluence_at(field, glows, x_m, step_m, shadows);
        fluence.push_back(make_float4(light.x, light.y, light.z, 0));
    }
    return fluence;
}

}  // namespace volume
