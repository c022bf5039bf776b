/// @file
/// The emission-absorption march: what light comes along a ray through something that glows and absorbs.
#pragma once
#include <cuda_runtime.h>

#include "03_first_kernels/first_kernels.cuh"
#include "07_fire_particles/drag_step.h"
#include "13_volume_rendering/ray.h"
#include "common/cuda_check.h"
#include "common/errors.h"

namespace volume {

/// What fills a point of space.
template <class Real = float>
struct Matter {
    Real extinction_per_m = 0;      ///< sigma: part of the light lost per metre, absorbed or scattered away
    glm::vec<3, Real> emission{0};  ///< j: light added per metre, glow and scattering together, linear RGB
};

/// What a ray brings: the light of the volume, and the part of what lies behind that still shows.
template <class Real = float>
struct Seen {
    glm::vec<3, Real> light{0};
    Real transmittance = 1;
};

/// How a step of length dx through extinction sigma is turned into numbers.
enum class StepRule {
    exponential,   ///< alpha = 1 - exp(-sigma dx): exact where sigma and j are constant
    proportional,  ///< alpha = sigma dx, as many programs have it: first order, and above 1 for long steps
    midpoint       ///< all of a step's light seen from its middle: second order
};

struct MarchSettings {
    float step_m = 0.01f;
    float enough = 0;  ///< a ray ends when its transmittance falls below; 0: it goes through to the end
};
/// A ray takes no more steps than that: a step of a nanometre would take for ever.
constexpr int kMaxSteps = 1 << 16;

//! [march]
/// Walks along `span` in equal steps of at most settings.step_m and adds up what comes out at its near end.
/// @param field  tells field.at(x): the Matter at x; and, if Field::kSkips, field.clear_until(ray, t): how
/// far
///               from t on there is certainly nothing (t itself if there may be something)
template <StepRule kRule = StepRule::exponential, class Real, class Field>
__host__ __device__ inline Seen<Real> march(const Field& field, const Ray<Real>& ray, Span<Real> span,
                                            MarchSettings settings) {
    Seen<Real> seen;
    if (span.empty()) return seen;
    const Real length_m = span.far_m - span.near_m, wanted = std::ceil(length_m / Real(settings.step_m));
    const int steps = wanted < Real(kMaxSteps) ? int(wanted) : kMaxSteps;
    const Real dx = length_m / Real(steps);
    for (int k = 0; k < steps; ++k) {
        const Real t = span.near_m + (Real(k) + Real(0.5)) * dx;
        if constexpr (Field::kSkips) {
            const Real clear_m = field.clear_until(ray, t);
            if (clear_m > t) {
                // On to the first sample that is not clear. The samples stay where they would have been, so
                // that skipping changes nothing: the same bits come out.
                const Real next = std::ceil((clear_m - span.near_m) / dx - Real(0.5)) - 1;
                if (next >= Real(steps)) break;
                if (int(next) > k) k = int(next);
                continue;
            }
        }
        const Matter<Real> matter = field.at(ray.at(t));
        const Real depth = matter.extinction_per_m * dx;  // optical depth of this step
        if constexpr (kRule == StepRule::exponential) {
            // (1 - exp(-depth)) / depth dx: the length of the step as it shows through itself.
            seen.light += seen.transmittance * dx * fire::mean_decay(depth) * matter.emission;
            seen.transmittance *= std::exp(-depth);
        } else if constexpr (kRule == StepRule::proportional) {
            seen.light += seen.transmittance * dx * matter.emission;
            seen.transmittance *= std::fmax(Real(0), 1 - depth);
        } else {
            seen.light += seen.transmittance * std::exp(-depth / 2) * dx * matter.emission;
            seen.transmittance *= std::exp(-depth);
        }
        if (seen.transmittance < Real(settings.enough)) break;
    }
    return seen;
}
//! [march]

//! [march_kernel]
/// One thread per pixel, blocks of 8 x 8 pixels: neighbours in the picture read the same cells.
/// @param[out] seen    light RGB, transmittance
/// @param      solid_m distance along the ray at which something solid ends it, one per pixel; nullptr:
/// nothing
template <StepRule kRule, class Field>
__global__ void march_kernel(float4* seen, Field field, Lens lens, MarchSettings settings,
                             const float* solid_m) {
    const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
    if (x >= lens.width || y >= lens.height) return;
    const int pixel = y * lens.width + x;
    const Ray<float> ray = lens.ray(x, y);
    Span<float> span = box_span(ray, field.low_m(), field.high_m());
    if (solid_m) span.far_m = fminf(span.far_m, solid_m[pixel]);
    const Seen<float> s = march<kRule>(field, ray, span, settings);
    seen[pixel] = make_float4(s.light.x, s.light.y, s.light.z, s.transmittance);
}
//! [march_kernel]

constexpr unsigned kTile = 8;

/// @throws course::BadInput if the picture or the step makes no sense
inline void check(const Lens& lens, MarchSettings settings) {
    if (lens.width < 1 || lens.height < 1 || lens.width > 16384 || lens.height > 16384)
        throw course::BadInput("a picture is 1 to 16384 pixels wide and high");
    if (!(settings.step_m > 0) || !std::isfinite(settings.step_m))
        throw course::BadInput("the step of the march must be a length above 0, not " +
                               std::to_string(settings.step_m) + " m");
    if (!(settings.enough >= 0 && settings.enough < 1))
        throw course::BadInput("a ray can end at a transmittance from 0 to below 1, not " +
                               std::to_string(settings.enough));
}

/// Marches all rays of a picture. @param[out] seen lens.width * lens.height elements, top row first
template <StepRule kRule = StepRule::exponential, class Field>
void launch_march(float4* seen, const Field& field, const Lens& lens, MarchSettings settings,
                  const float* solid_m = nullptr) {
    check(lens, settings);
    const dim3 blocks((lens.width + kTile - 1) / kTile, (lens.height + kTile - 1) / kTile);
    march_kernel<kRule><<<blocks, dim3(kTile, kTile)>>>(seen, field, lens, settings, solid_m);
    CUDA_CHECK(cudaGetLastError());
}

}  // namespace volume
