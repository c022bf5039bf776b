/// @file
/// What this chapter measures: `--study NAME` and `--stability NAME`.
#pragma once
#include "10_water_sph/stability_maps.cuh"
#include "10_water_sph/study_flows.cuh"
#include "10_water_sph/study_front.cuh"
#include "10_water_sph/study_pbf.cuh"
#include "10_water_sph/study_precision.cuh"
#include "10_water_sph/study_speed.cuh"
#include "10_water_sph/study_stiffness.cuh"
#include "10_water_sph/study_support.cuh"
#include "10_water_sph/study_time_step.cuh"
#include "10_water_sph/study_walls.cuh"
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
    program.study({"floor", "Which floor carries a still column best?",
                   "pressure: rms of p - rho g d over layers / rho g H", "spacings_high"},
                  study_floor);
    program.study({"layers", "How far into the water does a floor put it in layers?",
                   "layering: rms of number of particles / mean - 1, in fifths of a spacing",
                   "distance_in_spacings", course::StudyPlot::error_against_time, false, true},
                  study_layers);
    program.study({"sound_speed", "How fine must water be for sound of a given length?",
                   "speed of sound: measured / c - 1", "spacings_in_wavelength"},
                  study_sound_speed);
    program.study({"poiseuille", "How fine must water between two plates be?",
                   "velocity: largest difference at five times / fastest velocity", "spacings_between_plates",
                   course::StudyPlot::error_against_time, true},
                  study_poiseuille);
    program.study({"taylor_green", "How much friction do particles add to the fluid's?",
                   "viscosity: that which slows the vortices / the fluid's - 1", "spacings_in_square",
                   course::StudyPlot::error_against_time, true},
                  study_taylor_green);
    program.study({"front", "How fine must a collapsing column be for its front to run as it does in nature?",
                   "speed of the front: relative difference from the measured one", "spacings_wide"},
                  study_front);
    program.study({"speed", "What does it bring to read neighbours in whole vectors?",
                   "acceleration: rms difference from the same sums in double, relative", "n",
                   course::StudyPlot::time_against_value, true},
                  study_speed);
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
