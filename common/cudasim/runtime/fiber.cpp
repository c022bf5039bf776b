#include "runtime/fiber.h"

#include <cstdlib>

#include "runtime/report.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace cudasim {
namespace {

// Odd numbers of pages: equal offsets on many stacks then fall into different sets of the cache and the TLB.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kStackPages = 65;  // sanitized frames are larger
#else
constexpr std::size_t kStackPages = 33;
#endif

}  // namespace

Fiber::Fiber(void (*main)(boost::context::detail::transfer_t), unsigned number)
    : stack(kStackPages * page_bytes(), GuardedPages::Guard::kBelow) {
    if (!stack.begin()) {
        say("no memory for the stack of a simulated thread: take fewer workers (CUDASIM_THREADS) or smaller "
            "blocks");
        std::abort();
    }
    // Stacks start at different places in their first page, again to spread over the sets of the cache.
    const std::size_t offset = number * 320 % page_bytes();
    context = boost::context::detail::make_fcontext(stack.end() - offset, stack.size() - offset, main);
    asan_stack = stack.begin();
    asan_stack_bytes = stack.size();
#if defined(__SANITIZE_THREAD__)
    tsan_fiber = __tsan_create_fiber(0);
#endif
}

Fiber::~Fiber() {
#if defined(__SANITIZE_THREAD__)
    if (stack.begin()) __tsan_destroy_fiber(tsan_fiber);
#endif
}

void switch_fiber(Fiber& from, Fiber& to) {
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_start_switch_fiber(&from.asan_fake_stack, to.asan_stack, to.asan_stack_bytes);
#endif
#if defined(__SANITIZE_THREAD__)
    if (!from.tsan_fiber) from.tsan_fiber = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(to.tsan_fiber, 0);
#endif
    arrive_in_fiber(from, boost::context::detail::jump_fcontext(to.context, &from));
}

void arrive_in_fiber(Fiber& me, boost::context::detail::transfer_t transfer) {
    Fiber& left = *static_cast<Fiber*>(transfer.data);
    left.context = transfer.fctx;
#if defined(__SANITIZE_ADDRESS__)
    // The sanitizer says which stack was left: the only way to learn the bounds of the OS thread's own.
    __sanitizer_finish_switch_fiber(me.asan_fake_stack, &left.asan_stack, &left.asan_stack_bytes);
#else
    (void)me;
#endif
}

}  // namespace cudasim
