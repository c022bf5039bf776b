/// @file
/// From `kernel<<<grid, block>>>(arguments)` to a loop over threads.
///
/// The rewriter turns the launch into `CUDASIM_LAUNCH(kernel)(grid, block)(arguments)`: the first call fixes
/// the configuration, the second runs the kernel. It has ended when the call returns.
#pragma once
#include <cstddef>
#include <type_traits>

#include "cudasim/streams_and_events.h"
#include "cudasim/thread_index.h"
#include "cudasim/thread_loop.h"

namespace cudasim {

/// A launch as the runtime sees it: what, where in the source, and the loop that runs its threads.
struct LaunchRequest {
    const char* kernel;
    const char* file;
    int line;
    dim3 grid, block;
    std::size_t shared_bytes;
    void (*run_threads)(RunningBlock&, bool&, const void*);
    const void* call;
};

/// Runs the grid. Errors go where cudaGetLastError finds them.
void run_grid(const LaunchRequest& request);

/// False, and an error noted, if a GPU could not follow this pointer: it points to host or freed memory.
bool check_argument(const LaunchRequest& request, int number, const void* pointer);

template <class T>
bool check_argument_of(const LaunchRequest& request, int number, const T& argument) {
    if constexpr (std::is_pointer_v<T> && !std::is_function_v<std::remove_pointer_t<T>>)
        return check_argument(request, number, argument);
    else
        return true;
}

/// `kernel<<<grid, block, shared, stream>>>`, waiting for its arguments. `Kernel` is a lambda that calls it.
/// `Parameters` are the kernel's own if they are known.
template <class Kernel>
struct PreparedLaunchBase {
    Kernel kernel;
    LaunchRequest request;

    template <class... Arguments>
    void run(const Arguments&... arguments) {
        const auto call = [=, k = kernel] { k(arguments...); };
        request.run_threads = &run_fresh_threads<decltype(call)>;
        request.call = &call;
        int number = 0;
        if ((check_argument_of(request, ++number, arguments) && ...)) run_grid(request);
    }
};

template <class Kernel, class Signature>
struct PreparedLaunch;

// A kernel that is one function: its arguments convert as in any call, so NULL and {...} work.
template <class Kernel, class... Parameters>
struct PreparedLaunch<Kernel, void (*)(Parameters...)> : PreparedLaunchBase<Kernel> {
    void operator()(Parameters... arguments) { this->run(arguments...); }
};

// A template whose arguments are deduced, or an overloaded kernel: the arguments say which it is.
struct Deduced {};
template <class Kernel>
struct PreparedLaunch<Kernel, Deduced> : PreparedLaunchBase<Kernel> {
    template <class... Arguments>
    void operator()(Arguments... arguments) {
        static_assert(
            std::is_invocable_v<Kernel, Arguments&...>,
            "the kernel does not take these arguments. In a launch that leaves template arguments to be "
            "deduced, write nullptr instead of NULL and name the type before {...}");
        this->run(arguments...);
    }
};

/// Asks for one function's type; does not exist for a set of overloads or a template without its arguments.
template <class Probe, class... Parameters>
auto signature_of(Probe, void (*kernel)(Parameters...)) -> decltype(kernel);

/// The first half of a launch: knows the kernel.
template <class Kernel, class Probe>
struct LaunchSite {
    Kernel kernel;
    Probe probe;
    const char *name, *file;
    int line;

    auto operator()(dim3 grid, dim3 block, std::size_t shared_bytes = 0, cudaStream_t = nullptr) const {
        const LaunchRequest request{name, file, line, grid, block, shared_bytes, nullptr, nullptr};
        if constexpr (std::is_invocable_v<Probe, int>)
            return PreparedLaunch<Kernel, std::invoke_result_t<Probe, int>>{{kernel, request}};
        else
            return PreparedLaunch<Kernel, Deduced>{{kernel, request}};
    }
};
template <class Kernel, class Probe>
LaunchSite<Kernel, Probe> launch_site(Kernel kernel, Probe probe, const char* name, const char* file,
                                      int line) {
    return {kernel, probe, name, file, line};
}

}  // namespace cudasim

// The kernel's name may hold commas (template arguments), hence the dots.
#define CUDASIM_LAUNCH(...)                                                                                 \
    ::cudasim::launch_site(                                                                                 \
        [&](auto&... arguments) __attribute__((always_inline))->decltype((void)__VA_ARGS__(arguments...)) { \
            __VA_ARGS__(arguments...);                                                                      \
        },                                                                                                  \
        [&](auto probe) -> decltype(::cudasim::signature_of(probe, __VA_ARGS__)) { return nullptr; },       \
        #__VA_ARGS__, __FILE__, __LINE__)
