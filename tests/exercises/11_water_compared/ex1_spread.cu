// Exercise 11.1: count, mean and sum of squares against a loop in double.
#include "ex1_spread.cuh"

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/course_test.h"

namespace {

void check(const std::vector<float>& values) {
    const course::DeviceBuffer<float> on_device(values);
    const compared::Spread got = compared::spread_of(on_device.data(), std::uint32_t(values.size()));
    double mean = 0, squares = 0;
    for (const float v : values) mean += v / double(values.size());
    for (const float v : values) squares += (v - mean) * (v - mean);
    CAPTURE(values.size());
    CHECK(got.count == float(values.size()));
    // Each of some twenty merges of the tree rounds the mean by up to 6e-8 of the values' size; the squares
    // feel that as an error of the distances, and their own rounding.
    double size = 0;
    for (const float v : values) size = std::max(size, std::fabs(double(v)));
    CHECK(std::fabs(got.mean - mean) <= 2e-6 * size);
    const double spread = std::sqrt(squares / double(values.size())), error = 2e-6 * size;
    CHECK(std::fabs(got.squares - squares) <=
          double(values.size()) * (2 * spread * error + error * error) + 2e-6 * squares);
}

std::vector<float> random_values(int n, float around, float spread, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(around - spread, around + spread);
    std::vector<float> values;
    for (int i = 0; i < n; ++i) values.push_back(value(random));
    return values;
}

}  // namespace

TEST_CASE("one value, two, three") {
    course::set_hint(1);
    check({5.0f});
    check({-1.0f, 3.0f});
    check({1.0f, 2.0f, 6.0f});
}

TEST_CASE("random values: 255, 256, 257, 5000 and 300,000 of them") {
    course::set_seed(1);
    course::set_hint(2);
    for (const int n : {255, 256, 257, 5000, 300000}) check(random_values(n, 30, 20, 1));
}

TEST_CASE("two crowds: half of the values are 0, half are 60") {
    course::set_hint(2);
    std::vector<float> values(4000, 0.0f);
    for (int i = 1; i < 4000; i += 2) values[i] = 60;
    check(values);
    for (int i = 0; i < 4000; ++i) values[i] = i < 1000 ? 0.0f : 60.0f;
    check(values);
}

TEST_CASE("values around 10,000 that hardly differ") {
    course::set_seed(2);
    course::set_hint(3);
    check(random_values(20000, 10000, 0.25f, 2));
    check(std::vector<float>(3000, 12345.5f));
}

TEST_CASE("nothing merged with something changes nothing") {
    course::set_hint(1);
    using compared::MergeSpreads;
    const compared::Spread some{7, 3, 11}, none = MergeSpreads::nothing();
    for (const compared::Spread merged :
         {MergeSpreads::combine(some, none), MergeSpreads::combine(none, some)}) {
        CHECK(merged.count == 7);
        CHECK(merged.mean == 3);
        CHECK(merged.squares == 11);
    }
    const compared::Spread nothing = MergeSpreads::combine(none, none);
    CHECK(nothing.count == 0);
    CHECK(nothing.squares == 0);
    CHECK(compared::spread_of(nullptr, 0).count == 0);
}
