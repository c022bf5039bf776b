// Exercise 11.1: mean and spread of all particles' neighbours, in one reduction.
//
// A mean says little about a crowd: 30 neighbours each, or 60 for one half and none for the other? The spread
// tells. The textbook's "mean of the squares minus square of the mean" needs one pass, and subtracts two
// large numbers that are nearly the same: in floats nothing may be left. Parts that carry count, mean and sum
// of squared distances *from their own mean* can be merged without that.
#pragma once
#include "04_parallel_patterns/reduce.cuh"
#include "common/todo.h"

namespace compared {

// What is known of some values: how many, their mean, and the sum of (value - mean)^2.
struct Spread {
    float count, mean, squares;
};

// An operation for chapter 04's TreeReduction.
struct MergeSpreads {
    using Value = Spread;

    // What is known of no values.
    static __host__ __device__ Spread nothing() {
        // TODO(11.1): merged with anything it must change nothing. 1 line.
        return {float(course::kTodo), float(course::kTodo), float(course::kTodo)};
    }

    // What is known of the values of both.
    static __host__ __device__ Spread combine(Spread a, Spread b) {
        // TODO(11.1): the common mean lies between the two, nearer to that of more values. Each part's
        // squares grow when taken from the common mean. Nothing with nothing is not NaN. About 6 lines.
        (void)a;
        (void)b;
        return {float(course::kTodo), float(course::kTodo), float(course::kTodo)};
    }
};

// An array of numbers as an array of what is known of each.
struct SpreadsOfOne {
    const float* value;
    __device__ Spread operator[](std::uint32_t i) const {
        // TODO(11.1): of one value. 1 line.
        (void)i;
        return {float(course::kTodo), float(course::kTodo), float(course::kTodo)};
    }
};

// Count, mean and sum of squares of n values on the device.
inline Spread spread_of(const float* value, std::uint32_t n) {
    patterns::TreeReduction<MergeSpreads> reduce(n);
    reduce(SpreadsOfOne{value}, n);
    return reduce.download();
}

}  // namespace compared
