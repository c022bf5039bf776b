/// @file
/// The picture on a sprite: a soft spot, torn into wisps by noise. Computed, not loaded.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace fire {

constexpr int kWispTile = 64;     // texels along a side of one wisp
constexpr int kWispsPerSide = 4;  // 16 different wisps: no two neighbours look alike
constexpr int kWispTexels = kWispTile * kWispsPerSide;

/// A number in [0, 1) for a lattice point (splitmix64's mixing).
inline float lattice_noise(int x, int y, int layer) {
    std::uint64_t z = std::uint64_t(std::uint32_t(x)) * 0x9E3779B97F4A7C15u +
                      std::uint64_t(std::uint32_t(y)) * 0xC2B2AE3D27D4EB4Fu +
                      std::uint64_t(layer) * 0x165667B19E3779F9u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return float((z ^ (z >> 31)) >> 40) * 0x1p-24f;
}

/// Smooth noise in [0, 1): lattice numbers, mixed with a smooth step.
inline float value_noise(float x, float y, int layer) {
    const float i = std::floor(x), j = std::floor(y);
    float u = x - i, v = y - j;
    u = u * u * (3 - 2 * u), v = v * v * (3 - 2 * v);
    const auto at = [&](int a, int b) { return lattice_noise(int(i) + a, int(j) + b, layer); };
    return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

//! [wisp]
/// How much of a wisp there is at (x, y), each from -1 to 1; y points along its flight. 0 at the rim.
inline float wisp_at(float x, float y, int number) {
    // Noise that is stretched along the flight, and bent by other noise.
    const float bend = 0.7f * (value_noise(1.5f * y + 5, 2 * x, 3 * number) - 0.5f);
    float sum = 0, weight = 0.5f;
    for (int octave = 0; octave < 3; ++octave, weight *= 0.5f) {
        const float scale = float(2 << octave);
        sum += weight *
               value_noise(1.6f * scale * (x + bend) + 7, 0.6f * scale * y + 7, 3 * number + 1 + 50 * octave);
    }
    const float noise = sum / 0.875f, d2 = x * x + y * y;
    return d2 < 1 ? noise * noise * 2.2f : 0.0f;
}
//! [wisp]

/// kWispTexels^2 texels, the wisps side by side; all four channels the same. Its mean over a wisp's spot is
/// about that of a smooth spot, so that `SpriteLook::wisps` changes the grain and not the brightness.
inline std::vector<glm::vec4> wisp_texture() {
    std::vector<glm::vec4> texels(std::size_t(kWispTexels) * kWispTexels);
    for (int j = 0; j < kWispTexels; ++j)
        for (int i = 0; i < kWispTexels; ++i) {
            const int number = j / kWispTile * kWispsPerSide + i / kWispTile;
            const auto centred = [](int k) { return (k % kWispTile + 0.5f) / (0.5f * kWispTile) - 1; };
            texels[std::size_t(j) * kWispTexels + i] = glm::vec4(wisp_at(centred(i), centred(j), number));
        }
    return texels;
}

}  // namespace fire
