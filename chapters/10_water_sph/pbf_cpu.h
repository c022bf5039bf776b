/// @file
/// CPU reference of position based fluids: every pair, in the precision asked for.
#pragma once
#include <algorithm>
#include <vector>

#include "10_water_sph/pbf.cuh"
#include "10_water_sph/sph_cpu.h"

namespace sph {

//! [pbf_cpu]
/// Particles, and the multipliers that keep them apart.
template <class T>
struct PbfState {
    Points<T> position, velocity;
    std::vector<T> multiplier, density;
};

/// Shift of each particle by these multipliers: the sum that predict_kernel and shift_kernel share.
template <class T>
Points<T> shift_cpu(const Points<T>& position, const std::vector<T>& multiplier, const Fluid& fluid,
                    const Box& box) {
    const T h = fluid.support_m, m = fluid.mass_kg, rho0 = fluid.rest_density_kg_per_m3;
    const auto others = with_images(position, position, box);
    Points<T> shift;
    for (std::size_t i = 0; i < position.size(); ++i) {
        glm::vec<3, T> sum(0);
        for (const Mirrored<T>& other : others) {
            const glm::vec<3, T> d = position[i] - other.position_m;
            const T r = distance(d);
            if (r > 0) sum += (multiplier[i] + multiplier[other.particle]) * spiky_slope(r / h) * (d / r);
        }
        shift.push_back(m / (rho0 * rho0) / (h * h * h * h) * sum);
    }
    return shift;
}

/// Moves by the shift times `velocity_per_shift` as velocity; the walls stop what would leave.
template <class T>
void move_cpu(PbfState<T>& state, const Points<T>& shift, T velocity_per_shift, const Box& box) {
    const glm::vec<3, T> low(box.low_m.x, box.low_m.y, box.low_m.z),
        high(box.high_m.x, box.high_m.y, box.high_m.z);
    for (std::size_t i = 0; i < shift.size(); ++i) {
        state.position[i] += shift[i];
        state.velocity[i] += velocity_per_shift * shift[i];
        for (int axis = 0; axis < 3; ++axis) {
            T& x = state.position[i][axis];
            if (x < low[axis] || x > high[axis]) state.velocity[i][axis] = 0;
            x = std::clamp(x, low[axis], high[axis]);
        }
    }
}

/// Densities, and the changes that bring them to rest; the multipliers change with them.
template <class T>
std::vector<T> constraint_cpu(PbfState<T>& state, T kept, T least_norm, const Fluid& fluid, const Box& box) {
    const T h = fluid.support_m, rho0 = fluid.rest_density_kg_per_m3, scale = fluid.mass_kg / rho0;
    state.density = density_cpu(state.position, fluid, box);
    const auto others = with_images(state.position, state.position, box);
    std::vector<T> change;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        glm::vec<3, T> gradient(0);
        T squares = 0;
        for (const Mirrored<T>& other : others) {
            const glm::vec<3, T> d = state.position[i] - other.position_m;
            const T r = distance(d), slope = spiky_slope(r / h);
            if (!(r > 0)) continue;
            gradient += slope * (d / r);
            squares += slope * slope;
        }
        const T norm = std::max(least_norm, glm::dot(gradient, gradient) + squares);
        const T response = scale * scale / (h * h * h * h * h * h * h * h) * norm;
        const T start = kept * state.multiplier[i];
        change.push_back(std::max(-start, T(kPbfRelaxation) * (state.density[i] - rho0) / response));
        state.multiplier[i] = start + change[i];
    }
    return change;
}

/// One step with exactly so many corrections; the step before it took as long.
template <class T>
void pbf_step_cpu(PbfState<T>& state, T dt_s, T gravity_dt_s, T kept, int corrections, T least_norm,
                  const Fluid& fluid, const Box& box) {
    const T h = fluid.support_m, nu = fluid.viscosity_m2_per_s;
    const Points<T> pushed = shift_cpu(state.position, state.multiplier, fluid, box);
    const auto others = with_images(state.position, state.velocity, box);
    Points<T> travel, velocity = state.velocity;
    for (std::size_t i = 0; i < pushed.size(); ++i) {
        glm::vec<3, T> drag(0);
        for (const Mirrored<T>& other : others)
            drag += viscosity_laplacian(distance(state.position[i] - other.position_m) / h) *
                    (other.velocity_m_per_s - state.velocity[i]);
        const glm::vec<3, T> g(fluid.gravity_m_per_s2.x, fluid.gravity_m_per_s2.y, fluid.gravity_m_per_s2.z);
        velocity[i] += gravity_dt_s * (g + nu * T(fluid.mass_kg) / T(fluid.rest_density_kg_per_m3) /
                                               (h * h * h * h * h) * drag);
        velocity[i] += kept / dt_s * pushed[i];
        travel.push_back(dt_s * velocity[i]);
    }
    state.velocity = velocity;
    move_cpu(state, travel, T(0), box);
    for (int k = 0;; ++k) {
        const std::vector<T> change = constraint_cpu(state, k == 0 ? kept : T(1), least_norm, fluid, box);
        if (k == corrections) return;
        move_cpu(state, shift_cpu(state.position, change, fluid, box), 1 / dt_s, box);
    }
}
//! [pbf_cpu]

}  // namespace sph
