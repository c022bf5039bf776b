// Exercise 11.2: from how many particles on is one model cheaper?
//
// Two curves are measured at a few sizes, several times each. The sizes double, the times spread: so compare
// medians, between sizes go straight in logarithms, and call it a crossover only where the measurements can
// tell the two apart.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/todo.h"

namespace compared {

// Times of one model at one size, in seconds, all above 0, in any order.
using Repeats = std::vector<double>;

// Half of the repeats took longer, half shorter. Of an even number: the mean of the two in the middle.
inline double median_of(Repeats repeats) {
    // TODO(11.2): about 4 lines.
    (void)repeats;
    return double(course::kTodo);
}

// Is a clearly faster than b? Every repeat of a is shorter than every repeat of b.
inline bool clearly_faster(const Repeats& a, const Repeats& b) {
    // TODO(11.2): about 1 line.
    (void)a;
    (void)b;
    return false;
}

// The number of particles at which a, clearly faster at some size, is overtaken by b, which from some larger
// size on is clearly faster; 0 if that never happens. Sizes in between at which neither is clear are passed
// over: the crossover is where the medians of the two clear sizes around them meet, on straight lines in
// logarithms.
// particles ascending; a[k] and b[k] were measured with particles[k]
inline double crossover(const std::vector<double>& particles, const std::vector<Repeats>& a,
                        const std::vector<Repeats>& b) {
    // TODO(11.2): remember the last size at which a was clearly faster. At the first size after it at which b
    // is, interpolate. About 9 lines.
    (void)particles;
    (void)a;
    (void)b;
    return double(course::kTodo);
}

}  // namespace compared
