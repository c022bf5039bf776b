// cudaMalloc, cudaFree, cudaMemcpy, cudaMemset: checked against the list of allocations.
#include <algorithm>
#include <cstring>

#include "runtime/allocations.h"
#include "runtime/host_call.h"
#include "runtime/host_memory.h"
#include "runtime/launch_errors.h"
#include "runtime/recording.h"
#include "runtime/report.h"
#include "runtime/settings.h"

namespace cudasim {
namespace {

cudaError_t refuse(cudaError_t error, const char* call, const char* file, int line, const std::string& why) {
    say(std::string(call) + " at " + text_of(file, line) + ": " + why);
    return set_last_error(error);
}

const char* name_of(cudaMemcpyKind kind) {
    constexpr const char* kNames[] = {"cudaMemcpyHostToHost", "cudaMemcpyHostToDevice", "cudaMemcpyDeviceToHost",
                                      "cudaMemcpyDeviceToDevice", "cudaMemcpyDefault"};
    return kNames[kind];
}

/// Empty, or what is wrong with using `bytes` from `address` as the `role` ("source", "destination") of a copy.
std::string check_range(const void* address, std::size_t bytes, const Allocation* allocation, const char* role) {
    if (!address) return std::string("the ") + role + " is a null pointer";
    if (!allocation) return "";  // host memory: nothing is known about it
    const auto left = static_cast<std::size_t>(allocation->end() - static_cast<const char*>(address));
    if (bytes <= left) return "";
    return std::to_string(bytes) + " bytes do not fit: the " + role + " has " + std::to_string(left) +
           " bytes left of " + text_of(*allocation);
}

/// Empty, or what is wrong with the place of a copy's source or destination.
std::string check_place(const Allocation* allocation, bool wants_device, cudaMemcpyKind kind, const char* role) {
    const bool on_device = allocation && allocation->on_device();
    if (kind == cudaMemcpyDefault || on_device == wants_device) return "";
    return std::string("the ") + role + (on_device ? " is device memory" : " is not device memory") +
           ", which does not fit " + name_of(kind);
}

/// The allocation that holds a byte at `address`. (One that merely ends there does not count.)
const Allocation* holder_of(const void* address) {
    const Allocation* found = Allocations::all().find(address);
    return found && (address < found->end() || found->begin == address) ? found : nullptr;
}

// After all other destructors (101 is the last): static objects may free device memory, too.
__attribute__((destructor(101))) void report_leaks() {
    const Allocations& all = Allocations::all();
    if (all.live_count() == 0) return;
    std::string text = std::to_string(all.live_bytes()) + " bytes of device memory leaked, in " +
                       std::to_string(all.live_count()) + " allocations that were never freed";
    constexpr int kShown = 5;
    int shown = 0;
    for (const auto& entry : all.by_address())
        if (entry.second.kind == MemoryKind::kDevice && ++shown <= kShown) text += "\n" + text_of(entry.second);
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
    const AccessTo until_now(holder_of(*pointer));
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

cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, const char* file,
                       int line) {
    const HostCall call("cudaMemcpy");
    if (kind < cudaMemcpyHostToHost || kind > cudaMemcpyDefault)
        return refuse(cudaErrorInvalidMemcpyDirection, "cudaMemcpy", file, line, "no such cudaMemcpyKind");
    if (bytes == 0) return set_last_error(take_kernel_fault());
    const Allocation *target = holder_of(to), *source = holder_of(from);
    const bool to_device = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice;
    const bool from_device = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;
    for (const std::string& why :
         {check_range(to, bytes, target, "destination"), check_range(from, bytes, source, "source"),
          check_place(target, to_device, kind, "destination"), check_place(source, from_device, kind, "source")})
        if (!why.empty()) return refuse(cudaErrorInvalidValue, "cudaMemcpy", file, line, why);
    const AccessTo write(target), read(source);
    std::memmove(to, from, bytes);
    return set_last_error(take_kernel_fault());
}

cudaError_t cudaMemset(void* to, int byte, std::size_t bytes, const char* file, int line) {
    const HostCall call("cudaMemset");
    if (bytes == 0) return cudaSuccess;
    const Allocation* target = holder_of(to);
    std::string why = check_range(to, bytes, target, "destination");
    if (why.empty() && !target) why = "the destination is not device memory";
    if (!why.empty()) return refuse(cudaErrorInvalidValue, "cudaMemset", file, line, why);
    const AccessTo write(target);
    std::memset(to, byte, bytes);
    return cudaSuccess;
}
