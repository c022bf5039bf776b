/// @file
/// What every runtime function that host code calls does first.
#pragma once
#include <mutex>

namespace cudasim {

/// One host thread at a time, and no kernel: a kernel that calls a host function ends the program with a
/// message.
class HostCall {
  public:
    explicit HostCall(const char* function);

  private:
    std::unique_lock<std::recursive_mutex> lock_;
};

}  // namespace cudasim
