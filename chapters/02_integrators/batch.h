/// @file
/// Many copies of a problem, as a struct of arrays (chapter 01): what a particle system is to an integrator,
/// and long enough for a clock.
#pragma once
#include <cstddef>
#include <vector>

#include "02_integrators/integrators.h"

namespace integrators {

/// Component k of copy i's position lies at [k n + i], its velocity D n further, its force 2 D n further.
template <class Real, int D>
struct Batch {
    int n = 0;
    std::vector<Real> numbers;

    explicit Batch(int copies) : n(copies), numbers(std::size_t(3) * D * copies) {}

    State<double, D> load(int i) const {
        State<double, D> s;
        for (int k = 0; k < D; ++k) {
            s.x[k] = numbers[std::size_t(k) * n + i];
            s.v[k] = numbers[std::size_t(D + k) * n + i];
        }
        return s;
    }
};

/// Copy i starts as the system's exact motion with u = i / n, rounded to Real.
template <class Real, class System>
Batch<Real, System::kDim> make_batch(const System& system, int n) {
    constexpr int D = System::kDim;
    Batch<Real, D> batch(n);
    for (int i = 0; i < n; ++i) {
        const State<double, D> exact = system.exact(double(i) / n, 0);
        const State<Real, D> s = begin(system, Real(0), Vec<Real, D>(exact.x), Vec<Real, D>(exact.v));
        for (int k = 0; k < D; ++k) {
            batch.numbers[std::size_t(k) * n + i] = s.x[k];
            batch.numbers[std::size_t(D + k) * n + i] = s.v[k];
            batch.numbers[std::size_t(2 * D + k) * n + i] = s.force[k];
        }
    }
    return batch;
}

//! [step_all]
/// One step of copy i: its numbers from the arrays, the step, and back.
template <class Method, int D, class Real, class System>
void step_copy(Real* numbers, std::size_t n, std::size_t i, const System& system, Real t, Real dt) {
    State<Real, D> s;
    for (int k = 0; k < D; ++k) {
        s.x[k] = numbers[k * n + i];
        s.v[k] = numbers[(D + k) * n + i];
        if constexpr (Method::kKeepsForce) s.force[k] = numbers[(2 * D + k) * n + i];
    }
    s = Method::step(system, s, t, dt);
    for (int k = 0; k < D; ++k) {
        numbers[k * n + i] = s.x[k];
        numbers[(D + k) * n + i] = s.v[k];
        if constexpr (Method::kKeepsForce) numbers[(2 * D + k) * n + i] = s.force[k];
    }
}

/// One step of all copies. They know nothing of each other, so 4, 8 or 16 may be taken at a time.
template <class Method, class Real, class System>
void step_all(Batch<Real, System::kDim>& batch, const System system, Real t, Real dt) {
    Real* numbers = batch.numbers.data();
    const std::size_t n = batch.n;
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) step_copy<Method, System::kDim>(numbers, n, i, system, t, dt);
}
//! [step_all]

/// `steps` equal steps to end_s. Times are counted and multiplied, never summed: a float would lose them.
template <class Method, class Real, class System>
void solve(Batch<Real, System::kDim>& batch, const System& system, int steps, double end_s) {
    const double dt = end_s / steps;
    for (int s = 0; s < steps; ++s) step_all<Method>(batch, system, Real(s * dt), Real(dt));
}

/// Root mean square over the copies of the system's error at end_s. Not finite if a copy isn't.
template <class Real, class System>
double rms_error(const Batch<Real, System::kDim>& batch, const System& system, double end_s) {
    double sum = 0;
    for (int i = 0; i < batch.n; ++i) {
        const double e = system.error(batch.load(i), system.exact(double(i) / batch.n, end_s));
        sum += e * e;
    }
    return std::sqrt(sum / batch.n);
}

}  // namespace integrators
