/// @file
/// Study `support`: how exact a density is for the neighbours that are paid for.
#pragma once
#include <cmath>
#include <vector>

#include "10_water_sph/study_water.cuh"

namespace sph {

//! [density_error]
/// Rms over all particles of summed density / true density - 1, when a particle's mass is taken as `mass_kg`.
inline double density_error(const Water& water, double mass_kg, double true_density) {
    double sum = 0;
    for (float rho : water.densities().download()) {
        const double error = rho / water.fluid().mass_kg * mass_kg / true_density - 1;
        sum += error * error;
    }
    return std::sqrt(sum / water.size());
}
//! [density_error]

/// A full closed box of water with one support radius.
struct FullBox {
    LatticeBox lattice;
    Fluid fluid;
    double true_density;  ///< what the box holds

    FullBox(float support, int per_edge)
        : lattice(lattice_box(per_edge, per_edge, per_edge)), fluid(lattice_fluid(support)) {
        true_density = fluid.rest_density_kg_per_m3;
        fluid.rest_density_kg_per_m3 *= 0.95f;  // pressed, as deep water is: without pressure it has no order
        fluid.viscosity_m2_per_s = 0.05f * fluid.support_m * fluid.sound_speed_m_per_s;  // comes to rest soon
    }
    /// Nothing is left of the lattice.
    std::vector<float4> shaken() const {
        std::vector<float4> position = lattice.position;
        shake(position, 0.5f * kLatticeSpacing);
        return position;
    }
    Water water(const std::vector<float4>& position) const {
        return Water(fluid, lattice.box, EquationOfState::linear, position, at_rest(position.size()));
    }
};

/// Errors of a perfect lattice, and of water that has found its own order. All have the steps that settling
/// takes.
inline void add_support(course::Study& study, float support, const FullBox& full,
                        const course::Timing& per_step, double time_s) {
    const float dt_s = time_step_limit(full.fluid).smallest_s();
    const int steps = int(std::ceil(time_s / dt_s));
    // The mass that is exact for an integral, and the one that is exact for the lattice.
    const double plain_mass = full.true_density * kLatticeSpacing * kLatticeSpacing * kLatticeSpacing;
    const auto add = [&](const char* method, const Water& water, double mass_kg) {
        study.add({method, support, double(water.size()), density_error(water, mass_kg, full.true_density),
                   per_step, double(steps)});
    };
    add("perfect lattice", full.water(full.lattice.position), plain_mass);
    Water settled = full.water(full.shaken());
    for (int step = 0; step < steps; ++step) settled.step(dt_s);
    add("settled water, plain mass", settled, plain_mass);
    add("settled water, mass by lattice", settled, full.fluid.mass_kg);
}

inline void study_support(course::Study& study) {
    course::on_device(study);
    const std::vector<float> supports =
        study.quick ? std::vector<float>{1.5f, 2, 2.5f, 3, 3.5f}
                    : std::vector<float>{1.5f, 1.75f, 2, 2.2f, 2.4f, 2.6f, 2.8f, 3, 3.25f, 3.5f};
    study.expect(3 * int(supports.size()));
    std::vector<FullBox> boxes;
    std::vector<Water> waters;
    for (const float support : supports) {
        boxes.emplace_back(support, study.quick ? 8 : 12);
        waters.push_back(boxes.back().water(boxes.back().shaken()));
    }
    const std::vector<course::Timing> per_step = time_steps(waters, study.quick ? 9 : 15);
    for (std::size_t k = 0; k < supports.size(); ++k)
        add_support(study, supports[k], boxes[k], per_step[k], study.quick ? 0.5 : 1.0);
}

}  // namespace sph
