/// \file
/// What the course's tests add to doctest: skipping, and comparisons of whole arrays that name the first
/// wrong element. A test includes this file (it brings doctest) and links `course_test_main`.
///
/// \code
/// TEST_CASE("density agrees with the CPU reference") {
///     course::set_seed(7);  // printed if this case fails
///     ...
///     // 33 neighbours summed in fp32: a few rounding errors of 1000 kg/m^3
///     course::check_close(density_gpu, density_cpu, course::Tolerance(0.0, 1e-5), "density");
/// }
/// \endcode
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace course {

/// Ends the running test case as *skipped*. The test program's exit code is 77 if nothing but skips happened,
/// which CTest shows as "Skipped" and never as passed.
[[noreturn]] void skip(const std::string& reason);

/// True where kernels run on the CPU instead of a GPU.
bool on_simulator();

/// Skips the running case unless kernels run on a real GPU; with COURSE_REQUIRE_GPU=1 in the environment it
/// fails instead. (In a GPU build, doctest_main.cpp has already seen to it that a device answers.)
void require_gpu();

/// Skips the running case unless kernels run on the simulator. What then uses its launch log stands between
/// `#ifdef __CUDASIM__` and `#endif`.
void require_simulator();

/// The seed of the running case's random data, printed if the case fails.
void set_seed(std::uint64_t seed);

/// The hint a learner should read if the running case fails: `./course hint 05.2 <number>`.
void set_hint(int number);

/// Largest difference that still counts as equal: `absolute + relative * |expected|`.
struct Tolerance {
    double absolute;
    double relative;
    Tolerance(double absolute, double relative = 0.0) : absolute(absolute), relative(relative) {}
};

namespace detail {

/// Array elements as plain numbers, so that one function compares float, int, float4, int3, glm::vec3...
struct Numbers {
    std::vector<double> values;
    int per_element = 1;
};

template <typename T, typename = void>
constexpr int kComponents = 1;
template <typename T>
constexpr int kComponents<T, std::void_t<decltype(T::y)>> = 2;

template <typename T, typename = void>
constexpr bool kHasZ = false;
template <typename T>
constexpr bool kHasZ<T, std::void_t<decltype(T::z)>> = true;

template <typename T, typename = void>
constexpr bool kHasW = false;
template <typename T>
constexpr bool kHasW<T, std::void_t<decltype(T::w)>> = true;

template <typename T>
Numbers to_numbers(const std::vector<T>& elements) {
    Numbers numbers;
    for (const T& element : elements) {
        if constexpr (kComponents<T> == 1) {
            numbers.values.push_back(static_cast<double>(element));
        } else {
            numbers.values.push_back(element.x);
            numbers.values.push_back(element.y);
            if constexpr (kHasZ<T>) numbers.values.push_back(element.z);
            if constexpr (kHasW<T>) numbers.values.push_back(element.w);
        }
    }
    numbers.per_element = kComponents<T> == 1 ? 1 : 2 + kHasZ<T> + kHasW<T>;
    return numbers;
}

bool check_numbers(const Numbers& got, const Numbers& expected, Tolerance tolerance,
                   const std::string& quantity, const std::string& element, const char* file, int line);

}  // namespace detail

/// Checks that two arrays agree within the tolerance; NaN and infinity never do. A failure names the first
/// wrong element ("density of particle 17: expected 1000.2, got 0 ..."), how many are wrong, and the seed.
/// \param quantity what the numbers are: "density", "position".
/// \param element what an index counts: "particle", "cell".
/// \return whether all elements agree.
template <typename T>
bool check_close(const std::vector<T>& got, const std::vector<T>& expected, Tolerance tolerance,
                 const std::string& quantity, const std::string& element = "particle",
                 const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    return detail::check_numbers(detail::to_numbers(got), detail::to_numbers(expected), tolerance, quantity,
                                 element, file, line);
}

/// The same for results that must be exact: indices, counts, or floats computed in the same order.
/// Numbers beyond 2^53 are compared as doubles; compare hashes with CHECK.
template <typename T>
bool check_equal(const std::vector<T>& got, const std::vector<T>& expected, const std::string& quantity,
                 const std::string& element = "particle", const char* file = __builtin_FILE(),
                 int line = __builtin_LINE()) {
    return check_close(got, expected, Tolerance(0.0), quantity, element, file, line);
}

}  // namespace course
