#include "runtime/host_call.h"

#include <cstdlib>

#include "runtime/report.h"
#include "runtime/settings.h"

namespace cudasim {
namespace {

std::recursive_mutex& runtime_mutex() {
    static std::recursive_mutex& mutex = *new std::recursive_mutex;  // never destroyed: used late at exit
    return mutex;
}

}  // namespace

HostCall::HostCall(const char* function) {
    if (running_launch) {
        say(std::string(function) + " was called by a kernel; only host code may\nin " +
            running_thread_text());
        std::abort();
    }
    settings();  // a wrong setting ends the program at its first call, not somewhere later
    lock_ = std::unique_lock(runtime_mutex());
}

}  // namespace cudasim
