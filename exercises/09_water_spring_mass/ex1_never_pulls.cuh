// Exercise 09.1: a dashpot that never pulls.
//
// Towards the end of a contact the spring is nearly relaxed while the marbles already move apart: the dashpot
// of the lesson then pulls them back, as if they were sticky. Glass does not. With a force that is cut off
// where it would pull, the contact ends earlier, and the same dashpot takes less: a marble that came back
// with 0.163 of its speed (zeta = 0.5) comes back with 0.298 of it.
//
// Programs differ in which of the two they mean by damping, and so do books. Whoever compares restitutions
// has to say which.
#pragma once
#include <cmath>
#include <glm/geometric.hpp>

#include "09_water_spring_mass/contact.cuh"
#include "common/todo.h"

namespace spring_mass {

// The lesson's contact_force, with a spring and a dashpot that together push or do nothing, but never pull.
// Friction follows what is left: where nothing pushes, nothing rubs. Arguments as in the lesson.
template <class T>
inline __host__ __device__ glm::vec<3, T> clipped_contact_force(const MaterialOf<T>& material,
                                                                glm::vec<3, T> normal, T overlap_m,
                                                                glm::vec<3, T> velocity_m_per_s,
                                                                T reduced_mass_kg) {
    // TODO(9.1): spring and dashpot, clipped; then shear with its cap. About 10 lines.
    (void)material, (void)normal, (void)overlap_m, (void)velocity_m_per_s, (void)reduced_mass_kg;
    return glm::vec<3, T>(T(course::kTodo));
}

// The damping whose clipped contact gives back `restitution` of the speed, from the damping ratio zeta of
// below 1: e = exp(-zeta / sqrt(1 - zeta^2) (pi - 2 asin zeta)). That can't be solved for zeta with a pencil.
// @param restitution  from 0.15 to 1
// @returns zeta, correct to 1e-6
inline double clipped_damping_ratio(double restitution) {
    // TODO(9.1): e falls steadily as zeta grows: halve an interval that holds the answer. About 8 lines.
    (void)restitution;
    return course::kTodo;
}

}  // namespace spring_mass
