/// @file
/// Timing two versions of the same work on a machine that does other things as well.
#pragma once
#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace particle_loop {

/// Seconds one call of `work` takes.
template <class Work>
double seconds(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

inline double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

//! [compare]
/// Median seconds of a call of `first` and of `second`. Their calls alternate, so that whatever else the
/// machine does meets both; the first round, in which caches fill and the clock speeds up, is not counted.
template <class First, class Second>
std::pair<double, double> compare(int repeats, First&& first, Second&& second) {
    std::vector<double> of_first, of_second;
    for (int k = 0; k <= repeats; ++k) {
        const double a = seconds(first), b = seconds(second);
        if (k == 0) continue;
        of_first.push_back(a);
        of_second.push_back(b);
    }
    return {median(of_first), median(of_second)};
}
//! [compare]

}  // namespace particle_loop
