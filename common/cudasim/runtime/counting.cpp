#include "runtime/counting.h"

#include "runtime/allocations.h"
#include "runtime/report.h"
#include "runtime/worker.h"

namespace cudasim {
namespace {

bool counting = false;

struct Range {
    const char *begin, *end;
    bool holds(const void* address) const { return address >= begin && address < end; }
};
thread_local std::vector<Range> shared_memory;

}  // namespace

void begin_counting() {
    counting = true;
}

/// Each block notes its shared memory anew; a worker has the same places for all blocks of a kernel. Ranges
/// of earlier kernels may stay: nothing else ever lives there.
void note_shared_memory(const void* begin, std::size_t bytes) {
    if (!counting) return;
    const Range range{static_cast<const char*>(begin), static_cast<const char*>(begin) + bytes};
    for (const Range& known : shared_memory)
        if (known.begin == range.begin && known.end == range.end) return;
    shared_memory.push_back(range);
}

void count_access(const void* address, std::size_t bytes, Access access) {
    if (!running_launch) return;
    Counts& counts = Worker::mine().counts;
    for (const Range& range : shared_memory)
        if (range.holds(address)) {
            ++(access == Access::kLoad    ? counts.shared_loads
               : access == Access::kStore ? counts.shared_stores
                                          : counts.shared_atomics);
            return;
        }
    if (!Allocations::all().holder_of(address)) return;
    ++(access == Access::kLoad    ? counts.global_loads
       : access == Access::kStore ? counts.global_stores
                                  : counts.global_atomics);
    if (access != Access::kAtomic) counts.global_bytes += bytes;
}

Counts& Counts::operator+=(const Counts& other) {
    global_loads += other.global_loads;
    global_stores += other.global_stores;
    global_bytes += other.global_bytes;
    shared_loads += other.shared_loads;
    shared_stores += other.shared_stores;
    global_atomics += other.global_atomics;
    shared_atomics += other.shared_atomics;
    barriers += other.barriers;
    warp_operations += other.warp_operations;
    return *this;
}

}  // namespace cudasim
