/// @file
/// Permission for host code to touch device memory.
#pragma once

namespace cudasim {

/// While it lives, host code may use device pointers; else a build with AddressSanitizer ends the program.
/// For library functions that stand for kernels but run as plain functions here.
class HostAccess {
  public:
    HostAccess();
    ~HostAccess();
    HostAccess(const HostAccess&) = delete;
    HostAccess& operator=(const HostAccess&) = delete;
};

}  // namespace cudasim
