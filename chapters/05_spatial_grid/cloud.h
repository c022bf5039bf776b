/// @file
/// The particles that this chapter's programs and tests search: random points, the same for the same seed.
#pragma once
#include <Random123/philox.h>
#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace grid {

/// n points spread evenly over the unit cube: a point depends on the seed and its number only.
inline std::vector<float4> random_cloud(std::uint32_t n, std::uint64_t seed) {
    std::vector<float4> cloud;
    cloud.reserve(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
        const auto r = r123::Philox4x32()({{i, 0, 0, 0}}, key);
        const float unit = 1.0f / (1 << 24);  // the upper 24 bits: exact as a float, and below 1
        cloud.push_back(make_float4((r[0] >> 8) * unit, (r[1] >> 8) * unit, (r[2] >> 8) * unit, 0));
    }
    return cloud;
}

/// Radius within which a particle has about 30 neighbours: 30 = n * 4/3 pi r^3 in the unit cube.
inline float radius_for_30(std::uint32_t n) {
    return std::cbrt(30.0f * 3.0f / (4.0f * 3.14159265f * float(n)));
}

}  // namespace grid
