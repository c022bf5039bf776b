/// @file
/// Error against run time of every problem, in float and in double; and maps of stable steps.
#pragma once
#include <string>
#include <vector>

#include "02_integrators/batch.h"
#include "02_integrators/bouncing_ball.h"
#include "02_integrators/drag_variants.h"
#include "02_integrators/stability.h"
#include "02_integrators/stiff_methods.h"
#include "common/program.h"

namespace integrators {

constexpr int kCopies =
    256;  ///< of each problem: enough for the clock and for a mean, few enough for the L1 cache

/// Numbers of steps from `first` to `last`, each four times (if quick: eight times) the one before.
struct Ladder {
    int first, last;
};

//! [measure_line]
/// One line of a plot: the whole solve from 0 to end_s, with ever more steps.
template <class Method, class Real, class System>
void measure_line(course::Study& study, std::string name, const System& system, double end_s, Ladder steps) {
    if (std::is_same_v<Real, float>) name += ", float";
    const Batch<Real, System::kDim> start = make_batch<Real>(system, kCopies);
    const int factor = study.quick ? 8 : 4;
    for (long count = steps.first; count <= steps.last; count *= factor) {
        Batch<Real, System::kDim> batch = start;
        const int calls = std::max(1L, 20000 / count);  // so that the clock sees a millisecond
        const course::Timing time = course::time_work(study.quick ? 5 : 9, [&] {
            for (int k = 0; k < calls; ++k) {
                batch = start;
                solve<Method>(batch, system, int(count), end_s);
            }
        });
        study.add({name, end_s / count, kCopies, rms_error(batch, system, end_s),
                   time.per(double(calls) * count), double(count)});
    }
}
//! [measure_line]

/// The same line in double and in float.
template <class Method, class System>
void measure_both(course::Study& study, const std::string& name, const System& system, double end_s,
                  Ladder steps) {
    measure_line<Method, double>(study, name, system, end_s, steps);
    measure_line<Method, float>(study, name, system, end_s, steps);
}

// ------------------------------------------------------------------------------------- error against run
// time

inline void study_oscillator(course::Study& study) {
    const Oscillator system;
    const double end_s = 5;
    measure_both<ExplicitEuler>(study, "explicit Euler", system, end_s, {64, 1 << 20});
    measure_both<SemiImplicitEuler>(study, "semi-implicit Euler", system, end_s, {64, 1 << 20});
    measure_both<Leapfrog>(study, "leapfrog", system, end_s, {16, 1 << 22});
    measure_both<Midpoint>(study, "RK2", system, end_s, {16, 1 << 18});
    measure_both<RungeKutta4>(study, "RK4", system, end_s, {8, 1 << 17});
}

/// At drag ratios of 0.1, 1 and 10.
inline void study_drag(course::Study& study, double zeta) {
    const Oscillator system{1, zeta};
    const double end_s = 5;
    const int first = zeta > 1 ? 64 : 16;  // explicit Euler's limit at zeta = 10 is 50 steps
    measure_line<ExplicitEuler, double>(study, "explicit Euler", system, end_s, {first, 1 << 18});
    measure_line<SemiImplicitEuler, double>(study, "semi-implicit Euler", system, end_s, {first, 1 << 18});
    measure_line<LeapfrogLaggedDrag, double>(study, "leapfrog, lagged drag", system, end_s, {first, 1 << 18});
    measure_both<Leapfrog>(study, "leapfrog", system, end_s, {first, 1 << 18});
    measure_line<ExponentialLeapfrog, double>(study, "exponential leapfrog", system, end_s, {first, 1 << 18});
    measure_line<Midpoint, double>(study, "RK2", system, end_s, {first, 1 << 18});
    measure_both<RungeKutta4>(study, "RK4", system, end_s, {first, 1 << 16});
}

inline void study_stiff_pair(course::Study& study) {
    const StiffPair system;
    const double end_s = 10;
    // Below 5000 and 3536 steps, leapfrog and RK4 are unstable.
    measure_both<Leapfrog>(study, "leapfrog", system, end_s, {5120, 5120 * 64});
    measure_line<RungeKutta4, double>(study, "RK4", system, end_s, {4096, 4096 * 64});
    measure_line<ImplicitEuler, double>(study, "implicit Euler", system, end_s, {16, 1 << 18});
    measure_both<ImplicitMidpoint>(study, "implicit midpoint", system, end_s, {16, 1 << 18});
}

inline void study_stiff_drag(course::Study& study) {
    const MoteInWind system;
    const double end_s = 1;
    // Below 500 thousand and 359 thousand steps, explicit Euler and RK4 are unstable.
    measure_line<ExplicitEuler, double>(study, "explicit Euler", system, end_s, {520000, 520000 * 16});
    measure_line<RungeKutta4, double>(study, "RK4", system, end_s, {370000, 370000 * 16});
    measure_line<SemiImplicitEulerImplicitDrag, double>(study, "semi-implicit Euler, implicit drag", system,
                                                        end_s, {4, 1 << 16});
    measure_line<ImplicitEuler, double>(study, "implicit Euler", system, end_s, {4, 1 << 16});
    measure_line<ImplicitMidpoint, double>(study, "implicit midpoint", system, end_s, {4, 1 << 16});
    measure_both<ExponentialLeapfrog>(study, "exponential leapfrog", system, end_s, {4, 1 << 16});
}

inline void study_projectile(course::Study& study) {
    const Projectile system;
    const double end_s = 3;
    measure_line<ExplicitEuler, double>(study, "explicit Euler", system, end_s, {16, 1 << 18});
    measure_line<SemiImplicitEuler, double>(study, "semi-implicit Euler", system, end_s, {16, 1 << 18});
    measure_both<Leapfrog>(study, "leapfrog", system, end_s, {4, 1 << 18});
    measure_line<Midpoint, double>(study, "RK2", system, end_s, {4, 1 << 18});
    measure_both<RungeKutta4>(study, "RK4", system, end_s, {4, 1 << 16});
    measure_both<ExponentialLeapfrog>(study, "exponential leapfrog", system, end_s, {1, 1 << 12});
}

inline void study_kepler(course::Study& study) {
    const Kepler system;
    const double end_s = 2 * kPi + 1;  // past the next perihelion, and no whole orbit
    measure_line<ExplicitEuler, double>(study, "explicit Euler", system, end_s, {1024, 1 << 18});
    measure_line<SemiImplicitEuler, double>(study, "semi-implicit Euler", system, end_s, {1024, 1 << 18});
    measure_both<Leapfrog>(study, "leapfrog", system, end_s, {1024, 1 << 18});
    measure_line<Midpoint, double>(study, "RK2", system, end_s, {1024, 1 << 17});
    measure_both<RungeKutta4>(study, "RK4", system, end_s, {512, 1 << 17});
}

inline void study_bouncing_ball(course::Study& study) {
    const BouncingBall system;
    const double end_s = 2;  // the lowest ball has met the floor three times, the highest twice
    const Ladder steps{64, 1 << 16};
    measure_line<ReflectedAtStepEnd<Leapfrog>, double>(study, "leapfrog, reflected", system, end_s, steps);
    measure_line<ReflectedAtStepEnd<RungeKutta4>, double>(study, "RK4, reflected", system, end_s, steps);
    measure_both<ImpactInterpolated<Leapfrog>>(study, "leapfrog, interpolated", system, end_s, steps);
    measure_line<ImpactInterpolated<RungeKutta4>, double>(study, "RK4, interpolated", system, end_s, steps);
    measure_line<ImpactInterpolated<SemiImplicitEuler>, double>(study, "semi-implicit Euler, interpolated",
                                                                system, end_s, steps);
}

// ------------------------------------------------------------------------------------------ maps of stable
// steps

/// Does a motion stay within a thousand times its start?
/// @param rate_per_s of the fastest motion: speeds are large where that is
template <class Method, class System>
bool stays_small(const System& system, double rate_per_s, double dt_s, int steps) {
    State<double, System::kDim> s = system.exact(0, 0);
    const double start = glm::length(s.x) + glm::length(s.v) / rate_per_s;
    for (int k = 0; k < steps; ++k) {
        s = Method::step(system, s, 0.0, dt_s);
        const double size = glm::length(s.x) + glm::length(s.v) / rate_per_s;
        if (!(size < 1e3 * start)) return false;
        if (size < 1e-30 * start)
            return true;  // it has died away, and numbers that small make a processor slow
    }
    return true;
}

const std::vector<double> kFactors = {0.25, 0.5, 0.75, 0.9, 0.99, 1.01, 1.1, 1.25, 1.5, 2};

inline void map_drag_ratio(course::StabilityMap& map) {
    const auto line = [&](auto method) {
        using Method = decltype(method);
        std::vector<double> zetas = {0.01, 0.1, 0.5, 1, 2, 10, 100};
        if (map.quick) zetas = {0.1, 1, 10};
        for (const double zeta : zetas)
            // Slow growth takes long to show: explicit Euler at zeta = 0.01 and 1.01 of its limit grows by
            // 2e-6 a step.
            map.column(Method::kName, zeta, stability_limit<Method>(zeta), kFactors, 4, [&](double dt) {
                return stays_small<Method>(Oscillator{1, zeta}, 1, dt, 4000000);
            });
    };
    line(ExplicitEuler{}), line(SemiImplicitEuler{}), line(SemiImplicitEulerImplicitDrag{}), line(Leapfrog{});
    line(LeapfrogLaggedDrag{}), line(LeapfrogPredictedDrag{}), line(Midpoint{}), line(RungeKutta4{});
}

inline void map_spring(course::StabilityMap& map) {
    const auto line = [&](auto method) {
        using Method = decltype(method);
        for (double ratio = 1e2; ratio < 2e12; ratio *= map.quick ? 1e5 : 1e2)
            map.column(Method::kName, ratio, longest_step_s<Method>(StiffPair{ratio}), kFactors, 4,
                       [&](double dt) {
                           return stays_small<Method>(StiffPair{ratio}, std::sqrt(ratio), dt, 20000);
                       });
    };
    line(SemiImplicitEuler{}), line(Leapfrog{}), line(RungeKutta4{});
}

inline void map_drag(course::StabilityMap& map) {
    const auto line = [&](auto method) {
        using Method = decltype(method);
        for (double drag = 1; drag < 2e12; drag *= map.quick ? 1e6 : 1e2)
            map.column(Method::kName, drag, longest_step_s<Method>(MoteInWind{drag}), kFactors, 4,
                       [&](double dt) { return stays_small<Method>(DragAlone{drag}, drag, dt, 20000); });
    };
    line(ExplicitEuler{}), line(Midpoint{}), line(RungeKutta4{});
}

// --------------------------------------------------------------------------------------------- what they ask

inline void declare_studies(course::Program& program) {
    const std::string rms = ", rms of 256 starts";
    const auto study = [&](const char* name, const char* question, const std::string& error, auto measure) {
        program.study({name, question, error + rms, "dt_s"}, measure);
    };
    const std::string plane = "distance from the exact motion in the plane of x and v at t = 5 s";
    study("oscillator", "Which method follows a swing most cheaply?", plane, study_oscillator);
    study("damped", "And with a little drag, zeta = 0.1?", plane,
          [](course::Study& s) { study_drag(s, 0.1); });
    study("critical", "And with critical drag, zeta = 1?", plane, [](course::Study& s) { study_drag(s, 1); });
    study("overdamped", "And with strong drag, zeta = 10?", plane,
          [](course::Study& s) { study_drag(s, 10); });
    study("stiff_pair", "What does a spring a million times too stiff cost?",
          "distance of the slow motion from the exact one at t = 10 s", study_stiff_pair);
    study("stiff_drag", "What does a drag of a million per second cost?",
          "error of the speed (m/s) of a mote in the wind at t = 1 s", study_stiff_drag);
    study("projectile", "Which method throws a ball through air most cheaply?", "distance (m) at t = 3 s",
          study_projectile);
    study("kepler", "Which method brings a comet round the sun most cheaply?",
          "distance after 1.16 orbits, in semi-major axes", study_kepler);
    study("bouncing_ball", "What is the order of a method worth when a ball bounces?",
          "error of the height (m) at t = 2 s", study_bouncing_ball);

    const std::string stable = " steps from its start, the motion is still within a thousand times that";
    program.stability(
        {"drag_ratio", "How does drag change the longest stable step of a spring?", "4 million" + stable,
         "largest eigenvalue of the step matrix = 1", "drag ratio zeta", "omega dt"},
        map_drag_ratio);
    program.stability({"spring", "How short must a step be for a stiff spring?", "20 thousand" + stable,
                       "2 / omega; RK4: 2 sqrt(2) / omega", "stiffness ratio of the pair (1/s^2)"},
                      map_spring);
    program.stability({"drag", "How short must a step be for a stiff drag?", "20 thousand" + stable,
                       "2 / k; RK4: 2.785 / k", "drag k (1/s)"},
                      map_drag);
}

}  // namespace integrators
