/// @file
/// A fiber: a stack of its own on which a kernel's thread can wait while others run on other stacks.
/// Boost.Context's two functions change stacks. (Its class `fiber` is built on them, hands over an object at
/// each switch, and wants one function to run; here a fiber runs one thread after the other and is never
/// done.)
#pragma once
#include <cuda_runtime.h>

#include <boost/context/detail/fcontext.hpp>

#include "runtime/guarded_pages.h"

namespace cudasim {

/// Where a thread waits, for the report when nobody comes.
struct WaitPlace {
    const char* name = "";  ///< "__syncthreads()"
    const char* file = "";
    int line = 0;
    unsigned mask = 0;  ///< lanes it waits for; 0: the whole block
};

struct Fiber {
    /// The OS thread's own stack.
    Fiber() = default;
    /// A new stack. `main` gets the fiber when it is first switched to, and must not return.
    Fiber(void (*main)(boost::context::detail::transfer_t), unsigned number);
    ~Fiber();
    Fiber(const Fiber&) = delete;
    Fiber& operator=(const Fiber&) = delete;

    GuardedPages stack;
    boost::context::detail::fcontext_t context = nullptr;  ///< where to go on
    uint3 thread_index{};                                  ///< threadIdx of the waiting thread
    bool waited = false;                                   ///< the thread that runs here had to wait
    WaitPlace place;

    // What the sanitizers keep for each stack.
    const void* asan_stack = nullptr;
    std::size_t asan_stack_bytes = 0;
    void* asan_fake_stack = nullptr;
    void* tsan_fiber = nullptr;
};

/// Goes on in `to`; returns when somebody switches back to `from`, the fiber that is running.
void switch_fiber(Fiber& from, Fiber& to);
/// To be called first thing in a fiber's main with what it was given.
void arrive_in_fiber(Fiber& me, boost::context::detail::transfer_t transfer);

}  // namespace cudasim
