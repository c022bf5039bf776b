/// @file
/// Thrust's own header, and its sorts of device memory in a simulator build: Thrust runs them as plain C++
/// (THRUST_DEVICE_SYSTEM_CPP) on device pointers, which host code may not touch otherwise.
#pragma once
#include <cuda_runtime.h>
#include <thrust/execution_policy.h>

#include_next <thrust/sort.h>

#include "cudasim/host_access.h"

namespace thrust {

template <class Key>
void sort(const detail::device_t&, Key* first, Key* last) {
    const cudasim::HostAccess allowed;
    sort(seq, first, last);
}
template <class Key>
void stable_sort(const detail::device_t&, Key* first, Key* last) {
    const cudasim::HostAccess allowed;
    stable_sort(seq, first, last);
}
template <class Key, class Value>
void sort_by_key(const detail::device_t&, Key* first, Key* last, Value* values) {
    const cudasim::HostAccess allowed;
    sort_by_key(seq, first, last, values);
}
template <class Key, class Value>
void stable_sort_by_key(const detail::device_t&, Key* first, Key* last, Value* values) {
    const cudasim::HostAccess allowed;
    stable_sort_by_key(seq, first, last, values);
}

}  // namespace thrust
