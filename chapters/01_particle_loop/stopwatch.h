/// @file
/// Timing several versions of the same work on a machine that does other things as well.
#pragma once
#include <chrono>
#include <functional>
#include <vector>

#include "common/timing.h"

namespace particle_loop {

//! [by_turns]
/// Times each of some works, in seconds a call. They take turns, so that whatever else the machine does meets
/// all of them; the first round, in which caches fill and the clock speeds up, is not counted.
inline std::vector<course::Timing> by_turns(int rounds, const std::vector<std::function<void()>>& works) {
    using Clock = std::chrono::steady_clock;
    std::vector<std::vector<double>> seconds(works.size());
    for (int round = 0; round <= rounds; ++round)
        for (std::size_t w = 0; w < works.size(); ++w) {
            const Clock::time_point start = Clock::now();
            works[w]();
            const std::chrono::duration<double> taken = Clock::now() - start;
            if (round > 0) seconds[w].push_back(taken.count());
        }
    std::vector<course::Timing> timings;
    for (const std::vector<double>& of_one : seconds) timings.push_back(course::timing_of(of_one));
    return timings;
}
//! [by_turns]

}  // namespace particle_loop
