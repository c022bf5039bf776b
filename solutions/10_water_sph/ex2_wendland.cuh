// Exercise 10.2: Wendland's kernel.
//
// poly6 gives the density and spiky the force, since neither is good at both. Wendland's C2 function (1995)
// can do both. It is often written with a smoothing length l and a support of *two* l:
//
//     W(r) = 21 / (16 pi l^3) (1 - q/2)^4 (1 + 2 q),   q = r / l,   0 for q > 2
//
// The lesson counts in support radii. A kernel taken over from elsewhere goes wrong just there.
#pragma once
#include "10_water_sph/smoothing_kernels.cuh"
#include "common/todo.h"

namespace sph {

// W in 1/m^3 at a distance of r_m >= 0; 0 beyond support_m. T: float in kernels, double in references.
template <class T>
inline __host__ __device__ T wendland(T r_m, T support_m) {
    // TODO(10.2): first on paper, as 1/h^3 times a function of r / h, where h is the support. About 4 lines.
    // <solution>
    const T q = r_m / support_m;
    const T inside = T(1) - q > T(0) ? T(1) - q : T(0);
    const T inside_squared = inside * inside;
    return T(21.0 / (2.0 * kPi)) * inside_squared * inside_squared * (T(1) + T(4) * q) /
           (support_m * support_m * support_m);
    // <stub>
    //| (void)r_m, (void)support_m;
    //| return T(course::kTodo);
    // </solution>
}

// -dW/dr in 1/m^4, never negative, as spiky_slope is.
template <class T>
inline __host__ __device__ T wendland_slope(T r_m, T support_m) {
    // TODO(10.2): mind that r is not r / h: the chain rule has a factor for you. About 4 lines.
    // <solution>
    const T q = r_m / support_m;
    const T inside = T(1) - q > T(0) ? T(1) - q : T(0);
    const T support_squared_m2 = support_m * support_m;
    return T(210.0 / kPi) * q * inside * inside * inside / (support_squared_m2 * support_squared_m2);
    // <stub>
    //| (void)r_m, (void)support_m;
    //| return T(course::kTodo);
    // </solution>
}

}  // namespace sph
