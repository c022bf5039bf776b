/// @file
/// What this chapter measures: `--study NAME` and `--stability NAME`.
#pragma once
#include "10_water_sph/stability_maps.cuh"
#include "10_water_sph/study_pbf.cuh"
#include "10_water_sph/study_precision.cuh"
#include "10_water_sph/study_stiffness.cuh"
#include "10_water_sph/study_support.cuh"
#include "10_water_sph/study_time_step.cuh"
#include "common/program.h"

namespace sph {

inline void declare_studies(course::Program& program) {
    program.study({"support", "How much does a wider support buy?", "density: rms of summed / true - 1",
                   "support_in_spacings", course::StudyPlot::error_against_time, true},
                  study_support);
    program.study({"time_step", "Which time step keeps the particles where they should be?",
                   "position: rms distance from RK4 in double / amplitude", "dt_s",
                   course::StudyPlot::error_against_time, true},
                  study_time_step);
    program.study({"energy", "Which time step keeps the energy?",
                   "energy: difference from RK4 in double / energy at the start", "dt_s",
                   course::StudyPlot::error_against_time, true},
                  study_energy);
    program.study({"precision", "How far from the origin are floats enough?",
                   "acceleration: rms difference from double at the origin, relative", "distance_m",
                   course::StudyPlot::error_against_time, false, true},
                  study_precision);
    program.study({"stiffness", "What does it cost to let water give way less?",
                   "compression: rms of max(rho / rho0 - 1, 0)", "stiffness",
                   course::StudyPlot::error_against_time, true},
                  study_stiffness);
    program.study({"equation", "Which equation of state gives way less for the time it takes?",
                   "compression: rms of max(rho / rho0 - 1, 0)", "stiffness"},
                  study_equation);
    program.study({"pressure", "At equal compression, who is cheaper: an equation of state or PBF?",
                   "compression: rms of max(rho / rho0 - 1, 0)", "compression_allowed",
                   course::StudyPlot::error_against_time, true},
                  study_pressure);
    program.stability({"sound", "How large may a step be before sound explodes?", kStableWhen,
                       "leapfrog on a cubic lattice: 0.985 h / c", "sound speed c (m/s)"},
                      map_sound);
    program.stability({"viscosity", "How large may a step be before friction explodes?", kStableWhen,
                       "explicit steps on a cubic lattice: 0.1277 h^2 / nu", "viscosity nu (m^2/s)"},
                      map_viscosity);
    program.stability({"corrections", "How large may a step of position based fluids be?",
                       "dam break: no particle crosses its support in a step or is pressed to twice the rest "
                       "density, and the energy of motion and height stays below that of the start",
                       "advection: 0.4 h / (2 sqrt(g H))", "tolerance of the mean compression"},
                      map_corrections);
}

}  // namespace sph
