/// @file
/// What this chapter measures: `--study NAME`.
#pragma once
#include "common/program.h"

namespace surface {
inline void declare_studies(course::Program&) {}
}  // namespace surface
