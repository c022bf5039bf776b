// Exercise 11.2: the crossover of curves whose crossing is known.
#include "ex2_crossover.h"

#include "tests/support/course_test.h"

namespace {

using compared::Repeats;

const std::vector<double> kSizes = {16384, 32768, 65536, 131072};

/// Three repeats, `spread` apart from each other, in no order.
Repeats around(double seconds, double spread = 0.02) {
    return {seconds * (1 + spread), seconds, seconds * (1 - spread)};
}

/// Seconds of a power law: `at_40000` for 40,000 particles.
std::vector<Repeats> law(double at_40000, double power, double spread = 0.02) {
    std::vector<Repeats> times;
    for (const double n : kSizes) times.push_back(around(at_40000 * std::pow(n / 40000, power), spread));
    return times;
}

}  // namespace

TEST_CASE("median of an odd and of an even number") {
    course::set_hint(1);
    CHECK(compared::median_of({3, 1, 2}) == 2);
    CHECK(compared::median_of({5}) == 5);
    CHECK(compared::median_of({4, 1, 100, 2}) == 3);
    CHECK(compared::median_of({2, 1}) == 1.5);
}

TEST_CASE("clearly faster: every repeat, or not at all") {
    course::set_hint(2);
    CHECK(compared::clearly_faster({1, 2}, {3, 4}));
    CHECK(!compared::clearly_faster({3, 4}, {1, 2}));
    CHECK(!compared::clearly_faster({1, 3.5}, {3, 4}));
    CHECK(!compared::clearly_faster({1, 3}, {3, 4}));
}

TEST_CASE("two power laws that cross at 40,000 particles") {
    course::set_hint(3);
    const double found = compared::crossover(kSizes, law(1, 1.4), law(1, 1.0));
    CHECK(found == doctest::Approx(40000).epsilon(1e-9));
    CHECK(compared::crossover(kSizes, law(1e-3, 2.0), law(1e-3, 0.5)) ==
          doctest::Approx(40000).epsilon(1e-9));
}

TEST_CASE("unclear sizes in the middle are passed over") {
    course::set_hint(4);
    std::vector<Repeats> a = law(1, 1.4), b = law(1, 1.0);
    a[1] = {0.5, 3};  // somebody else used the machine
    a[2] = {0.5, 0.6, 3};
    const double f0 = std::log(compared::median_of(a[0]) / compared::median_of(b[0]));
    const double f3 = std::log(compared::median_of(a[3]) / compared::median_of(b[3]));
    const double expected = kSizes[0] * std::pow(kSizes[3] / kSizes[0], f0 / (f0 - f3));
    CHECK(compared::crossover(kSizes, a, b) == doctest::Approx(expected).epsilon(1e-9));
}

TEST_CASE("no crossover: never overtaken, never clear, or overtaken the other way round") {
    course::set_hint(4);
    CHECK(compared::crossover(kSizes, law(1, 1.0), law(2, 1.0)) == 0);
    CHECK(compared::crossover(kSizes, law(2, 1.0), law(1, 1.0)) == 0);
    CHECK(compared::crossover(kSizes, law(1, 1.05, 0.3), law(1, 1.0, 0.3)) == 0);
    CHECK(compared::crossover(kSizes, law(1, 1.0), law(1, 1.4)) == 0);
    CHECK(compared::crossover({}, {}, {}) == 0);
}

TEST_CASE("b is faster at first, then a, then b again: the second time counts") {
    course::set_hint(4);
    const std::vector<Repeats> a = {around(2), around(1), around(4), around(9)},
                               b = {around(1), around(2), around(2), around(2)};
    const double expected = 32768 * std::pow(2, std::log(0.5) / (std::log(0.5) - std::log(2)));
    CHECK(compared::crossover(kSizes, a, b) == doctest::Approx(expected).epsilon(1e-9));
}
