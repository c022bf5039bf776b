/// @file
/// A body of water: its arrays on the device, and the passes of one time step in their order.
#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "10_water_sph/check_input.h"
#include "10_water_sph/sph.cuh"
#include "common/device_buffer.h"

namespace sph {

//! [time_step_limit]
/// Largest time steps, each from what it must not skip; the smallest one rules. With h the support radius,
/// 0.4 and 0.25 are the usual coefficients of weakly compressible SPH. Its usual 0.125 for the viscosity is
/// too much here: a lattice of these kernels becomes unstable at 0.128, and moving water before that. Half of
/// it holds.
struct TimeStepLimit {
    float sound_s;      ///< 0.4 h / c: sound crosses the support
    float viscosity_s;  ///< 0.0625 h^2 / nu: velocity diffuses across it (infinite without viscosity)
    float force_s;      ///< 0.25 sqrt(h / g): gravity moves a particle across it

    float smallest_s() const { return std::fmin(sound_s, std::fmin(viscosity_s, force_s)); }
};

inline TimeStepLimit time_step_limit(const Fluid& fluid) {
    const float h = fluid.support_m;
    const glm::vec3 g(fluid.gravity_m_per_s2.x, fluid.gravity_m_per_s2.y, fluid.gravity_m_per_s2.z);
    return {0.4f * h / fluid.sound_speed_m_per_s, 0.0625f * h * h / fluid.viscosity_m2_per_s,
            0.25f * std::sqrt(h / glm::length(g))};
}
//! [time_step_limit]

/// The arrays of a body of water, n elements each, as something else in the same tank sees them.
struct WaterArrays {
    float4 *position, *velocity;
    float *density, *pressure_term;  ///< pressure_term: p / rho^2
    std::uint32_t n;
};

/// Nothing else in the tank.
struct NoGuest {
    /// Particles have moved; velocity is the one they moved with. May change both.
    void after_drift(WaterArrays) {}
    /// Densities and pressures are those of the water alone. May change both, before they become forces.
    void after_density(WaterArrays) {}
};

/// State of n particles on the device. Move-only.
class Water {
  public:
    /// @param position, velocity  w is ignored. Positions lie in the box.
    /// @throws course::BadInput if the fluid, the box or a particle is not what a run can start from
    Water(const Fluid& fluid, const Box& box, EquationOfState state, const std::vector<float4>& position,
          const std::vector<float4>& velocity)
        : fluid_(checked(fluid, box, position, velocity)),
          box_(box),
          state_(state),
          n_(std::uint32_t(position.size())),
          cells_(fixed_grid()),
          sort_(n_, cells_.cell_count()),
          position_(position),
          velocity_(velocity),
          sorted_position_(n_),
          sorted_velocity_(n_),
          acceleration_(n_),
          density_(n_),
          pressure_term_(n_),
          id_(n_),
          sorted_id_(n_) {
        std::vector<std::uint32_t> ids(n_);
        for (std::uint32_t i = 0; i < n_; ++i) ids[i] = i;
        id_.upload(ids);
        compute_acceleration(NoGuest{});
    }

    //! [step]
    /// One leapfrog step (kick, drift, kick). Waits for nothing: errors of the kernels show at the next copy.
    /// @param guest  what else is in the tank: see NoGuest
    template <class Guest = NoGuest>
    void step(float dt_s, Guest&& guest = {}) {
        if (n_ == 0) return;
        kick_drift_kernel<<<blocks(), kThreads>>>(position_.data(), velocity_.data(), acceleration_.data(),
                                                  dt_s, box_, n_);
        CUDA_CHECK(cudaGetLastError());
        guest.after_drift(arrays());
        compute_acceleration(guest);
        kick_kernel<<<blocks(), kThreads>>>(velocity_.data(), acceleration_.data(), dt_s, n_);
        CUDA_CHECK(cudaGetLastError());
    }
    //! [step]

    /// Particles are kept sorted by cell; id()[k] is the number that the particle at place k was made with.
    std::uint32_t size() const { return n_; }
    const float4* position() const { return position_.data(); }
    const float4* velocity() const { return velocity_.data(); }
    const course::DeviceBuffer<float4>& positions() const { return position_; }
    const course::DeviceBuffer<float4>& velocities() const { return velocity_; }
    const course::DeviceBuffer<float4>& accelerations() const { return acceleration_; }
    const course::DeviceBuffer<float>& densities() const { return density_; }
    const course::DeviceBuffer<std::uint32_t>& ids() const { return id_; }
    const Fluid& fluid() const { return fluid_; }
    const Box& box() const { return box_; }
    EquationOfState state() const { return state_; }
    std::uint32_t cell_count() const { return cells_.cell_count(); }
    std::size_t cell_bytes() const { return sort_.cell_bytes(); }

    /// Bytes of device memory per particle, the grid's cells not counted.
    static constexpr std::size_t kBytesPerParticle = 2 * 2 * sizeof(float4) + sizeof(float4) +
                                                     2 * sizeof(float) + 2 * sizeof(std::uint32_t) +  // state
                                                     2 * sizeof(std::uint32_t);  // cell and order

  private:
    static constexpr std::uint32_t kThreads = 128;
    std::uint32_t blocks() const { return grid::blocks_for(n_, kThreads); }

    /// Before any member is made: a grid for a support radius of 0 would never be done.
    static const Fluid& checked(const Fluid& fluid, const Box& box, const std::vector<float4>& position,
                                const std::vector<float4>& velocity) {
        check_fluid(fluid);
        check_box(box, fluid.support_m);
        check_particles(position, velocity, box);
        return fluid;
    }

    /// The box does not move, so neither does the grid: no pass over the particles to find their bounds.
    grid::CellGrid fixed_grid() const {
        return grid::make_grid({box_.low_m.x, box_.low_m.y, box_.low_m.z},
                               {box_.high_m.x, box_.high_m.y, box_.high_m.z}, fluid_.support_m,
                               grid::max_cells_for(n_));
    }

    WaterArrays arrays() {
        return {position_.data(), velocity_.data(), density_.data(), pressure_term_.data(), n_};
    }

    //! [passes]
    template <class Guest>
    void compute_acceleration(Guest&& guest) {
        if (n_ == 0) return;
        sort_by_cell();
        switch (state_) {
            case EquationOfState::linear:
                density_kernel<EquationOfState::linear>
                    <<<blocks(), kThreads>>>(density_.data(), pressure_term_.data(), position_.data(),
                                             sort_.ranges(), cells_, fluid_, box_, n_);
                break;
            case EquationOfState::tait:
                density_kernel<EquationOfState::tait>
                    <<<blocks(), kThreads>>>(density_.data(), pressure_term_.data(), position_.data(),
                                             sort_.ranges(), cells_, fluid_, box_, n_);
                break;
        }
        CUDA_CHECK(cudaGetLastError());
        guest.after_density(arrays());
        // Without viscosity its term is not multiplied by zero: it is not in the kernel.
        if (fluid_.viscosity_m2_per_s > 0)
            force_kernel<true><<<blocks(), kThreads>>>(
                acceleration_.data(), position_.data(), velocity_.data(), density_.data(),
                pressure_term_.data(), sort_.ranges(), cells_, fluid_, box_, n_);
        else
            force_kernel<false><<<blocks(), kThreads>>>(
                acceleration_.data(), position_.data(), velocity_.data(), density_.data(),
                pressure_term_.data(), sort_.ranges(), cells_, fluid_, box_, n_);
        CUDA_CHECK(cudaGetLastError());
    }

    /// Brings particles of a cell together in memory. Accelerations are made anew, so they need not move.
    void sort_by_cell() {
        sort_.build(position_.data(), cells_, n_);
        grid::gather_kernel<<<blocks(), kThreads>>>(sorted_position_.data(), position_.data(), sort_.order(),
                                                    n_);
        CUDA_CHECK(cudaGetLastError());
        grid::gather_kernel<<<blocks(), kThreads>>>(sorted_velocity_.data(), velocity_.data(), sort_.order(),
                                                    n_);
        CUDA_CHECK(cudaGetLastError());
        grid::gather_kernel<<<blocks(), kThreads>>>(sorted_id_.data(), id_.data(), sort_.order(), n_);
        CUDA_CHECK(cudaGetLastError());
        std::swap(position_, sorted_position_);
        std::swap(velocity_, sorted_velocity_);
        std::swap(id_, sorted_id_);
    }
    //! [passes]

    Fluid fluid_;
    Box box_;
    EquationOfState state_;
    std::uint32_t n_;
    grid::CellGrid cells_;
    grid::CountingSort sort_;
    course::DeviceBuffer<float4> position_, velocity_, sorted_position_, sorted_velocity_, acceleration_;
    course::DeviceBuffer<float> density_, pressure_term_;
    course::DeviceBuffer<std::uint32_t> id_, sorted_id_;
};

}  // namespace sph
