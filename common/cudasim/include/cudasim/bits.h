/// @file
/// Intrinsics that count and turn bits, or read a number's bits as another type.
#pragma once
#include <cstring>

namespace cudasim {
template <class To, class From>
To bit_cast(From value) {
    static_assert(sizeof(To) == sizeof(From));
    To result;
    std::memcpy(&result, &value, sizeof result);
    return result;
}
}  // namespace cudasim

inline int __popc(unsigned x) {
    return __builtin_popcount(x);
}
inline int __popcll(unsigned long long x) {
    return __builtin_popcountll(x);
}
inline int __clz(int x) {
    return x == 0 ? 32 : __builtin_clz(static_cast<unsigned>(x));
}
inline int __clzll(long long x) {
    return x == 0 ? 64 : __builtin_clzll(static_cast<unsigned long long>(x));
}
inline int __ffs(int x) {
    return __builtin_ffs(x);
}
inline int __ffsll(long long x) {
    return __builtin_ffsll(x);
}
inline unsigned __brev(unsigned x) {
    unsigned reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= (x >> bit & 1u) << (31 - bit);
    return reversed;
}

inline int __float_as_int(float x) {
    return cudasim::bit_cast<int>(x);
}
inline unsigned __float_as_uint(float x) {
    return cudasim::bit_cast<unsigned>(x);
}
inline float __int_as_float(int x) {
    return cudasim::bit_cast<float>(x);
}
inline float __uint_as_float(unsigned x) {
    return cudasim::bit_cast<float>(x);
}
inline long long __double_as_longlong(double x) {
    return cudasim::bit_cast<long long>(x);
}
inline double __longlong_as_double(long long x) {
    return cudasim::bit_cast<double>(x);
}
