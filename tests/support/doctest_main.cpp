// The main() of every test program, compiled once. Beyond doctest's own it
// - reports through the `verdict` reporter unless another one is asked for (`--reporters=junit`),
// - fails when a filter matches no test case, and ends with 77 when all that matched was skipped,
// - ends with a stack of the busy thread when a time limit is set and run over (time_limit.h).
#define DOCTEST_CONFIG_IMPLEMENT
#define DOCTEST_CONFIG_NO_POSIX_SIGNALS  // a crash is reported by the sanitizer, which knows the line
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "tests/support/test_case_notes.h"
#include "tests/support/time_limit.h"

#ifdef COURSE_USE_CUDA
#include <cuda_runtime.h>
#endif

namespace {

constexpr int kExitSkipped = 77;  // CTest's SKIP_RETURN_CODE in this project

// Tests of a GPU build mean nothing without a device: they are skipped, or fail where a GPU is required.
bool device_missing() {
#ifdef COURSE_USE_CUDA
    int count = 0;
    const cudaError_t error = cudaGetDeviceCount(&count);
    return error != cudaSuccess || count == 0;
#else
    return false;
#endif
}

int exit_code() {
    const course::Tally& tally = course::tally();
    if (tally.listed_only) return EXIT_SUCCESS;
    if (tally.failed > 0) return EXIT_FAILURE;
    if (tally.passed > 0) return EXIT_SUCCESS;
    return tally.skipped > 0 ? kExitSkipped : EXIT_FAILURE;  // nothing matched the filter: a failure
}

}  // namespace

int main(int argc, char** argv) {
    doctest::Context context;
    context.setOption("reporters", "verdict");  // it also counts: a reporter asked for comes beside it
    context.applyCommandLine(argc, argv);
    if (!context.shouldExit() && device_missing()) {  // shouldExit(): only a list or the help was asked for
        const bool required = course::gpu_required();
        std::cout << (required ? "FAILED" : "skipped")
                  << ": this is a GPU build, and no CUDA device answers\n";
        return required ? EXIT_FAILURE : kExitSkipped;
    }
    course::start_time_limit();
    context.run();
    return exit_code();
}
