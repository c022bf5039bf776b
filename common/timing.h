/// @file
/// How long a piece of work takes on a machine that does other things as well: the median of several calls,
/// and how far the calls were apart.
#pragma once
#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace course {

/// Seconds of one call of some work, from several calls of it.
struct Timing {
    double median_s = 0;
    double low_s = 0, high_s = 0;  ///< the quartiles: half of all calls lay between them
    int repeats = 0;               ///< calls that were timed

    /// The time of one of `parts` equal parts of the work, say of one step out of many.
    Timing per(double parts) const { return {median_s / parts, low_s / parts, high_s / parts, repeats}; }
};

/// @param seconds of each call, in any order; at least one
inline Timing timing_of(std::vector<double> seconds) {
    std::sort(seconds.begin(), seconds.end());
    const std::size_t last = seconds.size() - 1;
    return {seconds[(last + 1) / 2], seconds[last / 4], seconds[last - last / 4], int(seconds.size())};
}

/// Calls `work` once to warm up, then `repeats` times by the clock. Kernels run on after their launch: work
/// on a device has to end with cudaDeviceSynchronize().
template <class Work>
Timing time_work(int repeats, Work&& work) {
    work();
    std::vector<double> seconds;
    for (int k = 0; k < repeats; ++k) {
        const auto start = std::chrono::steady_clock::now();
        work();
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return timing_of(std::move(seconds));
}

}  // namespace course
