/// @file
/// Stability maps `stiffness` and `damping`: the largest time step that holds, in packings, for which theory
/// knows it, and in marbles that move, for which nobody does.
#pragma once
#include <string>
#include <vector>

#include "09_water_spring_mass/packings.cuh"
#include "09_water_spring_mass/run.cuh"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace spring_mass {

constexpr const char* kStableWhen =
    "packings: no marble goes further than 30 times the shake at the start; dam break: the check of the "
    "program finds nothing in 0.5 s";

//! [dam_break_is_stable]
/// A small dam break, 0.5 s long. Stable if it passes the program's own check every ten steps.
inline bool dam_break_is_stable(Start start) {
    Summarizer summarize(start.marbles.size());
    const double start_J = summarize(start.marbles).energy_J();
    try {
        for (int step = 1; step * start.dt_s < 0.5f; ++step) {
            start.marbles.step(start.dt_s);
            if (step % 10 == 0)
                check_state(start.marbles, summarize(start.marbles), start_J, step, start.dt_s);
        }
    } catch (const course::Unstable&) {
        return false;
    }
    return true;
}
//! [dam_break_is_stable]

inline Settings dam_break_settings(bool quick) {
    Settings settings;
    settings.scene = find_scene(all_scenes(), "dam_break");
    settings.particles = quick ? 500 : 2000;
    return settings;
}

inline std::vector<double> step_factors(bool quick) {
    // 0.5 of theory is the program's own step.
    return quick ? std::vector<double>{0.5, 0.9, 1.1, 1.6}
                 : std::vector<double>{0.25, 0.5, 0.7, 0.8, 0.9, 0.98, 1.02, 1.1, 1.25, 1.5};
}

inline void map_stiffness(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<float> factors =
        map.quick ? std::vector<float>{0.1f, 1, 10} : std::vector<float>{0.03f, 0.1f, 0.3f, 1, 3, 10, 30};
    map.expect(4 * int(factors.size()));
    for (const float factor : factors) {
        Settings settings = dam_break_settings(map.quick);
        settings.scene.touch.stiffness = factor;
        settings.scene.touch.restitution = 1;  // springs alone
        const Start start = make_start(settings);
        const Material material = start.marbles.material();
        const double k = material.stiffness_N_per_m;
        for (const auto& [name, packing] :
             {std::pair{"pair", Packing::pair}, std::pair{"chain", Packing::chain},
              std::pair{"fcc", Packing::fcc}}) {
            Lattice lattice = packed(packing, k / 1.02);  // springs k + a of the same stiffness, and the mass
            lattice.material.mass_kg = material.mass_kg;
            const double theory_s = time_step_limit_s(lattice.material, packing);
            map.column(name, k, theory_s, step_factors(map.quick), map.quick ? 2 : 5,
                       [&](double dt_s) { return stays_small(lattice, dt_s, 300); });
        }
        map.column("dam break", k, time_step_limit_s(material), step_factors(map.quick), map.quick ? 2 : 4,
                   [&](double dt_s) {
                       settings.dt_s = float(dt_s);
                       return dam_break_is_stable(make_start(settings));
                   });
    }
}

inline void map_damping(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<float> restitutions = map.quick ? std::vector<float>{0.9f, 0.3f, 0.02f}
                                                      : std::vector<float>{0.95f, 0.8f, 0.5f, 0.2f, 0.02f};
    map.expect(2 * int(restitutions.size()));
    for (const float restitution : restitutions) {
        Settings settings = dam_break_settings(map.quick);
        settings.scene.touch.restitution = restitution;
        settings.scene.touch.friction = 0.3f;
        const Start start = make_start(settings);
        const Material material = start.marbles.material();
        Lattice lattice = packed(Packing::fcc, material.stiffness_N_per_m / 1.02);
        lattice.material.mass_kg = material.mass_kg;
        lattice.material.normal_damping_per_s = material.normal_damping_per_s;
        lattice.material.tangential_damping_per_s = material.tangential_damping_per_s;
        const double damping = material.normal_damping_per_s;
        map.column("fcc", damping, time_step_limit_s(lattice.material), step_factors(map.quick),
                   map.quick ? 2 : 5, [&](double dt_s) { return stays_small(lattice, dt_s, 600); });
        map.column("dam break", damping, time_step_limit_s(material), step_factors(map.quick),
                   map.quick ? 2 : 4, [&](double dt_s) {
                       settings.dt_s = float(dt_s);
                       return dam_break_is_stable(make_start(settings));
                   });
    }
}

}  // namespace spring_mass
