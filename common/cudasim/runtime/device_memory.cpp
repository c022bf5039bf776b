// cudaMalloc and cudaFree: they keep the list of allocations, and say at exit what was forgotten.
#include <algorithm>

#include "runtime/allocations.h"
#include "runtime/errors.h"
#include "runtime/host_call.h"
#include "runtime/host_memory.h"
#include "runtime/recording.h"
#include "runtime/report.h"
#include "runtime/settings.h"

namespace cudasim {
namespace {

// After all other destructors (101 is the last): static objects may free device memory, too.
__attribute__((destructor(101))) void report_leaks() {
    const Allocations& all = Allocations::all();
    if (all.live_count() == 0) return;
    std::string text = std::to_string(all.live_bytes()) + " bytes of device memory leaked, in " +
                       std::to_string(all.live_count()) + " allocations that were never freed";
    constexpr int kShown = 5;
    int shown = 0;
    for (const auto& entry : all.by_address())
        if (entry.second.kind == MemoryKind::kDevice && ++shown <= kShown)
            text += "\n" + text_of(entry.second);
    if (shown > kShown) text += "\nand " + std::to_string(shown - kShown) + " more";
    say(text);
    if (settings().leak_exit_code == 0) return;
    std::fflush(nullptr);
    std::_Exit(settings().leak_exit_code);
}

}  // namespace

cudaError_t allocate(void** pointer, std::size_t bytes, MemoryKind kind, const char* file, int line) {
    const bool on_device = kind == MemoryKind::kDevice;
    const HostCall call(on_device ? "cudaMalloc" : "cudaMallocHost");
    if (!pointer) return set_last_error(cudaErrorInvalidValue);
    *pointer = nullptr;
    if (bytes == 0) return cudaSuccess;
    // The system would promise more memory than there is, and end the program when it is used. (Asking takes
    // long beside a small allocation.)
    constexpr std::size_t kSmall = std::size_t{16} << 20;
    if (bytes > kSmall && bytes > available_host_memory()) return set_last_error(cudaErrorMemoryAllocation);
    Allocation made = make_allocation(bytes, kind, file, line);
    if (!made.begin) return set_last_error(cudaErrorMemoryAllocation);
    *pointer = made.begin;
    if (on_device) note_allocation(bytes);
    Allocations::all().add(std::move(made));
    const AccessTo until_now(Allocations::all().holder_of(*pointer));
    return cudaSuccess;
}

cudaError_t release(void* pointer, MemoryKind kind, const char* file, int line) {
    const char* name = kind == MemoryKind::kDevice ? "cudaFree" : "cudaFreeHost";
    const HostCall call(name);
    if (!pointer) return cudaSuccess;
    const Allocation* found = Allocations::all().find_begin(pointer);
    if (!found || found->kind != kind)
        return refuse(cudaErrorInvalidValue, name, file, line,
                      "this pointer does not come from the matching allocation, or was freed before");
    free_allocation(*found);
    Allocations::all().remove(*found);
    return cudaSuccess;
}

void add_symbol(void* symbol, std::size_t bytes) {
    const HostCall call("a function that takes a symbol");
    if (!Allocations::all().find_begin(symbol))
        Allocations::all().add_foreign(symbol, bytes, MemoryKind::kSymbol);
}

void free_all_device_memory() {
    Allocations& all = Allocations::all();
    while (all.live_count() > 0)
        for (const auto& entry : all.by_address())
            if (entry.second.kind == MemoryKind::kDevice) {
                free_allocation(entry.second);
                all.remove(entry.second);
                break;  // the iterators are no longer good
            }
}

}  // namespace cudasim

using namespace cudasim;

cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* total_bytes) {
    const HostCall call("cudaMemGetInfo");
    if (!free_bytes || !total_bytes) return set_last_error(cudaErrorInvalidValue);
    *total_bytes = total_host_memory();
    *free_bytes = std::min(available_host_memory(), *total_bytes);
    return cudaSuccess;
}
