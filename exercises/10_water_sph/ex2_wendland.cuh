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
    (void)r_m, (void)support_m;
    return T(course::kTodo);
}

// -dW/dr in 1/m^4, never negative, as spiky_slope is.
template <class T>
inline __host__ __device__ T wendland_slope(T r_m, T support_m) {
    // TODO(10.2): mind that r is not r / h: the chain rule has a factor for you. About 4 lines.
    (void)r_m, (void)support_m;
    return T(course::kTodo);
}

}  // namespace sph
