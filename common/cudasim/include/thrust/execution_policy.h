/// @file
/// Thrust's own header, and some of its algorithms for device memory in a simulator build: Thrust runs them
/// as plain C++ (THRUST_DEVICE_SYSTEM_CPP) on device pointers, which host code may not touch otherwise. Sorts
/// are in sort.h.
#pragma once
#include <cuda_runtime.h>

#include_next <thrust/execution_policy.h>

#include <thrust/adjacent_difference.h>
#include <thrust/binary_search.h>
#include <thrust/copy.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/transform_reduce.h>

#include "cudasim/host_access.h"

namespace thrust {

template <class In, class T>
T reduce(const detail::device_t&, In first, In last, T start) {
    const cudasim::HostAccess allowed;
    return reduce(seq, first, last, start);
}
template <class In, class Change, class Result, class Join>
Result transform_reduce(const detail::device_t&, In first, In last, Change change, Result start, Join join) {
    const cudasim::HostAccess allowed;
    return transform_reduce(seq, first, last, change, start, join);
}
template <class In, class Out>
Out exclusive_scan(const detail::device_t&, In first, In last, Out result) {
    const cudasim::HostAccess allowed;
    return exclusive_scan(seq, first, last, result);
}
template <class In, class Out, class Wanted>
Out copy_if(const detail::device_t&, In first, In last, Out result, Wanted wanted) {
    const cudasim::HostAccess allowed;
    return copy_if(seq, first, last, result, wanted);
}
template <class In, class Values, class Out>
Out upper_bound(const detail::device_t&, In first, In last, Values first_value, Values last_value,
                Out result) {
    const cudasim::HostAccess allowed;
    return upper_bound(seq, first, last, first_value, last_value, result);
}
template <class In, class Out>
Out adjacent_difference(const detail::device_t&, In first, In last, Out result) {
    const cudasim::HostAccess allowed;
    return adjacent_difference(seq, first, last, result);
}

}  // namespace thrust
