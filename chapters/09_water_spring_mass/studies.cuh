/// @file
/// What this chapter measures: `--study NAME` and `--stability NAME`.
#pragma once
#include "09_water_spring_mass/stability_maps.cuh"
#include "09_water_spring_mass/study_rivals.cuh"
#include "09_water_spring_mass/study_steps.cuh"
#include "common/program.h"

namespace spring_mass {

inline void declare_studies(course::Program& program) {
    using course::StudyPlot;
    program.study({"bounce", "How many steps does a collision need?",
                   "restitution: rms difference from the closed form, over all phases of the step", "dt_s",
                   StudyPlot::error_against_time, true},
                  study_bounce);
    program.study({"energy", "Which time step keeps the energy of marbles that lose none?",
                   "energy: largest difference from that of the start, relative", "dt_s"},
                  study_energy);
    program.study(
        {"overlap", "What does it cost to let marbles give way less?",
         "deepest overlap of two marbles, in diameters", "stiffness", StudyPlot::error_against_time, true},
        study_overlap);
    program.study({"skin", "How thick should the skin of the neighbour list be?",
                   "none: the motion is the same", "skin_in_diameters", StudyPlot::time_against_value, true},
                  study_skin);
    program.study({"rivals", "Is it as fast as LAMMPS?", "none: the same force law", "n",
                   StudyPlot::time_against_value, false, true},
                  study_rivals);
    program.stability(
        {"stiffness", "How large may a step be before springs explode?", kStableWhen,
         "leapfrog: 2 / omega of the stiffest wave: pair 1.414, chain 1, fcc (and the dam break) "
         "0.707 times sqrt(m / k)",
         "stiffness k (N/m)"},
        map_stiffness);
    program.stability({"damping", "How much shorter must a step be for dashpots?", kStableWhen,
                       "(omega dt)^2 + 2 damping dt = 4 for the waves of fcc", "normal damping (1/s)"},
                      map_damping);
}

}  // namespace spring_mass
