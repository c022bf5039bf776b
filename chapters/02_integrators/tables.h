/// @file
/// The tables of the program's tour.
#pragma once
#include <string>
#include <vector>

#include "02_integrators/checks.h"
#include "02_integrators/methods.h"
#include "common/program.h"

namespace integrators {

/// Energy of an oscillator after many periods, at equal cost: each method has 100 evaluations of the force a
/// period.
inline course::Table energy_table() {
    course::Table table(
        "Energy of an oscillator, in units of its start: 100 evaluations of the force a period",
        {"method", "steps a period", "1 period", "100 periods", "10000 periods"});
    for_each_method([&](auto method) {
        using Method = decltype(method);
        const int steps = 100 / Method::kEvaluations;
        const Oscillator system;
        State<double, 1> s = system.exact(0, 0);
        std::vector<course::Cell> row = {Method::kName, steps};
        for (int period = 1; period <= 10000; ++period) {
            for (int k = 0; k < steps; ++k) s = Method::step(system, s, 0.0, 2 * kPi / steps);
            const double energy = s.x.x * s.x.x + s.v.x * s.v.x;  // twice, but it starts as 1
            if (period == 1 || period == 100 || period == 10000)
                row.push_back(std::isfinite(energy) ? course::Cell(energy) : course::Cell("overflow"));
        }
        table.row(row);
    });
    return table;
}

//! [steps_for]
/// How many steps make the error at end_s `target`: doubled until it is less, then by the slope between the
/// last two, which a method with an order keeps.
template <class Method, class System>
double steps_for(const System& system, double end_s, double target) {
    const auto error = [&](long steps) {
        const double dt = end_s / steps;
        State<double, System::kDim> s = system.exact(0, 0);
        for (long k = 0; k < steps; ++k) s = Method::step(system, s, k * dt, dt);
        return system.error(s, system.exact(0, end_s));
    };
    long steps = 2;
    double before = error(1), now = error(2);
    while (!(now <= target)) before = now, now = error(steps *= 2);
    const double order = std::log2(before / now);
    return std::ceil(steps * std::pow(now / target, 1 / order));
}
//! [steps_for]

/// The price of an error.
inline course::Table price_table() {
    course::Table table(
        "Evaluations of the force for an error at t = 5 s of an oscillator (a clock says the same: --study "
        "oscillator)",
        {"method", "1e-2", "1e-4", "1e-6"});
    for_each_method([&](auto method) {
        using Method = decltype(method);
        std::vector<course::Cell> row = {Method::kName};
        for (const double target : {1e-2, 1e-4, 1e-6})
            row.push_back(steps_for<Method>(Oscillator{}, 5.0, target) * Method::kEvaluations);
        table.row(row);
    });
    return table;
}

/// Longest stable omega dt, by drag ratio.
inline course::Table limit_table() {
    const std::vector<double> zetas = {0, 0.1, 1, 10, 100};
    std::vector<std::string> columns = {"method"};
    for (const double zeta : zetas) columns.push_back("zeta " + to_text(zeta));
    course::Table table("Longest stable omega dt of a spring with drag", columns);
    for_every_method([&](auto method) {
        using Method = decltype(method);
        std::vector<course::Cell> row = {Method::kName};
        for (const double zeta : zetas) {
            const double limit = stability_limit<Method>(zeta);
            row.push_back(std::isinf(limit) ? course::Cell("any")
                          : limit == 0      ? course::Cell("none")
                                            : course::Cell(limit));
        }
        table.row(row);
    });
    return table;
}

}  // namespace integrators
