// Ends a test program that runs for too long, with the place where it hangs. Not for tests.
#pragma once

namespace course {

/// With COURSE_TIME_LIMIT_S set in the environment: after that many seconds, prints "time limit of N s is
/// over" and sends SIGABRT to the thread that has used the most processor time, so that AddressSanitizer
/// (handle_abort=1) prints the stack of the endless loop rather than that of a thread waiting for it.
void start_time_limit();

}  // namespace course
