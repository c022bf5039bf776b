// The sanitizers name the line of an error. Here the kernel, block and thread are added.
#include "runtime/sanitizer_hooks.h"

#include "runtime/allocations.h"
#include "runtime/report.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>

namespace cudasim {
namespace {

// Called by AddressSanitizer after its report, just before it ends the program.
void after_report(const char*) {
    if (running_launch) return say("the error above happened in " + running_thread_text());
    const Allocation* touched = Allocations::all().find(__asan_get_report_address());
    if (touched && touched->kind == MemoryKind::kDevice)
        say("the error above: host code touched device memory, " + text_of(*touched) +
            "\na host pointer and a device pointer are two things: copy with cudaMemcpy");
}

}  // namespace

void install_sanitizer_hooks() {
    __asan_set_error_report_callback(after_report);
}

}  // namespace cudasim

// Called by UndefinedBehaviorSanitizer before each report.
extern "C" void __ubsan_on_report() {
    if (cudasim::running_launch) cudasim::say("undefined behaviour in " + cudasim::running_thread_text());
}
#else
void cudasim::install_sanitizer_hooks() {}
#endif

#if defined(__SANITIZE_THREAD__)
// Called by ThreadSanitizer after each report, in the thread that made the second of the two accesses.
extern "C" void __tsan_on_report(void*) {
    if (cudasim::running_launch)
        cudasim::say("the data race above was found in " + cudasim::running_thread_text());
}
#endif
