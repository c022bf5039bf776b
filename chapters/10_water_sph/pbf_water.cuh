/// @file
/// A body of water kept incompressible by position based fluids: its arrays, and the passes of a step.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "10_water_sph/pbf.cuh"
#include "10_water_sph/water.cuh"

namespace sph {

/// How a step of position based fluids went.
struct PbfReport {
    int corrections = 0;          ///< of all positions, beyond the prediction
    double mean_compression = 0;  ///< reached
    float highest_compression = 0;
};

//! [pbf_limit]
/// Largest time step for water whose fastest particle has that speed. Sound sets no limit: there is none.
/// Moving by more than 0.3 h brings particles together that have not seen each other coming. What gravity
/// does in a step, g dt^2, has to be undone by corrections: many when the step is long and the tolerance
/// tight. Here both are in proportion, so that two or three corrections do; a longer step costs more than it
/// saves.
inline float pbf_step_limit_s(const Fluid& fluid, float tolerance, float highest_speed_m_per_s) {
    const TimeStepLimit limit = time_step_limit(fluid);
    const float advection_s = 0.3f * fluid.support_m / highest_speed_m_per_s;
    return std::fmin(advection_s, std::fmin(2.4f * std::sqrt(tolerance) * limit.force_s, limit.viscosity_s));
}
//! [pbf_limit]

/// State of n particles on the device. Move-only.
class PbfWater {
  public:
    /// @param position, velocity  w is ignored. Positions lie in the box. Where they are too close together
    /// they are moved apart before the first step, which else would turn it into speed.
    /// @throws course::BadInput if the fluid, the box, a particle or a choice is not what a run can start
    /// from
    PbfWater(const Fluid& fluid, const Box& box, const PbfChoice& choice, const std::vector<float4>& position,
             const std::vector<float4>& velocity)
        : fluid_(checked(fluid, box, choice, position, velocity)),
          box_(box),
          choice_(choice),
          n_(std::uint32_t(position.size())),
          cells_(grid::make_grid({box.low_m.x, box.low_m.y, box.low_m.z},
                                 {box.high_m.x, box.high_m.y, box.high_m.z}, fluid.support_m,
                                 grid::max_cells_for(n_))),
          sort_(n_, cells_.cell_count()),
          position_(position),
          velocity_(velocity),
          sorted_(n_),
          columns_(n_),
          next_columns_(n_),
          velocity_columns_(is_viscous() ? n_ : 0),
          density_(n_),
          multiplier_(n_, grid::kLanes),
          change_(n_, grid::kLanes),
          id_(n_),
          sorted_id_(n_),
          summarize_(n_, summing_blocks(n_)) {
        // The support in spacings, which the lattice's sum wants, from the mass. Within the usual bounds,
        // since nothing keeps anybody from masses that no lattice has.
        const double spacing_m = std::cbrt(double(fluid.mass_kg) / fluid.rest_density_kg_per_m3);
        const double support = std::fmin(fluid.support_m / spacing_m, 4.0);
        least_norm_ = 0.5f * spiky_gradient_norm(std::fmax(support, 1.5));
        std::vector<std::uint32_t> ids(n_);
        for (std::uint32_t i = 0; i < n_; ++i) ids[i] = i;
        id_.upload(ids);
        if (n_ == 0) return;
        multiplier_.upload(std::vector<float>(n_, 0.0f));
        sort_by_cell();
        gather(position_, sorted_);  // a step writes all places anew; here there may be nothing to correct
        correct(0, 1);
        multiplier_.upload(std::vector<float>(n_, 0.0f));
    }

    //! [pbf_step]
    /// One step. It waits for the device after each correction, since the density decides whether there is
    /// another. A step of 0 s moves nothing.
    void step(float dt_s) {
        if (n_ == 0 || !(dt_s > 0)) return;
        sort_by_cell();
        // Pressure stays from step to step, and a multiplier is pressure times dt^2.
        const float ratio = last_dt_s_ > 0 ? dt_s / last_dt_s_ : 0;
        const float kept = choice_.kept * std::fmin(1.0f, ratio * ratio);
        // Velocities live in the middle between two places, as in leapfrog: from one middle to the next.
        const float gravity_dt_s = 0.5f * (last_dt_s_ + dt_s);
        const auto before = std::as_const(columns_).columns(),
                   moves = std::as_const(velocity_columns_).columns();
        if (is_viscous())
            predict_kernel<true><<<blocks(), kThreads>>>(
                next_columns_.columns(), position_.data(), velocity_.data(), before, moves,
                multiplier_.data(), kept, dt_s, gravity_dt_s, sort_.ranges(), cells_, fluid_, box_, n_);
        else
            predict_kernel<false><<<blocks(), kThreads>>>(
                next_columns_.columns(), position_.data(), velocity_.data(), before, moves,
                multiplier_.data(), kept, dt_s, gravity_dt_s, sort_.ranges(), cells_, fluid_, box_, n_);
        CUDA_CHECK(cudaGetLastError());
        std::swap(columns_, next_columns_);
        correct(1 / dt_s, kept);
        last_dt_s_ = dt_s;
    }
    //! [pbf_step]

    const PbfChoice& choice() const { return choice_; }
    const PbfReport& report() const { return report_; }
    /// Pressure of each particle in Pa, as the last step has used it: the last change was found, but it moves
    /// nobody before the next step.
    std::vector<float> pressures() const {
        std::vector<float> pressure = multiplier_.download();
        const std::vector<float> change = change_.download();
        for (std::size_t i = 0; i < pressure.size(); ++i)
            pressure[i] = last_dt_s_ > 0 ? (pressure[i] - change[i]) / (last_dt_s_ * last_dt_s_) : 0;
        return pressure;
    }

    /// Particles are kept sorted by cell; id()[k] is the number that the particle at place k was made with.
    std::uint32_t size() const { return n_; }
    const float4* position() const { return position_.data(); }
    const float4* velocity() const { return velocity_.data(); }
    const course::DeviceBuffer<float4>& positions() const { return position_; }
    const course::DeviceBuffer<float4>& velocities() const { return velocity_; }
    const course::DeviceBuffer<float>& densities() const { return density_; }
    const course::DeviceBuffer<float>& multipliers() const { return multiplier_; }
    const course::DeviceBuffer<std::uint32_t>& ids() const { return id_; }
    const Fluid& fluid() const { return fluid_; }
    const Box& box() const { return box_; }
    float least_norm() const { return least_norm_; }
    std::uint32_t cell_count() const { return cells_.cell_count(); }
    bool is_viscous() const { return fluid_.viscosity_m2_per_s > 0; }

    /// Bytes of device memory for each particle.
    static constexpr std::size_t bytes_per_particle(bool viscous) {
        return 3 * sizeof(float4) + 2 * sizeof(std::uint32_t) +       // state, and what sorting needs
               (numbers_per_particle(viscous) + 1) * sizeof(float) +  // what neighbours read; density
               2 * sizeof(std::uint32_t);                             // cell and order
    }
    std::size_t bytes_per_particle() const { return bytes_per_particle(is_viscous()); }
    /// Device memory beyond that: the grid's cells, and the ends of what neighbours read (grid::kLanes).
    std::size_t cell_bytes() const {
        return sort_.cell_bytes() +
               (n_ > 0 ? grid::kLanes * numbers_per_particle(is_viscous()) * sizeof(float) : 0);
    }
    /// And for the summary that decides whether there is another correction.
    std::size_t summary_bytes() const { return summarize_.bytes(); }

  private:
    static constexpr std::uint32_t kThreads = 128;
    /// Places now and next, multiplier and change; the velocity only if there is friction.
    static constexpr std::size_t numbers_per_particle(bool viscous) { return viscous ? 11 : 8; }
    /// 16 particles for each thread: a summary is little work, and the tree's barriers are not free.
    static std::uint32_t summing_blocks(std::uint32_t n) {
        return grid::blocks_for(n, 16 * patterns::kThreads);
    }
    std::uint32_t blocks() const { return grid::blocks_for(n_, kThreads); }

    static const Fluid& checked(const Fluid& fluid, const Box& box, const PbfChoice& choice,
                                const std::vector<float4>& position, const std::vector<float4>& velocity) {
        check_fluid(fluid);
        check_box(box, fluid.support_m);
        check_particles(position, velocity, box);
        if (!(choice.tolerance >= 0)) throw course::BadInput("the tolerance must be 0 or above");
        if (choice.max_corrections < 0) throw course::BadInput("the corrections must be 0 or more");
        for (const Wall wall : box.wall)
            if (wall != Wall::slip)
                throw course::BadInput("position based fluids know only walls that water glides along");
        if (!(choice.kept >= 0 && choice.kept <= 1))
            throw course::BadInput("the part of the pressure that is kept must be from 0 to 1");
        return fluid;
    }

    //! [pbf_correct]
    /// Measures the density and corrects the places, until the mean compression is within the tolerance. Once
    /// at least: a density within the tolerance may be one that the kept pressure has blown apart. So nobody
    /// asks for the mean before the first correction.
    void correct(float per_dt_per_s, float kept) {
        for (report_.corrections = 0;; ++report_.corrections) {
            const bool is_first = report_.corrections == 0,
                       is_last = report_.corrections == choice_.max_corrections;
            constraint_kernel<<<blocks(), kThreads>>>(
                density_.data(), multiplier_.data(), change_.data(), is_first ? kept : 1.0f,
                std::as_const(columns_).columns(), least_norm_, sort_.ranges(), cells_, fluid_, box_, n_);
            CUDA_CHECK(cudaGetLastError());
            if (!is_first || is_last) summarize();
            if (is_last || (!is_first && report_.mean_compression <= choice_.tolerance)) return;
            shift_kernel<<<blocks(), kThreads>>>(next_columns_.columns(), position_.data(), velocity_.data(),
                                                 std::as_const(columns_).columns(), change_.data(),
                                                 per_dt_per_s, sort_.ranges(), cells_, fluid_, box_, n_);
            CUDA_CHECK(cudaGetLastError());
            std::swap(columns_, next_columns_);
        }
    }
    //! [pbf_correct]

    void summarize() {
        summarize_(PbfSummariesOfOne{density_.data(), fluid_.rest_density_kg_per_m3}, n_);
        const PbfSummary all = summarize_.download();
        report_.mean_compression = all.compression_sum / n_;
        report_.highest_compression = all.highest_compression;
    }

    /// Brings particles of a cell together in memory, with what they keep from step to step, and makes
    /// columns of what their neighbours will read.
    void sort_by_cell() {
        sort_.build(position_.data(), cells_, n_);
        gather_columns(columns_, position_);
        if (is_viscous()) gather_columns(velocity_columns_, velocity_);
        gather(velocity_, sorted_);
        gather(multiplier_, change_);
        gather(id_, sorted_id_);
    }

    template <class T>
    void gather(course::DeviceBuffer<T>& data, course::DeviceBuffer<T>& sorted) {
        grid::gather_kernel<<<blocks(), kThreads>>>(sorted.data(), data.data(), sort_.order(), n_);
        CUDA_CHECK(cudaGetLastError());
        std::swap(data, sorted);
    }
    void gather_columns(grid::ColumnBuffer& sorted, const course::DeviceBuffer<float4>& data) {
        grid::gather_columns_kernel<<<blocks(), kThreads>>>(sorted.columns(), data.data(), sort_.order(), n_);
        CUDA_CHECK(cudaGetLastError());
    }

    Fluid fluid_;
    Box box_;
    PbfChoice choice_;
    std::uint32_t n_;
    grid::CellGrid cells_;
    grid::CountingSort sort_;
    course::DeviceBuffer<float4> position_, velocity_, sorted_;
    grid::ColumnBuffer columns_, next_columns_,
        velocity_columns_;  // of positions, now and next; of velocities
    course::DeviceBuffer<float> density_, multiplier_, change_;
    course::DeviceBuffer<std::uint32_t> id_, sorted_id_;
    patterns::TreeReduction<PbfSumming> summarize_;
    float least_norm_ = 0, last_dt_s_ = 0;
    PbfReport report_;
};

}  // namespace sph
