/// @file
/// Atomic operations on device and shared memory. Each returns the value from before, as CUDA's do.
#pragma once
#include <cstring>
#include <type_traits>

namespace cudasim {

#if defined(CUDASIM_COUNT_ACCESSES)
void count_atomic(const void* address);
#else
inline void count_atomic(const void*) {}
#endif

/// Keeps T from being deduced, so that `atomicAdd(&unsigned_counter, 1)` converts its 1 as a plain call
/// would.
template <class T>
struct Exactly {
    using type = T;
};
template <class T>
using exactly_t = typename Exactly<T>::type;

/// Replaces *address by update(*address) in one step. Works for any type of 4 or 8 bytes.
template <class T, class Update>
T atomic_update(T* address, Update update) {
    static_assert(sizeof(T) == 4 || sizeof(T) == 8, "atomics exist for 4 and 8 bytes only");
    count_atomic(address);
    using Bits = std::conditional_t<sizeof(T) == 4, unsigned, unsigned long long>;
    Bits* bits = reinterpret_cast<Bits*>(address);
    Bits seen = __atomic_load_n(bits, __ATOMIC_RELAXED);
    for (;;) {
        T before;
        std::memcpy(&before, &seen, sizeof before);
        const T after = update(before);
        Bits wanted;
        std::memcpy(&wanted, &after, sizeof wanted);
        if (__atomic_compare_exchange_n(bits, &seen, wanted, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
            return before;
    }
}

}  // namespace cudasim

template <class T>
T atomicAdd(T* address, cudasim::exactly_t<T> value) {
    if constexpr (std::is_integral_v<T>) {
        cudasim::count_atomic(address);
        return __atomic_fetch_add(address, value, __ATOMIC_RELAXED);
    } else {
        return cudasim::atomic_update(address, [=](T before) { return before + value; });
    }
}
template <class T>
T atomicSub(T* address, cudasim::exactly_t<T> value) {
    static_assert(std::is_integral_v<T>, "CUDA has atomicSub for integers only: add the negative value");
    cudasim::count_atomic(address);
    return __atomic_fetch_sub(address, value, __ATOMIC_RELAXED);
}
template <class T>
T atomicMin(T* address, cudasim::exactly_t<T> value) {
    static_assert(std::is_integral_v<T>, "CUDA has atomicMin for integers only");
    return cudasim::atomic_update(address, [=](T before) { return value < before ? value : before; });
}
template <class T>
T atomicMax(T* address, cudasim::exactly_t<T> value) {
    static_assert(std::is_integral_v<T>, "CUDA has atomicMax for integers only");
    return cudasim::atomic_update(address, [=](T before) { return before < value ? value : before; });
}
template <class T>
T atomicExch(T* address, cudasim::exactly_t<T> value) {
    return cudasim::atomic_update(address, [=](T) { return value; });
}
/// Stores `value` if *address equals `expected`.
template <class T>
T atomicCAS(T* address, cudasim::exactly_t<T> expected, cudasim::exactly_t<T> value) {
    static_assert(std::is_integral_v<T>, "CUDA has atomicCAS for integers only");
    cudasim::count_atomic(address);
    __atomic_compare_exchange_n(address, &expected, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
    return expected;  // which now holds what was found
}
template <class T>
T atomicAnd(T* address, cudasim::exactly_t<T> value) {
    cudasim::count_atomic(address);
    return __atomic_fetch_and(address, value, __ATOMIC_RELAXED);
}
template <class T>
T atomicOr(T* address, cudasim::exactly_t<T> value) {
    cudasim::count_atomic(address);
    return __atomic_fetch_or(address, value, __ATOMIC_RELAXED);
}
template <class T>
T atomicXor(T* address, cudasim::exactly_t<T> value) {
    cudasim::count_atomic(address);
    return __atomic_fetch_xor(address, value, __ATOMIC_RELAXED);
}
/// Counts up to `limit`, then starts again at 0.
inline unsigned atomicInc(unsigned* address, unsigned limit) {
    return cudasim::atomic_update(address, [=](unsigned before) { return before >= limit ? 0 : before + 1; });
}
/// Counts down from `limit` to 0, then starts again at `limit`.
inline unsigned atomicDec(unsigned* address, unsigned limit) {
    return cudasim::atomic_update(
        address, [=](unsigned before) { return before == 0 || before > limit ? limit : before - 1; });
}

// Writes before the fence are seen before writes after it, by other blocks (__threadfence), too.
inline void __threadfence() {
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
}
inline void __threadfence_system() {
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
}
inline void __threadfence_block() {
    __atomic_signal_fence(__ATOMIC_SEQ_CST);
}  // a block runs on one worker
