/// @file
/// Arithmetic that CUDA has and C++ has not. The "fast" functions (__expf, ...) are exact here: what they
/// lose on a GPU does not show.
#pragma once
#include <cmath>

inline float rsqrtf(float x) {
    return 1.0f / sqrtf(x);
}
inline double rsqrt(double x) {
    return 1.0 / sqrt(x);
}
inline float norm3df(float x, float y, float z) {
    return sqrtf(x * x + y * y + z * z);
}
inline float rnorm3df(float x, float y, float z) {
    return 1.0f / norm3df(x, y, z);
}

inline float __expf(float x) {
    return expf(x);
}
inline float __logf(float x) {
    return logf(x);
}
inline float __log2f(float x) {
    return log2f(x);
}
inline float __powf(float x, float y) {
    return powf(x, y);
}
inline float __sinf(float x) {
    return sinf(x);
}
inline float __cosf(float x) {
    return cosf(x);
}
inline float __tanf(float x) {
    return tanf(x);
}
inline void __sincosf(float x, float* sine, float* cosine) {
    *sine = sinf(x);
    *cosine = cosf(x);
}
inline float __fdividef(float x, float y) {
    return x / y;
}
inline float __frsqrt_rn(float x) {
    return 1.0f / sqrtf(x);
}
inline float __fsqrt_rn(float x) {
    return sqrtf(x);
}
inline float __fdiv_rn(float x, float y) {
    return x / y;
}
inline float __fmaf_rn(float x, float y, float z) {
    return fmaf(x, y, z);
}
/// Cut to [0, 1]; a NaN becomes 0.
inline float __saturatef(float x) {
    return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}

// Rounded for themselves: the compiler may not contract them into a fused multiply-add. `volatile` keeps it
// from that, at the price of a trip through memory.
inline float __fmul_rn(float x, float y) {
    volatile float product = x * y;
    return product;
}
inline float __fadd_rn(float x, float y) {
    volatile float sum = x + y;
    return sum;
}
inline float __fsub_rn(float x, float y) {
    volatile float difference = x - y;
    return difference;
}

// Rounding to integers: down, up, nearest even, towards zero.
inline int __float2int_rd(float x) {
    return static_cast<int>(floorf(x));
}
inline int __float2int_ru(float x) {
    return static_cast<int>(ceilf(x));
}
inline int __float2int_rn(float x) {
    return static_cast<int>(rintf(x));
}
inline int __float2int_rz(float x) {
    return static_cast<int>(x);
}

inline int __mul24(int x, int y) {
    return x * y;
}
inline unsigned __umulhi(unsigned x, unsigned y) {
    return static_cast<unsigned>(static_cast<unsigned long long>(x) * y >> 32);
}
inline int __mulhi(int x, int y) {
    return static_cast<int>(static_cast<long long>(x) * y >> 32);
}

/// Load through the read-only cache: here a load.
template <class T>
T __ldg(const T* address) {
    return *address;
}
