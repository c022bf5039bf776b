// Exercise 15.1: light in a sheet of water adds up, bounce by bounce.
#include "ex1_sheet.h"

#include <cmath>
#include <vector>

#include "tests/support/course_test.h"

namespace {

/// The same, bounce by bounce.
water::Split followed(double once, double pass) {
    water::Split sum{once, 0, 0};
    double inside = 1 - once;
    for (int face = 0; face < 20000 && inside > 0; ++face) {
        sum.absorbed += inside * (1 - pass);
        inside *= pass;
        (face % 2 == 0 ? sum.through : sum.reflected) += inside * (1 - once);
        inside *= once;
    }
    return sum;
}

void append(std::vector<double>& numbers, const water::Split& split) {
    numbers.insert(numbers.end(), {split.reflected, split.through, split.absorbed});
}

}  // namespace

TEST_CASE("a sheet that keeps nothing is a pane") {
    course::set_hint(2);
    std::vector<double> got, expected;
    for (const double once : {0.0, 0.02, 0.04, 0.5, 0.9}) {
        append(got, water::sheet(once, 1));
        append(expected, {2 * once / (1 + once), (1 - once) / (1 + once), 0});
    }
    course::check_close(got, expected, course::Tolerance(1e-13), "reflected, through, absorbed", "number");
}

TEST_CASE("ink: what goes in stays") {
    course::set_hint(1);
    std::vector<double> got, expected;
    for (const double once : {0.0, 0.3, 0.8}) {
        append(got, water::sheet(once, 0));
        append(expected, {once, 0, 1 - once});
    }
    course::check_close(got, expected, course::Tolerance(1e-15), "reflected, through, absorbed", "number");
}

TEST_CASE("all bounces, followed one by one") {
    course::set_hint(3);
    std::vector<double> got, expected;
    for (const double once : {0.02, 0.2, 0.6, 0.95})
        for (const double pass : {0.1, 0.5, 0.9, 0.99}) {
            append(got, water::sheet(once, pass));
            append(expected, followed(once, pass));
        }
    // Up to a few hundred bounces, each with a rounding.
    course::check_close(got, expected, course::Tolerance(1e-12), "reflected, through, absorbed", "number");
}

TEST_CASE("a perfect mirror lets nothing in") {
    course::set_hint(3);
    std::vector<double> got, expected;
    for (const double pass : {0.0, 0.5, 1.0}) {
        append(got, water::sheet(1, pass));
        append(expected, {1, 0, 0});
    }
    course::check_close(got, expected, course::Tolerance(0), "reflected, through, absorbed", "number");
}
