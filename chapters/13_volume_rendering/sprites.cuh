/// @file
/// The same particles as sprites, for comparison: each one a soft spot of light, added to the picture. What
/// chapter 07's blending does, as a kernel, so that both run on the same device and are timed alike.
#pragma once
#include <cuda_runtime.h>

#include "13_volume_rendering/fire_field.cuh"
#include "13_volume_rendering/splat.cuh"

namespace volume {

/// Light is summed in units of that: integers, so that the order of the sprites does not show.
constexpr double kLightQuantum = 1e-9;

//! [sprite_kernel]
/// One thread per particle: a spot (1 - r^2)^2 around where the particle is seen. It adds the light of a
/// black body of its own temperature and absorbs nothing; smoke, which only absorbs, is not there.
/// @param light three sums per pixel, in units of kLightQuantum
/// @param temperature_K at birth and at death
/// @param gain  of all sprites
inline __global__ void sprite_kernel(unsigned long long* light, const float4* position,
                                     const float4* velocity, std::uint32_t n, Cargos cargos, Gas gas,
                                     glm::vec2 temperature_K, const float4* glow, Lens lens, float gain,
                                     Quantum quantum) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const Deposit d = deposit_of(cargos, i, position[i], velocity[i].w, quantum);
    if (d.heat == 0 || d.soot == 0) return;
    // Alone, a particle does not know how hot it is: that depends on how many are in one place. So its
    // temperature goes with its age, as in chapter 07.
    const float burnt = position[i].w / velocity[i].w;
    const float own_K = temperature_K.x + burnt * (temperature_K.y - temperature_K.x);
    const glm::vec3 body =
        float(double(d.soot) * quantum.soot_kg) * gas.extinction_m2_per_kg * glow_at(glow, own_K);

    const glm::vec3 to = d.centre_m - lens.eye_m;
    const float depth_m = glm::dot(to, lens.forward);
    if (depth_m < 0.02f) return;
    const float half_width = glm::length(lens.right), half_height = glm::length(lens.up);
    const float pixels_per_m = 0.5f * float(lens.height) / (depth_m * half_height);
    const float px =
        0.5f * float(lens.width) * (1 + glm::dot(to, lens.right) / (half_width * half_width * depth_m));
    const float py =
        0.5f * float(lens.height) * (1 - glm::dot(to, lens.up) / (half_height * half_height * depth_m));
    const float radius = fmaxf(d.radius_m * pixels_per_m, 0.7f);
    if (!(std::abs(px) < 1e5f && std::abs(py) < 1e5f && radius < 1e4f)) return;
    // The spot's integral is pi r^2 / 3; light per pixel is what the particle gives off over the pixel's
    // area.
    const float area_m2 = 3.14159265f / 3 * radius * radius / (pixels_per_m * pixels_per_m);
    const glm::vec3 middle = gain / area_m2 * body;
    const int x0 = max(0, int(std::floor(px - radius))),
              x1 = min(lens.width - 1, int(std::ceil(px + radius)));
    const int y0 = max(0, int(std::floor(py - radius))),
              y1 = min(lens.height - 1, int(std::ceil(py + radius)));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const float u = (float(x) + 0.5f - px) / radius, v = (float(y) + 0.5f - py) / radius;
            const float inside = 1 - u * u - v * v;
            if (inside <= 0) continue;
            for (int c = 0; c < 3; ++c)
                atomicAdd(&light[3 * (y * lens.width + x) + c],
                          (unsigned long long)(double(inside * inside * middle[c]) / kLightQuantum));
        }
}
//! [sprite_kernel]

/// One thread per pixel: sums to light.
inline __global__ void sprite_light_kernel(float4* seen, const unsigned long long* light, int pixels) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= pixels) return;
    seen[i] = make_float4(float(double(light[3 * i]) * kLightQuantum),
                          float(double(light[3 * i + 1]) * kLightQuantum),
                          float(double(light[3 * i + 2]) * kLightQuantum), 1);
}

/// Draws sprites into pictures of one size.
class SpriteDrawer {
  public:
    SpriteDrawer(int width, int height) : glow_(glow_table()), light_(std::size_t(3) * width * height) {}

    void draw(float4* seen, const float4* position, const float4* velocity, std::uint32_t n,
              const Cargos& cargos, const Gas& gas, glm::vec2 temperature_K, const Lens& lens, float gain) {
        CUDA_CHECK(cudaMemset(light_.data(), 0, light_.bytes()));
        if (n > 0) {
            sprite_kernel<<<grid::blocks_for(n, 128), 128>>>(light_.data(), position, velocity, n, cargos,
                                                             gas, temperature_K, glow_.data(), lens, gain,
                                                             Quantum{});
            CUDA_CHECK(cudaGetLastError());
        }
        const int pixels = lens.width * lens.height;
        sprite_light_kernel<<<(pixels + 127) / 128, 128>>>(seen, light_.data(), pixels);
        CUDA_CHECK(cudaGetLastError());
    }

  private:
    course::DeviceBuffer<float4> glow_;
    course::DeviceBuffer<unsigned long long> light_;
};

}  // namespace volume
