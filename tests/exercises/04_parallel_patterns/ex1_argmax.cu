// Exercise 04.1: the largest value and its place, against a loop on the CPU.
#include "ex1_argmax.cuh"

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/course_test.h"

namespace {

/// Place of the first NaN, or else of the first largest; -1 if there is nothing.
int argmax_cpu(const std::vector<float>& values) {
    int best = -1;
    for (int i = 0; i < int(values.size()); ++i) {
        if (std::isnan(values[i])) return i;
        if (best < 0 || values[i] > values[best]) best = i;
    }
    return best;
}

void check(const std::vector<std::vector<float>>& arrays) {
    std::vector<int> got, expected;
    std::vector<float> got_value, expected_value;
    for (const std::vector<float>& values : arrays) {
        const course::DeviceBuffer<float> on_device(values);
        const patterns::Best best = patterns::argmax(on_device.data(), std::uint32_t(values.size()));
        got.push_back(best.place), expected.push_back(argmax_cpu(values));
        // NaN is equal to nothing, and a difference of infinities is NaN: both are compared as stand-ins.
        const auto comparable = [](float value) {
            return std::isnan(value) ? 12345.0f : std::isinf(value) ? std::copysign(54321.0f, value) : value;
        };
        got_value.push_back(comparable(best.value));
        expected_value.push_back(comparable(values[expected.back()]));
    }
    course::check_equal(got, expected, "place of the largest", "array");
    course::check_equal(got_value, expected_value, "largest value", "array");
}

std::vector<float> random_values(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-100, 100);
    std::vector<float> values;
    for (int i = 0; i < n; ++i) values.push_back(value(random));
    return values;
}

}  // namespace

TEST_CASE("random values: 1, 2, 31, 33, 255, 257 and 5000 of them") {
    course::set_seed(1);
    course::set_hint(1);
    std::vector<std::vector<float>> arrays;
    for (const int n : {1, 2, 31, 33, 255, 257, 5000}) arrays.push_back(random_values(n, 1));
    check(arrays);
}

TEST_CASE("the largest in each lane of each warp") {
    course::set_hint(2);
    std::vector<std::vector<float>> arrays;
    for (int place = 0; place < 256; place += 5) {
        arrays.emplace_back(256, -7.0f);
        arrays.back()[place] = -6;
    }
    check(arrays);
}

TEST_CASE("the last of 4099 is the largest, all others negative") {
    course::set_hint(2);
    std::vector<float> values(4099, -3.0f);
    values.back() = -2;
    check({values});
}

TEST_CASE("all equal, or equal in pairs: the first wins") {
    course::set_seed(2);
    course::set_hint(3);
    std::vector<std::vector<float>> arrays{std::vector<float>(3000, 5.0f), std::vector<float>(70, -INFINITY)};
    arrays.push_back(random_values(1500, 2));
    arrays.back().insert(arrays.back().end(), arrays.back().begin(), arrays.back().begin() + 1500);
    for (int first = 0; first < 256; first += 37) {
        arrays.emplace_back(256, 0.0f);
        for (const int place : {first, first + 1, (first + 133) % 256}) arrays.back()[place % 256] = 1;
    }
    check(arrays);
}

TEST_CASE("NaN is found, the first of several") {
    course::set_hint(3);
    std::vector<std::vector<float>> arrays;
    for (const int place : {0, 1, 31, 32, 200, 999}) {
        arrays.push_back(random_values(1000, 3));
        arrays.back()[place] = NAN;
        arrays.back()[999] = NAN;
        arrays.back()[(place + 40) % 1000] = INFINITY;
    }
    check(arrays);
}

TEST_CASE("no values, no place") {
    course::set_hint(2);
    CHECK(patterns::argmax(nullptr, 0).place == INT_MAX);
    check({{1.0f}});  // and one value has one
}
