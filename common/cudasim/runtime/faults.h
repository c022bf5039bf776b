/// @file
/// When a kernel crashes: says which kernel, block and thread it was.
#pragma once
#include <memory>

namespace cudasim {

/// A stack for the crash report of the calling OS thread: its own may be what ran over.
class AlternateStack {
  public:
    AlternateStack();
    ~AlternateStack();
    AlternateStack(const AlternateStack&) = delete;
    AlternateStack& operator=(const AlternateStack&) = delete;

  private:
    std::unique_ptr<char[]> stack_;  ///< nullptr: the thread had one already
};

/// From now on a crash of a kernel is reported before the process ends as it would have. To be called by each
/// host thread before it runs kernels; only the first call costs anything.
void report_faults();

}  // namespace cudasim
