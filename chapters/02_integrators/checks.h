/// @file
/// Notices a run that left the range in which its numbers mean anything, and says why.
#pragma once
#include <cmath>
#include <cstdio>
#include <string>

#include "02_integrators/stability.h"
#include "common/errors.h"

namespace integrators {

inline std::string to_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value + 0.0);  // -0 + 0 is 0
    return text;
}

template <class Real, int D>
std::string to_text(const Vec<Real, D>& v) {
    std::string text;
    for (int k = 0; k < D; ++k) text += (k ? ", " : "(") + to_text(double(v[k]));
    return text + ")";
}

/// What a limit says about a step; empty if it says nothing.
inline std::string limit_text(const std::string& method, double dt_s, double limit_s) {
    if (limit_s == 0) return method + " has no stable step here: without drag it grows at any dt";
    if (dt_s > limit_s)
        return "the time step " + to_text(dt_s) + " s is over the limit of " + method + ", " +
               to_text(limit_s) + " s";
    return "";
}

//! [watch]
/// @param limit_s the longest stable step of the method on this system, for the message
/// @throws course::Unstable naming step, values and likely cause, if the state is no number or beyond 1e12
/// times its start
template <class Real, int D>
void watch(const State<Real, D>& s, const State<Real, D>& start, long step, const std::string& method,
           double dt_s, double limit_s) {
    const double far = 1e12 * (1 + double(glm::length(start.x)) + double(glm::length(start.v)));
    if (double(glm::length(s.x)) < far && double(glm::length(s.v)) < far) return;  // false for NaN, too
    std::string cause = limit_text(method, dt_s, limit_s);
    if (!std::isfinite(far)) cause = "it started with a number that is none";
    if (cause.empty())
        cause = "the step is within the limit of " + method + ": the values are too large for it";
    throw course::Unstable("step " + std::to_string(step) + ": x = " + to_text<Real, D>(s.x) +
                           ", v = " + to_text<Real, D>(s.v) + "; " + cause);
}
//! [watch]

/// One copy, watched at every step. @param each (step, state) is called after each, and for step 0
template <class Method, class Real, class System, class Each>
State<Real, System::kDim> run_watched(const System& system, State<Real, System::kDim> s, long steps,
                                      double dt_s, const std::string& method, double limit_s, Each&& each) {
    const State<Real, System::kDim> start = s;
    watch(s, start, 0, method, dt_s, limit_s);
    each(0L, s);
    for (long k = 0; k < steps; ++k) {
        s = Method::step(system, s, Real(double(k) * dt_s), Real(dt_s));
        watch(s, start, k + 1, method, dt_s, limit_s);
        each(k + 1, s);
    }
    return s;
}

}  // namespace integrators
