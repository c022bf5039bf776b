/// @file
/// The smoothing kernels of Müller, Charypar and Gross, "Particle-Based Fluid Simulation for Interactive
/// Applications" (SCA 2003). All of them end at the *support radius* h, and all are written in q = r/h: the
/// published 315 / (64 pi h^9) overflows fp32 below h = 5.5e-5 m, while 1/h^3 times a function of q does not.
#pragma once
#include <cuda_runtime.h>

namespace sph {

constexpr double kPi = 3.14159265358979323846;

//! [kernels]
/// poly6, for the density: h^3 W as a function of q^2 (no square root needed). 0 beyond the support.
template <class T>
inline __host__ __device__ T poly6(T q_squared) {
    const T inside = T(1) - q_squared > T(0) ? T(1) - q_squared : T(0);
    return T(315.0 / (64.0 * kPi)) * inside * inside * inside;
}

/// spiky, for the pressure force: -h^4 dW/dr as a function of q. It grows towards q = 0, so that close
/// particles are still pushed apart; the slope of poly6 vanishes there.
template <class T>
inline __host__ __device__ T spiky_slope(T q) {
    const T inside = T(1) - q > T(0) ? T(1) - q : T(0);
    return T(45.0 / kPi) * inside * inside;
}

/// viscosity: h^5 times the Laplacian of W as a function of q. Positive everywhere, so viscosity only ever
/// brings velocities closer together.
template <class T>
inline __host__ __device__ T viscosity_laplacian(T q) {
    const T inside = T(1) - q > T(0) ? T(1) - q : T(0);
    return T(45.0 / kPi) * inside;
}
//! [kernels]

//! [lattice_density]
/// Density that a cubic lattice gets from poly6, relative to mass / spacing^3: a sum over points is not quite
/// the integral. Particles that fill space like the lattice have the rest density when their mass is divided
/// by this.
/// @param support_in_spacings  support radius / spacing of the lattice
inline double lattice_density(double support_in_spacings) {
    const int reach = int(support_in_spacings);
    double sum = 0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z)
                sum += poly6((x * x + y * y + z * z) / (support_in_spacings * support_in_spacings));
    return sum / (support_in_spacings * support_in_spacings * support_in_spacings);
}
//! [lattice_density]

}  // namespace sph
