/// @file
/// Stability maps `sound` and `viscosity`: the largest time step that holds, in a lattice, for which theory
/// knows it, and in water that moves, for which nobody does.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "10_water_sph/run.cuh"
#include "10_water_sph/sph_cpu.h"
#include "10_water_sph/study_water.cuh"

namespace sph {

// Largest stable step of leapfrog with these kernels on a cubic lattice of support 2, from the eigenvalues of
// the lattice sums (reference values: tests/data/README.md, stability_limits).
constexpr double kLatticeSoundLimit = 0.985;       // h / c
constexpr double kLatticeViscosityLimit = 0.1277;  // h^2 / nu

constexpr const char* kStableWhen =
    "lattice: the rms speed stays below c / 100; dam break: no particle is as fast as sound or twice as "
    "dense as at "
    "rest, and the energy of motion and height stays below all energy of the start";

//! [lattice_is_stable]
/// A lattice, hardly shaken, without weight: theory's problem. Stable if the rms speed stays below c / 100,
/// some hundred times that of the shaking. Few steps: this lattice melts, at any dt. Poly6 and spiky are not
/// derived from one another, so some of its waves feel a force away from rest, and grow by a factor e in
/// about 6 h / c.
inline bool lattice_is_stable(Fluid fluid, float spacing_m, int per_edge, float dt_s, int steps) {
    LatticeBox lattice = lattice_box(per_edge, per_edge, per_edge, spacing_m);
    shake(lattice.position, 1e-4f * spacing_m);
    fluid.gravity_m_per_s2 = {0, 0, 0};
    fluid.lowest_pressure_Pa = -1e30f;
    Water water(fluid, lattice.box, EquationOfState::linear, lattice.position,
                at_rest(lattice.position.size()));
    Summarizer summarize(water.size());
    for (int step = 1; step <= steps; ++step) {
        water.step(dt_s);
        if (step % 10 != 0) continue;
        const Summary now = summarize(water);
        const double rms_speed = std::sqrt(2 * now.kinetic_J / (double(fluid.mass_kg) * water.size()));
        if (!(rms_speed < 0.01 * fluid.sound_speed_m_per_s)) return false;
    }
    return true;
}
//! [lattice_is_stable]

//! [dam_break_is_stable]
/// A small dam break, `time_s` long. Stable if it passes the program's own check, and if its
/// energy of motion and height never exceeds all the energy of its start, that of pressed particles included.
inline bool dam_break_is_stable(const Settings& settings, double time_s) {
    Start start = make_start(settings);
    const Water& water = start.water;
    Summarizer summarize(water.size());
    const auto density = water.densities().download();
    std::vector<double> pressed;  // only pressed water pushes: what is thinner stores no energy
    for (float rho : density) pressed.push_back(std::max(rho, water.fluid().rest_density_kg_per_m3));
    const double start_J =
        summarize(water).potential_J + energy_of(water.fluid(), points_of(at_rest(water.size())), pressed);
    const int steps = int(time_s / start.dt_s);
    for (int step = 1; step <= steps; ++step) {
        start.water.step(start.dt_s);
        if (step % 10 != 0 && step != steps) continue;
        const Summary now = summarize(water);
        // 2 %: these sums do not keep energy exactly, however small the step.
        if (!is_water(water.fluid(), now) || !(now.kinetic_J + now.potential_J < 1.02 * start_J))
            return false;
    }
    return true;
}
//! [dam_break_is_stable]

inline Settings dam_break_settings(bool quick) {
    Settings settings;
    settings.scene = find_scene(all_scenes(), "dam_break");
    settings.particles = quick ? 300 : 1000;
    return settings;
}

inline void map_sound(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<float> stiffness =
        map.quick ? std::vector<float>{0.7f, 2, 6} : std::vector<float>{0.7f, 1, 1.4f, 2, 4, 8};
    // 0.406 of theory is the program's own limit, 0.4 h / c.
    const std::vector<double> factors =
        map.quick ? std::vector<double>{0.406, 0.8, 0.97, 1.1, 1.5, 2}
                  : std::vector<double>{0.25, 0.406, 0.6, 0.7, 0.8, 0.9, 0.98, 1.02, 1.1, 1.25, 1.5, 1.75, 2};
    map.expect(2 * int(stiffness.size()));
    Settings settings = dam_break_settings(map.quick);
    for (const float factor : stiffness) {
        settings.choice.stiffness = factor;
        settings.dt_s = 0;
        const Start start = make_start(settings);
        Fluid fluid = start.water.fluid();
        fluid.viscosity_m2_per_s = 0;  // theory's lattice has none
        const double c = fluid.sound_speed_m_per_s, theory_s = kLatticeSoundLimit * fluid.support_m / c;
        map.column("lattice", c, theory_s, factors, map.quick ? 2 : 4, [&](double dt_s) {
            return lattice_is_stable(fluid, start.spacing_m, map.quick ? 6 : 10, float(dt_s), 40);
        });
        map.column("dam break", c, theory_s, factors, map.quick ? 2 : 4, [&](double dt_s) {
            settings.dt_s = float(dt_s);
            return dam_break_is_stable(settings, 0.6);  // s: to the far wall and up
        });
    }
}

inline void map_viscosity(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<float> viscosity =
        map.quick ? std::vector<float>{20, 60, 200} : std::vector<float>{20, 60, 200, 600};
    // 0.49 of theory is the program's own limit, 0.0625 h^2 / nu.
    const std::vector<double> factors =
        map.quick ? std::vector<double>{0.49, 0.7, 0.9, 1.1}
                  : std::vector<double>{0.25, 0.49, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.3};
    map.expect(2 * int(viscosity.size()));
    Settings settings = dam_break_settings(map.quick);
    for (const float factor : viscosity) {
        settings.choice.viscosity = factor;
        settings.dt_s = 0;
        const Start start = make_start(settings);
        const Fluid& fluid = start.water.fluid();
        const double nu = fluid.viscosity_m2_per_s, h = fluid.support_m,
                     theory_s = kLatticeViscosityLimit * h * h / nu;
        map.column("lattice", nu, theory_s, factors, map.quick ? 2 : 4, [&](double dt_s) {
            return lattice_is_stable(fluid, start.spacing_m, map.quick ? 6 : 10, float(dt_s), 400);
        });
        map.column("dam break", nu, theory_s, factors, map.quick ? 2 : 4, [&](double dt_s) {
            settings.dt_s = float(dt_s);
            return dam_break_is_stable(settings, 0.3);  // s: honey does not get far
        });
    }
}

}  // namespace sph
