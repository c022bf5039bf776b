#include "runtime/recording.h"

#include <algorithm>

#include "runtime/allocations.h"
#include "runtime/host_call.h"

namespace cudasim {
namespace {

std::vector<Recording*>& recordings() {
    static std::vector<Recording*> recordings;
    return recordings;
}

}  // namespace

Recording::Recording() {
    const HostCall call("cudasim::Recording");
    recordings().push_back(this);
}

Recording::~Recording() {
    const HostCall call("cudasim::Recording");
    recordings().erase(std::find(recordings().begin(), recordings().end(), this));
}

std::size_t Recording::count(const std::string& kernel_prefix) const {
    return static_cast<std::size_t>(
        std::count_if(launches_.begin(), launches_.end(), [&](const Launch& launch) {
            return launch.kernel.compare(0, kernel_prefix.size(), kernel_prefix) == 0;
        }));
}

Counts Recording::counts() const {
    Counts sum;
    for (const Launch& launch : launches_) sum += launch.counts;
    return sum;
}

void Recording::note_allocation(std::size_t bytes) {
    ++allocations_;
    bytes_ += bytes;
}

void note_launch(const LaunchRequest& request) {
    for (Recording* recording : recordings())
        recording->note_launch({request.kernel, request.grid, request.block, request.shared_bytes, {}});
}

void note_counts(const Counts& counts) {
    for (Recording* recording : recordings()) recording->note_counts(counts);
}

void note_allocation(std::size_t bytes) {
    for (Recording* recording : recordings()) recording->note_allocation(bytes);
}

std::size_t live_bytes() {
    const HostCall call("cudasim::live_bytes");
    return Allocations::all().live_bytes();
}

std::size_t live_allocations() {
    const HostCall call("cudasim::live_allocations");
    return Allocations::all().live_count();
}

}  // namespace cudasim
