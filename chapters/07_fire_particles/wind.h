/// @file
/// The air that drags the particles along: a steady wind with gusts, a plume that draws air in, and curl
/// noise.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "01_particle_loop/particle_loop.h"

namespace fire {

/// Waves that curl noise is summed from. Sixteen look random; their sines are most of what a step costs.
constexpr int kWaves = 16;

/// A velocity field without sources: the curl of a sum of waves of random direction and phase. It drifts
/// upwards, as eddies do in a plume, and grows from nothing at the ground.
struct CurlNoise {
    float drift_m_per_s = 0;        ///< upward speed of the whole pattern
    float full_height_m = 1;        ///< at this height it has 63 % of its strength
    glm::vec4 wave[kWaves]{};       ///< wave vector (1/m), phase
    glm::vec4 potential[kWaves]{};  ///< amplitude of the vector potential (m^2/s), its own frequency (1/s)
};

/// @param speed_m_per_s root mean square of the velocity high up
/// @param length_m      wavelength of the largest waves; the smallest have a quarter of it
inline CurlNoise make_curl_noise(float speed_m_per_s, float length_m, float drift_m_per_s,
                                 float full_height_m, std::uint64_t seed) {
    CurlNoise noise;
    noise.drift_m_per_s = drift_m_per_s;
    noise.full_height_m = full_height_m;
    constexpr float kTurn = 6.2831853f;
    float sum = 0, weight[kWaves];
    for (int k = 0; k < kWaves; ++k) {
        // Small eddies are slower: speed as the cube root of size, as Kolmogorov has it.
        weight[k] = std::pow(0.25f, float(k) / (3.0f * (kWaves - 1)));
        sum += 0.5f * weight[k] * weight[k];  // the mean square of a cosine is 1/2
    }
    for (int k = 0; k < kWaves; ++k) {
        const particle_loop::Uniforms r = particle_loop::random_start(seed, std::uint32_t(k), 0xC0415Eu);
        const float wave_length_m = length_m * std::pow(0.25f, float(k) / (kWaves - 1));
        const float number = kTurn / wave_length_m, speed = speed_m_per_s * weight[k] / std::sqrt(sum);
        const float y = 2 * r.u[0] - 1, angle = kTurn * r.u[1], flat = std::sqrt(1 - y * y);
        const glm::vec3 along(flat * std::cos(angle), y, flat * std::sin(angle));
        // Any direction across the wave will do for the potential.
        const glm::vec3 other = std::abs(y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        const glm::vec3 u = glm::normalize(glm::cross(along, other)), v = glm::cross(along, u);
        const float turn = kTurn * r.u[2];
        noise.wave[k] = glm::vec4(number * along, kTurn * r.u[3]);
        noise.potential[k] = glm::vec4(speed / number * (std::cos(turn) * u + std::sin(turn) * v),
                                       (2 * r.u[4] - 1) * speed * number * 0.5f);
    }
    return noise;
}

//! [curl]
/// curl(g A) = g curl(A) + grad(g) x A, with A the sum of potential * sin(wave . x + phase): exact, no finite
/// differences, so no particle ever meets a source or a sink.
__host__ __device__ inline glm::vec3 curl_noise(const CurlNoise& noise, glm::vec3 x, float time_s) {
    if (x.y <= 0) return glm::vec3(0);
    const glm::vec3 seen(x.x, x.y - noise.drift_m_per_s * time_s, x.z);
    glm::vec3 potential(0), curl(0);
    for (int k = 0; k < kWaves; ++k) {
        const glm::vec3 wave(noise.wave[k]), amplitude(noise.potential[k]);
        const float phase = glm::dot(wave, seen) + noise.wave[k].w + noise.potential[k].w * time_s;
        const float s = std::sin(phase), c = std::cos(phase);
        potential += s * amplitude;
        curl += c * glm::cross(wave, amplitude);
    }
    const float left = std::exp(-x.y / noise.full_height_m);
    return (1 - left) * curl + left / noise.full_height_m * glm::cross(glm::vec3(0, 1, 0), potential);
}
//! [curl]

/// The air apart from its noise. Lengths in metres; the plume stands on y = 0 around `axis_m`.
struct Wind {
    glm::vec3 steady_m_per_s{0};  ///< blows at full strength above...
    float boundary_m = 0;         ///< ...about this height; 0: down to the ground
    float gust = 0;               ///< the steady wind swells and falls by this part of itself...
    float gust_s = 1;             ///< ...about once in this time
    float updraft_m_per_s = 0;    ///< upward speed of the plume, reached over...
    float updraft_height_m = 1;   ///< ...this height. What it gains, it draws in from the sides.
    glm::vec3 axis_m{0};
};

//! [wind]
/// The air's velocity. Where the updraft gains speed, the same volume of air has to come in from the sides:
/// that is what draws a candle's flame to a point.
__host__ __device__ inline glm::vec3 wind_at(const Wind& wind, glm::vec3 x, float time_s) {
    glm::vec3 air = wind.steady_m_per_s;
    if (wind.gust > 0) {
        const float turns = 6.2831853f * time_s / wind.gust_s;
        air *= 1 + wind.gust * 0.5f * (std::sin(turns) + std::sin(2.618f * turns + 1.3f));
    }
    if (wind.boundary_m > 0) air *= x.y > 0 ? 1 - std::exp(-x.y / wind.boundary_m) : 0.0f;
    if (wind.updraft_m_per_s > 0) {
        const float left = x.y > 0 ? std::exp(-x.y / wind.updraft_height_m) : 1.0f;
        const float gain_per_s = wind.updraft_m_per_s * left / wind.updraft_height_m;
        air.y += wind.updraft_m_per_s * (1 - left);
        air.x -= 0.5f * gain_per_s * (x.x - wind.axis_m.x);
        air.z -= 0.5f * gain_per_s * (x.z - wind.axis_m.z);
    }
    return air;
}
//! [wind]

}  // namespace fire
