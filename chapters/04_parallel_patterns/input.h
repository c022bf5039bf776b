/// @file
/// What the patterns work on: random numbers, the same for the same seed.
#pragma once
#include <Random123/philox.h>
#include <cuda_runtime.h>

#include <cstdint>
#include <vector>

#include "04_parallel_patterns/histogram.cuh"

namespace patterns {

/// The same n elements in the three shapes that the patterns need.
struct Input {
    std::vector<std::uint32_t> numbers;  ///< from 0 to 9, half of them 0
    std::vector<std::uint32_t> bins;     ///< below kBins
    std::vector<float4> positions;       ///< between -1 and 1 along each axis

    std::uint32_t n() const { return std::uint32_t(numbers.size()); }
};

inline Input random_input(std::uint32_t n, std::uint64_t seed) {
    Input input;
    input.numbers.reserve(n);
    input.bins.reserve(n);
    input.positions.reserve(n);
    const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto r = r123::Philox4x32()({{i, 0, 0, 0}}, key);
        const auto coordinate = [](std::uint32_t bits) { return float(bits >> 8) / (1 << 23) - 1.0f; };
        input.numbers.push_back(r[3] % 2 ? 0 : 1 + (r[3] >> 8) % 9);
        input.bins.push_back(r[3] >> 24);
        input.positions.push_back(make_float4(coordinate(r[0]), coordinate(r[1]), coordinate(r[2]), 0));
    }
    return input;
}

}  // namespace patterns
