/// @file
/// What two marbles, or a marble and a wall, do to each other while they touch.
#pragma once
#include <cuda_runtime.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

/// Chapter 09: water made of marbles that push each other like springs.
namespace spring_mass {

/// Axis-parallel box that holds the marbles, in metres.
struct Box {
    float3 low_m, high_m;
};

//! [Material]
/// What the marbles are made of; all of them are equal. T: float in kernels, double in the reference.
template <class T>
struct MaterialOf {
    T diameter_m = T(0.015);
    T mass_kg = T(0.0044);
    T stiffness_N_per_m = 10000;     ///< kn: force for each metre of overlap
    T normal_damping_per_s = 0;      ///< gamma_n: how fast the dashpot takes the speed of approach
    T tangential_damping_per_s = 0;  ///< gamma_t: the same for sliding. 0: no shear term at all
    T friction = T(0.5);             ///< mu: shear never exceeds this fraction of the normal force
    T attraction_N_per_m = 0;        ///< pull of marbles that touch, for each metre between their centres
    T drag_per_s = 0;                ///< deceleration by the fluid around, for each m/s
    glm::vec<3, T> gravity_m_per_s2{0, T(-9.81), 0};
};
using Material = MaterialOf<float>;
//! [Material]

//! [contact_force]
/// Force in N on the first of two bodies in contact: LAMMPS's `gran/hooke` without rotation, and attraction.
/// @param normal   unit vector from the second to the first
/// @param overlap_m  how far they are pressed into each other, above 0
/// @param velocity_m_per_s  of the first relative to the second
/// @param reduced_mass_kg   m1 m2 / (m1 + m2): half a marble's mass for two of them, the whole at a wall
template <bool kShear, class T>
inline __host__ __device__ glm::vec<3, T> contact_force(const MaterialOf<T>& material, glm::vec<3, T> normal,
                                                        T overlap_m, glm::vec<3, T> velocity_m_per_s,
                                                        T reduced_mass_kg) {
    const T approach = glm::dot(velocity_m_per_s, normal);  // m/s, below 0 while they come closer
    const T push =
        material.stiffness_N_per_m * overlap_m - reduced_mass_kg * material.normal_damping_per_s * approach;
    glm::vec<3, T> force = push * normal;
    if constexpr (kShear) {
        const glm::vec<3, T> sliding = velocity_m_per_s - approach * normal;
        const T speed = glm::length(sliding);
        const T most = material.friction * (push < 0 ? -push : push);
        const T shear = reduced_mass_kg * material.tangential_damping_per_s * speed;
        if (speed > 0) force -= (shear < most ? shear : most) / speed * sliding;
    }
    return force;
}
//! [contact_force]

//! [pair_force]
/// Force on marble i by marble j, if they touch; nothing otherwise.
/// @param apart  x_i - x_j
/// @param i_first  which of the two comes first: tells two marbles at the very same place which way to go
template <bool kShear, bool kAttraction, class T>
inline __host__ __device__ glm::vec<3, T> pair_force(const MaterialOf<T>& material, glm::vec<3, T> apart,
                                                     glm::vec<3, T> velocity, bool i_first) {
    const T distance = glm::length(apart);
    const glm::vec<3, T> normal =
        distance > 0 ? apart / distance : glm::vec<3, T>(0, i_first ? T(-1) : T(1), 0);
    glm::vec<3, T> force = contact_force<kShear>(material, normal, material.diameter_m - distance, velocity,
                                                 material.mass_kg / 2);
    if constexpr (kAttraction) force -= material.attraction_N_per_m * apart;
    return force;
}
//! [pair_force]

//! [wall_force]
/// Force on a marble by the walls that it touches. Its overlap with a wall is its radius minus the distance
/// of its centre, so one whose centre has passed the wall is still pushed back inside.
template <bool kShear, class T>
inline __host__ __device__ glm::vec<3, T> wall_force(const MaterialOf<T>& material, glm::vec<3, T> low,
                                                     glm::vec<3, T> high, glm::vec<3, T> x,
                                                     glm::vec<3, T> velocity) {
    const T radius = material.diameter_m / 2;
    const glm::vec<3, T> over_low = radius - (x - low), over_high = radius - (high - x);
    glm::vec<3, T> force(0);
    const glm::vec<3, T> deepest = glm::max(over_low, over_high);
    if (!(deepest.x > 0 || deepest.y > 0 || deepest.z > 0)) return force;  // as for most marbles
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec<3, T> normal(0);
        normal[axis] = 1;
        if (over_low[axis] > 0)
            force += contact_force<kShear>(material, normal, over_low[axis], velocity, material.mass_kg);
        if (over_high[axis] > 0)
            force += contact_force<kShear>(material, -normal, over_high[axis], velocity, material.mass_kg);
    }
    return force;
}
//! [wall_force]

}  // namespace spring_mass
