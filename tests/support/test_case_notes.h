// What the running test case has told about itself, for the reporter. Not for tests: they use course_test.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace course {

struct Skipped {};  // thrown by skip(); no std::exception, so that no test catches it by accident

struct TestCaseNotes {
    std::optional<std::string> skip_reason;
    std::optional<std::uint64_t> seed;
    std::optional<int> hint;
};

TestCaseNotes& test_case_notes();

// How the cases of this run ended; doctest itself does not know of skipped ones.
struct Tally {
    int passed = 0;
    int failed = 0;
    int skipped = 0;
    bool listed_only = false;  // nothing was to be run: --list-test-cases and the like
};

Tally& tally();

bool gpu_required();  // COURSE_REQUIRE_GPU=1: a skip for want of a GPU is a failure

}  // namespace course
