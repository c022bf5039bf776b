/// @file
/// Sums of floats on the host: four ways to add the same numbers, which differ in what rounding leaves of the
/// result.
#pragma once
#include <cstddef>
#include <vector>

namespace patterns {

//! [naive]
/// One after the other. The larger the sum, the more of each new number is lost: once the sum is 2^24 times
/// as large as a number, adding the number changes nothing.
inline float sum_naive(const float* values, std::size_t n) {
    float sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += values[i];
    return sum;
}
//! [naive]

//! [pairwise]
/// Sum of one half plus sum of the other, and so on down to short pieces. Every number goes through log2(n)
/// additions instead of n, and numbers that meet are about equally large.
inline float sum_pairwise(const float* values, std::size_t n) {
    constexpr std::size_t kPiece = 64;  // short enough for little rounding, long enough to hide the calls
    if (n <= kPiece) return sum_naive(values, n);
    const std::size_t half = n / 2;
    return sum_pairwise(values, half) + sum_pairwise(values + half, n - half);
}
//! [pairwise]

//! [kahan]
/// One after the other, but what rounding cut off is computed and added with the next number. (Kahan, 1965.
/// With -ffast-math the compiler would simplify `lost` to 0.)
inline float sum_kahan(const float* values, std::size_t n) {
    float sum = 0, lost = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const float wanted = values[i] - lost;
        const float rounded = sum + wanted;
        lost = (rounded - sum) - wanted;  // what arrived, minus what should have arrived
        sum = rounded;
    }
    return sum;
}
//! [kahan]

//! [tree]
/// Level by level, as a block does it: the first half adds the second half, until one number is left. The
/// additions of a level have nothing to do with each other, so the CPU's vector unit does many at once.
/// @param scratch  at least (n + 1) / 2 numbers
inline float sum_tree(const float* values, std::size_t n, float* scratch) {
    if (n == 0) return 0;
    const float* from = values;
    for (std::size_t left = n; left > 1;) {
        const std::size_t half = (left + 1) / 2;
        for (std::size_t i = 0; i < left / 2; ++i) scratch[i] = from[i] + from[i + half];
        if (left % 2) scratch[half - 1] = from[half - 1];  // the middle one has no partner
        from = scratch;
        left = half;
    }
    return from[0];
}
//! [tree]

/// One after the other, in double: 29 bits more.
inline double sum_double(const float* values, std::size_t n) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += values[i];
    return sum;
}

}  // namespace patterns
