/// @file
/// What the environment asks for. A value that cannot be understood ends the program with a sentence, exit
/// code 2.
#pragma once
#include "cudasim.h"

namespace cudasim {

struct Settings {
    unsigned workers;    ///< CUDASIM_THREADS=n; default: the CPU's threads, at most 16
    Order order;         ///< CUDASIM_ORDER=forward|reverse|shuffled[:seed]
    bool race_check;     ///< CUDASIM_RACECHECK=1: every kernel in three orders, results compared
    int leak_exit_code;  ///< CUDASIM_LEAK_EXIT=n: exit code of a program that leaks device memory; 0: its own
};
/// Read once, then changed by OrderScope and WorkerScope.
Settings& settings();

}  // namespace cudasim
