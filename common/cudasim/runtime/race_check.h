/// @file
/// Runs a kernel in several orders and compares what it leaves in memory.
#pragma once
#include "cudasim.h"

namespace cudasim {

/// Is every launch to be checked: inside find_races(), or with CUDASIM_RACECHECK=1?
bool checks_races();
/// Runs the kernel in forward, reverse and shuffled order, each time on the memory as it is now; leaves
/// behind the result of the forward order. False if the kernel failed.
bool run_in_all_orders(const LaunchRequest& request);

/// Runs the grid once. (launch.cpp)
bool run_in_order(const LaunchRequest& request, Order order, unsigned workers);

}  // namespace cudasim
