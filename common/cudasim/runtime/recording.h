/// @file
/// Tells the recordings that are alive what happens.
#pragma once
#include <cstddef>

#include "cudasim.h"

namespace cudasim {

void note_launch(const LaunchRequest& request);
/// Of the launch that was noted last.
void note_counts(const Counts& counts);
void note_allocation(std::size_t bytes);

}  // namespace cudasim
