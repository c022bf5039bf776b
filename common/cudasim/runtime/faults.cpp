#include "runtime/faults.h"

#include <signal.h>

#include "runtime/allocations.h"
#include "runtime/report.h"
#include "runtime/worker.h"

// The sanitizers report crashes themselves and are told of kernels by sanitizer_hooks.cpp.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace cudasim {
namespace {

constexpr std::size_t kStackBytes = 64 * 1024;
constexpr int kSignals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int kCount = sizeof kSignals / sizeof *kSignals;
struct sigaction previous[kCount];

std::string reason_of(int signal, const void* address) {
    if (signal == SIGFPE) return "an integer was divided by zero (a GPU goes on with a meaningless result)";
    if (signal == SIGILL) return "an instruction that cannot be carried out, such as __trap()";
    if (signal == SIGABRT) return "the program was aborted, as by assert()";
    if (Worker::mine().is_stack_overflow(address))
        return "a thread's stack is full: it calls itself too often, or its local arrays are too large";
    if (Worker::mine().is_behind_shared(address))
        return "it touched memory behind the end of its dynamic shared memory, " +
               std::to_string(running_launch->shared_bytes) + " bytes as given in the launch";
    char text[64];
    std::snprintf(text, sizeof text, "it touched memory at %p, which it may not", address);
    std::string reason = text;
    const Allocation* near = Allocations::all().find_before(address, 2 * page_bytes());
    if (near && address >= near->end())
        reason += ", " + std::to_string(static_cast<const char*>(address) - near->end()) +
                  " bytes behind the end of " + text_of(*near);
    if (reinterpret_cast<std::uintptr_t>(address) < page_bytes()) reason += ": a null pointer";
    return reason;
}

// Not all it calls is allowed in a signal handler, strictly. The process is about to end: what counts is that
// the message comes out nearly always.
void report_fault(int signal, siginfo_t* info, void*) {
    for (int i = 0; i < kCount; ++i) sigaction(kSignals[i], &previous[i], nullptr);
    if (running_launch) {
        const bool thread_known = signal == SIGABRT || Worker::mine().running_thread_waited();
        say("crash in " + (thread_known ? running_thread_text() : running_block_text()) + "\n" +
            reason_of(signal, info->si_addr) +
            (thread_known ? "" : "\nthe asan preset names the thread and the line"));
    }
    if (signal == SIGABRT) raise(signal);  // the others happen again when the handler returns
}

}  // namespace

AlternateStack::AlternateStack() {
    stack_t present{};
    sigaltstack(nullptr, &present);
    if (!(present.ss_flags & SS_DISABLE)) return;
    stack_ = std::make_unique<char[]>(kStackBytes);
    stack_t mine{};
    mine.ss_sp = stack_.get();
    mine.ss_size = kStackBytes;
    sigaltstack(&mine, nullptr);
}

AlternateStack::~AlternateStack() {
    if (!stack_) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    sigaltstack(&none, nullptr);
}

void report_faults() {
    static thread_local const AlternateStack stack_of_host_thread;
    static const bool installed = [] {
        struct sigaction mine {};
        mine.sa_sigaction = report_fault;
        mine.sa_flags = SA_SIGINFO | SA_ONSTACK;
        for (int i = 0; i < kCount; ++i) sigaction(kSignals[i], &mine, &previous[i]);
        return true;
    }();
    (void)installed;
}

}  // namespace cudasim

#else

namespace cudasim {

AlternateStack::AlternateStack() = default;
AlternateStack::~AlternateStack() = default;
void report_faults() {}

}  // namespace cudasim

#endif
