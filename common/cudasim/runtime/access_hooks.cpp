// Code compiled with -fsanitize=thread calls these functions at each access to memory. ThreadSanitizer's own
// library looks for races in them; here they count. Only programs built with COUNT_ACCESSES link them.
#include <cstddef>
#include <cstdint>

#include "runtime/counting.h"

using cudasim::Access;
using cudasim::count_access;

namespace cudasim {

// Of the atomics in cudasim/atomics.h. What they are made of, below, is not counted again.
void count_atomic(const void* address);
void count_atomic(const void* address) {
    count_access(address, 0, Access::kAtomic);
}

}  // namespace cudasim

extern "C" {

void __tsan_init() {
    cudasim::begin_counting();
}
void __tsan_func_entry(void*) {}
void __tsan_func_exit() {}

// clang-format off
#define HOOKS_OF_SIZE(bytes)                                                                                    \
    void __tsan_read##bytes(void* address) { count_access(address, bytes, Access::kLoad); }                     \
    void __tsan_write##bytes(void* address) { count_access(address, bytes, Access::kStore); }                   \
    void __tsan_unaligned_read##bytes(void* address) { count_access(address, bytes, Access::kLoad); }           \
    void __tsan_unaligned_write##bytes(void* address) { count_access(address, bytes, Access::kStore); }         \
    void __tsan_volatile_read##bytes(void* address) { count_access(address, bytes, Access::kLoad); }            \
    void __tsan_volatile_write##bytes(void* address) { count_access(address, bytes, Access::kStore); }
HOOKS_OF_SIZE(1) HOOKS_OF_SIZE(2) HOOKS_OF_SIZE(4) HOOKS_OF_SIZE(8) HOOKS_OF_SIZE(16)
    // clang-format on

    void __tsan_read_range(void* address, std::size_t bytes) {
    count_access(address, bytes, Access::kLoad);
}
void __tsan_write_range(void* address, std::size_t bytes) {
    count_access(address, bytes, Access::kStore);
}
void __tsan_vptr_read(void**) {}
void __tsan_vptr_update(void**, void*) {}

// The compiler replaces atomic operations by calls: these do what it asked for, in the strictest order.
void __tsan_atomic_thread_fence(int) {
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
}
void __tsan_atomic_signal_fence(int) {
    __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

// clang-format off
#define FETCH(bits, name)                                                                                       \
    std::uint##bits##_t __tsan_atomic##bits##_fetch_##name(volatile std::uint##bits##_t* address,               \
                                                           std::uint##bits##_t value, int) {                    \
        return __atomic_fetch_##name(address, value, __ATOMIC_SEQ_CST);                                         \
    }
#define COMPARE(bits, strength, weak)                                                                           \
    int __tsan_atomic##bits##_compare_exchange_##strength(volatile std::uint##bits##_t* address,                \
                                                          std::uint##bits##_t* expected,                        \
                                                          std::uint##bits##_t value, int, int) {                \
        return __atomic_compare_exchange_n(address, expected, value, weak, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST); \
    }
#define ATOMICS_OF_SIZE(bits)                                                                                   \
    std::uint##bits##_t __tsan_atomic##bits##_load(const volatile std::uint##bits##_t* address, int) {          \
        return __atomic_load_n(address, __ATOMIC_SEQ_CST);                                                      \
    }                                                                                                           \
    void __tsan_atomic##bits##_store(volatile std::uint##bits##_t* address, std::uint##bits##_t value, int) {   \
        __atomic_store_n(address, value, __ATOMIC_SEQ_CST);                                                     \
    }                                                                                                           \
    std::uint##bits##_t __tsan_atomic##bits##_exchange(volatile std::uint##bits##_t* address,                   \
                                                       std::uint##bits##_t value, int) {                        \
        return __atomic_exchange_n(address, value, __ATOMIC_SEQ_CST);                                           \
    }                                                                                                           \
    FETCH(bits, add) FETCH(bits, sub) FETCH(bits, and) FETCH(bits, or) FETCH(bits, xor)                         \
    COMPARE(bits, strong, false) COMPARE(bits, weak, true)
ATOMICS_OF_SIZE(8) ATOMICS_OF_SIZE(16) ATOMICS_OF_SIZE(32) ATOMICS_OF_SIZE(64)
// clang-format on

}  // extern "C"
