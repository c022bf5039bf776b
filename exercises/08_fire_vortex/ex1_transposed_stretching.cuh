// Exercise 08.1: stretching that keeps the books.
//
// The chapter stretches a vorton by (alpha . grad) u, read from the grid. Summed over all vortons that does
// not give nought, though the sum of all alpha is the total spin of the gas, and nothing inside the gas can
// change it. The *transposed* form does keep it: component k of the rate is alpha . (du/dx_k). For vorton i
// and what vorton j does to it, with r = x_i - x_j and u = f(r^2) alpha_j x r / (4 pi), that is
//
//     4 pi rate_i = f (alpha_i x alpha_j) + 2 f' (alpha_i . (alpha_j x r)) r
//
// where f is q / r^3 of Winckelmans and Leonard, and f' its derivative by r^2:
//
//     f = (r^2 + 5/2 c) / s^(5/2),   f' = -(3/2 r^2 + 21/4 c) / s^(7/2),   c = sigma^2, s = r^2 + c.
//
// Exchange i and j (so r becomes -r): both terms change sign. What j gives to i, i takes from j.
#pragma once
#include "08_fire_vortex/blob.cuh"
#include "common/todo.h"

namespace vortex {

// d(alpha_i)/dt that vorton j causes. `r` is x_i - x_j.
inline __host__ __device__ glm::vec3 transposed_stretching(glm::vec3 alpha_i, glm::vec3 alpha_j, glm::vec3 r,
                                                           float core2) {
    // TODO(8.1): the formula above. About 6 lines.
    return glm::vec3(float(course::kTodo));
}

// One thread per vorton: the sum over all others. position and strength as everywhere in the chapter.
inline __global__ void transposed_stretching_kernel(float4* rate, const float4* position,
                                                    const float4* strength, std::uint32_t n, float core2) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    // TODO(8.1): add up what all vortons do to vorton i, and store it; w of the result is 0.
    // Does j = i need an exception? About 6 lines.
    const float todo = float(course::kTodo);
    if (i < n) rate[i] = make_float4(todo, todo, todo, todo);
}

}  // namespace vortex
