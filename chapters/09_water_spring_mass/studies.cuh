/// @file
/// What this chapter measures: `--study NAME` and `--stability NAME`.
#pragma once
#include "common/program.h"

namespace spring_mass {

inline void declare_studies(course::Program&) {}

}  // namespace spring_mass
