/// @file
/// CUDA's small vectors (float4, int2, ...), with the sizes and alignments they have on the device, and dim3.
#pragma once

// Two and four elements are aligned so that a GPU thread reads them in one go; one and three are not.
#define CUDASIM_VECTORS(T, name)                                 \
    struct name##1 {                                             \
        T x;                                                     \
    };                                                           \
    struct alignas(2 * sizeof(T)) name##2 {                      \
        T x, y;                                                  \
    };                                                           \
    struct name##3 {                                             \
        T x, y, z;                                               \
    };                                                           \
    struct alignas(sizeof(T) < 4 ? 4 * sizeof(T) : 16) name##4 { \
        T x, y, z, w;                                            \
    };                                                           \
    constexpr name##1 make_##name##1(T x) {                      \
        return {x};                                              \
    }                                                            \
    constexpr name##2 make_##name##2(T x, T y) {                 \
        return {x, y};                                           \
    }                                                            \
    constexpr name##3 make_##name##3(T x, T y, T z) {            \
        return {x, y, z};                                        \
    }                                                            \
    constexpr name##4 make_##name##4(T x, T y, T z, T w) {       \
        return {x, y, z, w};                                     \
    }

CUDASIM_VECTORS(signed char, char)
CUDASIM_VECTORS(unsigned char, uchar)
CUDASIM_VECTORS(short, short)
CUDASIM_VECTORS(unsigned short, ushort)
CUDASIM_VECTORS(int, int)
CUDASIM_VECTORS(unsigned int, uint)
CUDASIM_VECTORS(long long, longlong)
CUDASIM_VECTORS(unsigned long long, ulonglong)
CUDASIM_VECTORS(float, float)
CUDASIM_VECTORS(double, double)
#undef CUDASIM_VECTORS

static_assert(sizeof(float3) == 12 && alignof(float2) == 8 && alignof(float4) == 16 && alignof(uchar4) == 4);

/// Size of a grid or block; what is not given is 1.
struct dim3 {
    unsigned x, y, z;
    constexpr dim3(unsigned x_ = 1, unsigned y_ = 1, unsigned z_ = 1) : x(x_), y(y_), z(z_) {}
    constexpr dim3(uint3 v) : x(v.x), y(v.y), z(v.z) {}
    constexpr operator uint3() const { return {x, y, z}; }
};
