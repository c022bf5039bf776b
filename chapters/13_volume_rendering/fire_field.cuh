/// @file
/// What the grid holds, as the march reads it: hot soot glows, cold soot takes light away and scatters the
/// fire's.
#pragma once
#include <cuda_runtime.h>

#include <vector>

#include "07_fire_particles/blackbody.h"
#include "08_fire_vortex/trilinear.cuh"
#include "13_volume_rendering/blocks.cuh"
#include "13_volume_rendering/detail.cuh"
#include "13_volume_rendering/march.cuh"

namespace volume {

//! [read]
/// Extinction (x, 1/m) and temperature (y, K) at x_m, trilinear between the centres of eight cells. Beyond
/// the outermost centres the value at the rim goes on.
__host__ __device__ inline float2 read(const float2* field, const grid::CellGrid& cells, glm::vec3 x_m) {
    const glm::vec3 place = glm::clamp((x_m - cells.origin_m) * cells.cells_per_m - 0.5f, glm::vec3(0),
                                       glm::vec3(cells.size - 1));
    const glm::ivec3 low(place), high = glm::min(low + 1, cells.size - 1);
    const glm::vec3 t = place - glm::vec3(low);
    const auto mix = [](float2 a, float2 b, float s) {
        return make_float2(a.x + s * (b.x - a.x), a.y + s * (b.y - a.y));
    };
    const auto along_x = [&](int y, int z) {
        const float2* row = field + grid::cell_number(cells, {0, y, z});
        return mix(row[low.x], row[high.x], t.x);
    };
    return mix(mix(along_x(low.y, low.z), along_x(high.y, low.z), t.y),
               mix(along_x(low.y, high.z), along_x(high.y, high.z), t.y), t.z);
}
//! [read]

//! [glow]
/// Radiance of a black body by temperature, chapter 07's ramp: luminance 1 at 1900 K.
constexpr int kGlowSize = 512;
constexpr float kGlowLow_K = 700, kGlowHigh_K = 2300;

inline std::vector<float4> glow_table() {
    std::vector<float4> table;
    for (int k = 0; k < kGlowSize; ++k) {
        const glm::vec4 body =
            fire::blackbody_ramp(kGlowLow_K + (kGlowHigh_K - kGlowLow_K) * double(k) / (kGlowSize - 1));
        const float luminance = std::exp(body.a);
        table.push_back(make_float4(body.r * luminance, body.g * luminance, body.b * luminance, 0));
    }
    return table;
}

__host__ __device__ inline glm::vec3 glow_at(const float4* table, float temperature_K) {
    const float place = (temperature_K - kGlowLow_K) * (float(kGlowSize - 1) / (kGlowHigh_K - kGlowLow_K));
    if (!(place > 0)) return glm::vec3(0);
    const int k = place < float(kGlowSize - 1) ? int(place) : kGlowSize - 2;
    const float t = fminf(place - float(k), 1.0f);
    return grid::xyz(vortex::mix(table[k], table[k + 1], t));
}
//! [glow]

/// Light that falls on the smoke from all sides together (radiance summed over directions), on a coarse grid.
struct LightGrid {
    grid::CellGrid cells;
    const float4* fluence = nullptr;  ///< RGB; nullptr: no light but the glow, smoke is black
};

//! [FireField]
/// The grid as a field to march through. A kernel gets a copy.
/// @tparam kSkip   whether blocks are looked at: without them no such code is compiled
/// @tparam kDetail whether there is detail finer than the cells
template <bool kSkip, bool kDetail = false>
struct FireField {
    static constexpr bool kSkips = kSkip;
    grid::CellGrid cells;
    const float2* field = nullptr;
    const float4* glow = nullptr;
    float albedo = 0;  ///< part of the extinction that scatters; the rest absorbs, and glows when hot
    LightGrid light;
    Blocks blocks;
    Detail detail;

    __host__ __device__ Matter<float> at(glm::vec3 x_m) const {
        if constexpr (kDetail) x_m = shifted(detail, x_m);
        const float2 here = read(field, cells, x_m);
        if (!(here.x > 0)) return {};
        // Kirchhoff: what absorbs well glows well. So emission is absorption times a black body's radiance.
        glm::vec3 source = (1 - albedo) * glow_at(glow, here.y);
        if (light.fluence) {
            constexpr float kToAllSides = float(1 / (4 * 3.14159265358979));  // scatters evenly
            source += albedo * kToAllSides * grid::xyz(vortex::sample(light.fluence, light.cells, x_m));
        }
        return {here.x, here.x * source};
    }
    __host__ __device__ float clear_until(const Ray<float>& ray, float t_m) const {
        return volume::clear_until(blocks, cells, ray, t_m);
    }
    __host__ __device__ glm::vec3 low_m() const { return cells.origin_m; }
    __host__ __device__ glm::vec3 high_m() const {
        return cells.origin_m + glm::vec3(cells.size) / cells.cells_per_m;
    }
};
//! [FireField]

// ------------------------------------------------------------------------------------------ the reference

/// A field whose arrays lie on the host: what the CPU can ask.
class FieldOnHost {
  public:
    /// Copies the arrays of a field on the device.
    explicit FieldOnHost(const FireField<false>& from) : field(from) {
        copy(values_, from.field, from.cells.cell_count());
        copy(glow_, from.glow, kGlowSize);
        field.field = values_.data();
        field.glow = glow_.data();
        if (!from.light.fluence) return;
        copy(fluence_, from.light.fluence, from.light.cells.cell_count());
        field.light.fluence = fluence_.data();
    }
    FieldOnHost(const FieldOnHost&) = delete;
    FieldOnHost& operator=(const FieldOnHost&) = delete;

    FireField<false> field;

  private:
    template <class T>
    static void copy(std::vector<T>& to, const T* from, std::size_t count) {
        to.resize(count);
        CUDA_CHECK(cudaMemcpy(to.data(), from, count * sizeof(T), cudaMemcpyDeviceToHost));
    }
    std::vector<float2> values_;
    std::vector<float4> glow_, fluence_;
};

/// A stored field, asked at positions in double.
struct FieldInDouble {
    static constexpr bool kSkips = false;
    const FireField<false>& field;
    __host__ __device__ Matter<double> at(glm::dvec3 x_m) const {
        const Matter<float> m = field.at(glm::vec3(x_m));
        return {m.extinction_per_m, glm::dvec3(m.emission)};
    }
};

/// CPU reference of the march through a grid: double, every step, no skipping, no early end.
/// @param field that of a FieldOnHost
inline std::vector<float4> march_cpu(const FireField<false>& field, const Lens& lens, float step_m) {
    std::vector<float4> seen;
    for (int y = 0; y < lens.height; ++y)
        for (int x = 0; x < lens.width; ++x) {
            const Ray<float> r = lens.ray(x, y);
            const Ray<double> ray{glm::dvec3(r.origin_m), glm::dvec3(r.direction)};
            const Span<double> span = box_span(ray, glm::dvec3(field.low_m()), glm::dvec3(field.high_m()));
            const Seen<double> s = march(FieldInDouble{field}, ray, span, {step_m, 0});
            seen.push_back(
                make_float4(float(s.light.x), float(s.light.y), float(s.light.z), float(s.transmittance)));
        }
    return seen;
}

}  // namespace volume
