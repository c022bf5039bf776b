/// @file
/// Lanes of one warp that exchange values.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/fiber.h"

namespace cudasim {

/// All exchanges of a warp under one mask. A lane that is done with one may already bring its value for the
/// next, while others have not looked at the results yet: so there is room for two in turn.
struct WarpGroup {
    unsigned mask;
    unsigned arrived = 0, votes = 0;    ///< lanes, in the exchange that is under way
    const char* name = "";              ///< its operation
    bool different_operations = false;  ///< the lanes do not agree on it
    unsigned turn = 0;                  ///< where its results go: 0 or 1
    std::vector<Fiber*> waiting;

    std::uint64_t values[2][32];
    unsigned lanes[2], votes_cast[2];

    explicit WarpGroup(unsigned lane_mask) : mask(lane_mask) {}
};

}  // namespace cudasim
