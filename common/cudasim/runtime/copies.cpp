// cudaMemcpy and cudaMemset: both ends of a copy are checked against the list of allocations.
#include <cstring>

#include "runtime/allocations.h"
#include "runtime/errors.h"
#include "runtime/host_call.h"
#include "runtime/report.h"

using namespace cudasim;

namespace {

const char* name_of(cudaMemcpyKind kind) {
    constexpr const char* kNames[] = {"cudaMemcpyHostToHost", "cudaMemcpyHostToDevice",
                                      "cudaMemcpyDeviceToHost", "cudaMemcpyDeviceToDevice",
                                      "cudaMemcpyDefault"};
    return kNames[kind];
}

/// Empty, or what is wrong with using `bytes` from `address` as the `role` ("source", "destination") of a
/// copy.
std::string check_range(const void* address, std::size_t bytes, const Allocation* allocation,
                        const char* role) {
    if (!address) return std::string("the ") + role + " is a null pointer";
    if (!allocation) return "";  // host memory: nothing is known about it
    const auto left = static_cast<std::size_t>(allocation->end() - static_cast<const char*>(address));
    if (bytes <= left) return "";
    return std::to_string(bytes) + " bytes do not fit: the " + role + " has " + std::to_string(left) +
           " bytes left of " + text_of(*allocation);
}

/// Empty, or what is wrong with the place of a copy's source or destination.
std::string check_place(const Allocation* allocation, bool wants_device, cudaMemcpyKind kind,
                        const char* role) {
    const bool on_device = allocation && allocation->on_device();
    if (kind == cudaMemcpyDefault || on_device == wants_device) return "";
    return std::string("the ") + role + (on_device ? " is device memory" : " is not device memory") +
           ", which does not fit " + name_of(kind);
}

}  // namespace

cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, const char* file,
                       int line) {
    const HostCall call("cudaMemcpy");
    if (kind < cudaMemcpyHostToHost || kind > cudaMemcpyDefault)
        return refuse(cudaErrorInvalidMemcpyDirection, "cudaMemcpy", file, line, "no such cudaMemcpyKind");
    if (bytes == 0) return set_last_error(take_kernel_fault());
    const Allocation *target = Allocations::all().holder_of(to), *source = Allocations::all().holder_of(from);
    const bool to_device = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice;
    const bool from_device = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;
    for (const std::string& why :
         {check_range(to, bytes, target, "destination"), check_range(from, bytes, source, "source"),
          check_place(target, to_device, kind, "destination"),
          check_place(source, from_device, kind, "source")})
        if (!why.empty()) return refuse(cudaErrorInvalidValue, "cudaMemcpy", file, line, why);
    const AccessTo write(target), read(source);
    std::memmove(to, from, bytes);
    return set_last_error(take_kernel_fault());
}

cudaError_t cudaMemset(void* to, int byte, std::size_t bytes, const char* file, int line) {
    const HostCall call("cudaMemset");
    if (bytes == 0) return cudaSuccess;
    const Allocation* target = Allocations::all().holder_of(to);
    std::string why = check_range(to, bytes, target, "destination");
    if (why.empty() && !target) why = "the destination is not device memory";
    if (!why.empty()) return refuse(cudaErrorInvalidValue, "cudaMemset", file, line, why);
    const AccessTo write(target);
    std::memset(to, byte, bytes);
    return cudaSuccess;
}
