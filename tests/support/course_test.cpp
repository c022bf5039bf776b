#include "tests/support/course_test.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "common/todo.h"
#include "tests/support/test_case_notes.h"

namespace course {

TestCaseNotes& test_case_notes() {
    static TestCaseNotes notes;
    return notes;
}

void skip(const std::string& reason) {
    test_case_notes().skip_reason = reason;
    throw Skipped{};
}

bool gpu_required() {
    const char* required = std::getenv("COURSE_REQUIRE_GPU");
    return required != nullptr && std::string(required) == "1";
}

bool on_simulator() {
#ifdef COURSE_USE_CUDA
    return false;
#else
    return true;
#endif
}

void require_gpu() {
    if (!on_simulator()) return;
    if (gpu_required()) {
        DOCTEST_FAIL("needs a GPU, which COURSE_REQUIRE_GPU=1 insists on; kernels run on the simulator here");
    }
    skip("needs a GPU; kernels run on the simulator here");
}

void require_simulator() {
    if (!on_simulator()) skip("needs the simulator's launch log; kernels run on a GPU here");
}

void set_seed(std::uint64_t seed) {
    test_case_notes().seed = seed;
}

void set_hint(int number) {
    test_case_notes().hint = number;
}

namespace detail {
namespace {

std::string to_text(double value) {
    if (std::abs(value) < 1e15 && value == std::floor(value)) {
        return std::to_string(static_cast<long long>(value));
    }
    std::ostringstream text;
    text.precision(9);  // enough to tell two floats apart
    text << value;
    return text.str();
}

std::string element_text(const Numbers& numbers, std::size_t element) {
    if (numbers.per_element == 1) return to_text(numbers.values[element]);
    std::string text = "(";
    for (int c = 0; c < numbers.per_element; ++c) {
        text += (c == 0 ? "" : ", ") + to_text(numbers.values[element * numbers.per_element + c]);
    }
    return text + ")";
}

// Empty if the element is right. `!(difference <= allowed)` also catches NaN, for which every comparison is
// false.
std::string describe_wrong_element(const Numbers& got, const Numbers& expected, std::size_t element,
                                   Tolerance tolerance) {
    for (int c = 0; c < got.per_element; ++c) {
        const double g = got.values[element * got.per_element + c];
        const double e = expected.values[element * got.per_element + c];
        const double difference = std::abs(g - e);
        const double allowed = tolerance.absolute + tolerance.relative * std::abs(e);
        if (!(difference <= allowed)) {
            const std::string component = got.per_element == 1 ? "" : std::string(" in ") + "xyzw"[c];
            const char* stub =
                g == kTodo ? "\nthat is what the stub returns: nothing is written here yet" : "";
            return "expected " + element_text(expected, element) + ", got " + element_text(got, element) +
                   "\ndifference" + component + " " + to_text(difference) + ", allowed " + to_text(allowed) +
                   stub;
        }
    }
    return "";
}

std::string describe_difference(const Numbers& got, const Numbers& expected, Tolerance tolerance,
                                const std::string& quantity, const std::string& element) {
    const std::size_t n = expected.values.size() / expected.per_element;
    const std::size_t n_got = got.values.size() / got.per_element;
    if (n_got != n) {
        return quantity + ": expected " + std::to_string(n) + " values, got " + std::to_string(n_got);
    }
    std::string first;
    std::size_t n_wrong = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::string wrong = describe_wrong_element(got, expected, i, tolerance);
        if (wrong.empty()) continue;
        if (n_wrong == 0) first = quantity + " of " + element + " " + std::to_string(i) + ": " + wrong;
        ++n_wrong;
    }
    if (n_wrong == 0) return "";
    return first + "\n" + std::to_string(n_wrong) + " of " + std::to_string(n) +
           " are wrong, this is the first";
}

}  // namespace

bool check_numbers(const Numbers& got, const Numbers& expected, Tolerance tolerance,
                   const std::string& quantity, const std::string& element, const char* file, int line) {
    const std::string difference = describe_difference(got, expected, tolerance, quantity, element);
    if (difference.empty()) {
        DOCTEST_CHECK(true);  // counts as an assertion: a case that checks nothing is a failure
    } else {
        DOCTEST_ADD_FAIL_CHECK_AT(file, line, difference);
    }
    return difference.empty();
}

}  // namespace detail
}  // namespace course
