// Everything a learner's file can do to a test program, for machine_test.sh: the judge must tell each from
// the rest.
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "common/todo.h"
#include "tests/support/course_test.h"

namespace {

volatile int forever = 1;  // keeps the compiler from reasoning about what follows

int* no_memory() {
    return forever ? nullptr : new int;
}

}  // namespace

TEST_CASE("right, with a comma") {
    course::check_equal<int>({1, 2}, {1, 2}, "cell");
}

TEST_CASE("wrong") {
    course::set_seed(42);
    course::set_hint(2);
    std::vector<float> got(33, 1.0f);
    got[17] = std::nanf("");
    got[20] = 5.0f;
    course::check_close(got, std::vector<float>(33, 1.0f), 1e-6, "density");
}

// What a race does, in a program without kernels.
TEST_CASE("right in one order") {
    CHECK(std::getenv("CUDASIM_ORDER") == nullptr);
}

TEST_CASE("stub") {
    course::check_equal<int>({course::kTodo}, {3}, "cell");
}

TEST_CASE("too few") {
    course::check_equal<int>({}, {3}, "cell");
}

TEST_CASE("checks nothing") {}

TEST_CASE("exception") {
    throw std::runtime_error("no such cell");
}

TEST_CASE("skips") {
    course::skip("needs another machine");
}

TEST_CASE("null pointer") {
    CHECK(*no_memory() == 1);
}

TEST_CASE("beyond the end") {
    const std::vector<int> cells(3 + forever);
    CHECK(cells.data()[4 * forever] == 0);
}

TEST_CASE("early exit") {
    _Exit(0);
}

TEST_CASE("lying exit code") {
    std::exit(0);
}

TEST_CASE("endless") {
    while (forever) {
    }
}
