// Exercise 04.2: the splits and the sort, against std::stable_partition and std::sort.
#include "ex2_radix_sort.cuh"

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/course_test.h"

namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers random_numbers(std::uint32_t n, unsigned seed) {
    std::mt19937 random(seed);
    Numbers numbers;
    for (std::uint32_t i = 0; i < n; ++i) numbers.push_back(std::uint32_t(random()));
    return numbers;
}

void check_split(const Numbers& numbers, unsigned bit) {
    CAPTURE(bit);
    const auto n = std::uint32_t(numbers.size());
    const course::DeviceBuffer<std::uint32_t> values(numbers);
    course::DeviceBuffer<std::uint32_t> to(Numbers(n, 0)), place(n + 1);
    patterns::ExclusiveScan scan(n + 1);
    patterns::split(to.data(), values.data(), place.data(), scan, bit, n);
    Numbers expected = numbers;
    std::stable_partition(expected.begin(), expected.end(),
                          [&](std::uint32_t v) { return (v >> bit & 1u) == 0; });
    course::check_equal(to.download(), expected, "number after the split", "place");
}

void check_sort(const Numbers& numbers) {
    course::DeviceBuffer<std::uint32_t> values(numbers);
    patterns::radix_sort(values.data(), std::uint32_t(numbers.size()));
    Numbers expected = numbers;
    std::sort(expected.begin(), expected.end());
    course::check_equal(values.download(), expected, "sorted number", "place");
}

}  // namespace

TEST_CASE("one split: eight numbers") {
    course::set_hint(1);
    check_split({5, 2, 7, 4, 1, 6, 3, 0}, 0);
    check_split({5, 2, 7, 4, 1, 6, 3, 0}, 1);
    check_split({5, 2, 7, 4, 1, 6, 3, 0}, 2);
}

TEST_CASE("one split: the order within each half stays, by any bit") {
    course::set_seed(4);
    course::set_hint(2);
    for (const unsigned bit : {0u, 7u, 31u}) check_split(random_numbers(1000, 4), bit);
}

TEST_CASE("one split: all zeros, all ones") {
    course::set_hint(2);
    check_split(Numbers(300, 4), 1);
    check_split(Numbers(300, 4), 2);
}

TEST_CASE("sort: 1, 2, 63, 65, 257 and 3000 random numbers") {
    course::set_seed(5);
    course::set_hint(3);
    for (const std::uint32_t n : {1u, 2u, 63u, 65u, 257u, 3000u}) check_sort(random_numbers(n, 5));
}

TEST_CASE("sort: backwards, all equal, the largest and the smallest number") {
    course::set_hint(3);
    Numbers backwards;
    for (std::uint32_t i = 500; i-- > 0;) backwards.push_back(i);
    check_sort(backwards);
    check_sort(Numbers(100, 17));
    check_sort({0xffffffffu, 0, 0x80000000u, 0x7fffffffu, 1});
}

TEST_CASE("sort: no numbers") {
    course::set_hint(3);
    patterns::radix_sort(nullptr, 0);
    check_sort({3, 2});  // and two
}
