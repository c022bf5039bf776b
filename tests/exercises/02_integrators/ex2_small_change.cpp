// Exercise 02.2: sums and an oscillator in float, against exact answers.
#include "ex2_small_change.h"

#include <cmath>
#include <vector>

#include "tests/support/course_test.h"

using namespace integrators;

namespace {

void check_one(double got, double expected, double tolerance, const char* quantity) {
    course::check_close(std::vector<double>{got}, std::vector<double>{expected}, course::Tolerance(tolerance),
                        quantity, "number");
}

/// Distance from the exact motion after 5 s, in the plane of x and v / omega.
double error_after_5_s(float omega_per_s, int steps) {
    RememberingOscillator s;
    s.x.value = 1;
    for (int k = 0; k < steps; ++k) step_remembering(s, omega_per_s, float(5.0 / steps));
    // A float holds no dt exactly: what is compared is the time that really went by.
    const double phase = double(omega_per_s) * steps * double(float(5.0 / steps));
    return std::hypot(s.x.value - std::cos(phase), s.v.value / omega_per_s + std::sin(phase));
}

}  // namespace

TEST_CASE("a million times 0.001 is 1000, not 991") {
    course::set_hint(1);
    SmallChange t;
    for (int k = 0; k < 1000000; ++k) t.add(1e-3f);
    // 1e-3f itself is off by 4.7e-11; neighbouring floats at 1000 are 6e-5 apart.
    check_one(t.value, 1e6 * double(1e-3f), 6.2e-5, "time");
}

TEST_CASE("what is dropped is owed, and no more") {
    course::set_hint(2);
    SmallChange sum;
    sum.value = 16777216;  // from here on, a float counts by twos
    for (int k = 0; k < 100; ++k) sum.add(1);
    check_one(double(sum.value) + sum.owed, 16777316, 0, "value + owed");
    for (int k = 0; k < 100; ++k) sum.add(-1);
    check_one(double(sum.value) + sum.owed, 16777216, 0, "value + owed");
}

TEST_CASE("10 km from the origin, 0.4 m/s still move") {
    course::set_hint(1);
    SmallChange x;
    x.value = 1e4f;
    for (int k = 0; k < 10000; ++k) x.add(0.4f * 1e-3f);
    check_one(x.value, 1e4 + 10000 * double(0.4f * 1e-3f), 5e-4,
              "position");  // half the distance of two floats there
}

TEST_CASE("a hundred thousand steps in float: no floor at 1e-6") {
    course::set_hint(3);
    // The method's own error is phase dt^2 / 24 = 5e-10; what is left are a few roundings of numbers below 1.
    CHECK_MESSAGE(!!(error_after_5_s(1, 100000) <= 2.5e-7), "error " << error_after_5_s(1, 100000));
}

TEST_CASE("it is leapfrog: the error of a long step is leapfrog's") {
    course::set_hint(3);
    for (const float omega : {1.0f, 2.0f}) {
        const double ratio = error_after_5_s(omega, 50) / error_after_5_s(omega, 100);
        CHECK_MESSAGE(!!(std::abs(ratio - 4) <= 0.05),
                      "half the step gives " << ratio << " times less, expected 4");
        // Its phase is off by omega t (omega dt)^2 / 24, and its x by a little of the amplitude.
        const double h = omega * 0.05, phase_error = omega * 5 * h * h / 24;
        CHECK_MESSAGE(!!(std::abs(error_after_5_s(omega, 100) / phase_error - 1) <= 0.35),
                      "error " << error_after_5_s(omega, 100) << ", expected about " << phase_error);
    }
}
