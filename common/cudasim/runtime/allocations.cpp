#include "runtime/allocations.h"

#include <cstdlib>

#include "cudasim/host_access.h"
#include "runtime/poison.h"
#include "runtime/report.h"
#include "runtime/sanitizer_hooks.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#endif

namespace cudasim {
namespace {

constexpr std::size_t kAlignment = 256;  // as cudaMalloc promises

void set_host_access(const Allocation* allocation, bool allowed) {
#if defined(__SANITIZE_ADDRESS__)
    if (!allocation || allocation->kind != MemoryKind::kDevice) return;
    if (allowed) ASAN_UNPOISON_MEMORY_REGION(allocation->begin, allocation->bytes);
    if (!allowed) ASAN_POISON_MEMORY_REGION(allocation->begin, allocation->bytes);
#else
    (void)allocation, (void)allowed;
#endif
}

}  // namespace

Allocations& Allocations::all() {
    // Never destroyed: static objects may free device memory when the program ends.
    static Allocations& all = *(install_sanitizer_hooks(), new Allocations);
    return all;
}

void Allocations::add(Allocation allocation) {
    if (allocation.kind == MemoryKind::kDevice) {
        live_bytes_ += allocation.bytes;
        ++live_count_;
    }
    const char* begin = allocation.begin;
    by_address_.insert_or_assign(begin, std::move(allocation));
}

void Allocations::add_foreign(void* begin, std::size_t bytes, MemoryKind kind) {
    Allocation allocation;
    allocation.begin = static_cast<char*>(begin);
    allocation.bytes = bytes;
    allocation.kind = kind;
    add(std::move(allocation));
}

void Allocations::remove(const Allocation& allocation) {
    if (allocation.kind == MemoryKind::kDevice) {
        live_bytes_ -= allocation.bytes;
        --live_count_;
    }
    by_address_.erase(allocation.begin);
}

const Allocation* Allocations::find(const void* address) const {
    const char* byte = static_cast<const char*>(address);
    auto next = by_address_.upper_bound(byte);
    if (next == by_address_.begin()) return nullptr;
    const Allocation& candidate = std::prev(next)->second;
    return byte <= candidate.end() ? &candidate : nullptr;
}

const Allocation* Allocations::holder_of(const void* address) const {
    const Allocation* found = find(address);
    return found && address < found->end() ? found : nullptr;
}

const Allocation* Allocations::find_begin(const void* address) const {
    const auto found = by_address_.find(static_cast<const char*>(address));
    return found == by_address_.end() ? nullptr : &found->second;
}

const Allocation* Allocations::find_before(const void* address, std::size_t distance) const {
    const char* byte = static_cast<const char*>(address);
    auto next = by_address_.upper_bound(byte);
    if (next == by_address_.begin()) return nullptr;
    const Allocation& candidate = std::prev(next)->second;
    return byte < candidate.end() + distance ? &candidate : nullptr;
}

Allocation make_allocation(std::size_t bytes, MemoryKind kind, const char* file, int line) {
    Allocation made;
    made.bytes = bytes;
    made.kind = kind;
    made.file = file;
    made.line = line;
    const std::size_t rounded = (bytes + kAlignment - 1) / kAlignment * kAlignment;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    // From the heap: the sanitizers then know its exact size and who allocated it.
    void* memory = nullptr;
    if (posix_memalign(&memory, kAlignment, bytes) == 0) made.begin = static_cast<char*>(memory);
    (void)rounded;
#else
    made.pages = GuardedPages(rounded, GuardedPages::Guard::kAbove);
    if (made.pages.begin()) made.begin = made.pages.end() - rounded;
#endif
    if (made.begin) fill_with_poison(made.begin, bytes);
    return made;
}

void free_allocation(const Allocation& allocation) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    std::free(allocation.begin);
#else
    (void)allocation;  // its pages free themselves
#endif
}

AccessTo::AccessTo(const Allocation* allocation) : allocation_(allocation) {
    set_host_access(allocation_, true);
}
AccessTo::~AccessTo() {
    set_host_access(allocation_, false);
}

HostAccess::HostAccess() {
    for (const auto& entry : Allocations::all().by_address()) set_host_access(&entry.second, true);
}
HostAccess::~HostAccess() {
    for (const auto& entry : Allocations::all().by_address()) set_host_access(&entry.second, false);
}

std::string text_of(const Allocation& allocation) {
    const std::string bytes = "the " + std::to_string(allocation.bytes) + " bytes ";
    if (allocation.kind == MemoryKind::kSymbol) return bytes + "of a __device__ or __constant__ variable";
    if (allocation.kind == MemoryKind::kGraphics) return bytes + "of a mapped OpenGL buffer";
    return bytes + "allocated at " + text_of(allocation.file, allocation.line);
}

}  // namespace cudasim
