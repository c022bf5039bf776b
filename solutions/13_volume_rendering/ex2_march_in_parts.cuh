// Exercise 13.2: one ray, many threads.
//
// The march is a chain: each step needs the transmittance of all steps before it. Yet a ray can be cut into
// parts that different threads march at the same time, if two parts can be put together afterwards. They can:
// what a part brings is a light and a transmittance, and a pair of parts is again a light and a
// transmittance.
#pragma once
#include "13_volume_rendering/march.cuh"
#include "common/device_buffer.h"
#include "common/todo.h"

namespace volume {

// What is seen through `front` of itself and of `back` behind it.
__host__ __device__ inline Seen<float> behind(const Seen<float>& front, const Seen<float>& back) {
    // TODO(13.2): the light of both, and the part of the light from beyond that gets through both. 3 lines.
    // <solution>
    Seen<float> both;
    both.light = front.light + front.transmittance * back.light;
    both.transmittance = front.transmittance * back.transmittance;
    return both;
    // <stub>
    //| return {glm::vec3(course::kTodo), course::kTodo};
    // </solution>
}

// One thread per part of a ray; part 0 is the one next to the eye.
template <class Field>
__global__ void march_parts_kernel(Seen<float>* parts, Field field, Ray<float> ray, Span<float> span,
                                   MarchSettings settings, int count) {
    const int k = blockIdx.x * blockDim.x + threadIdx.x;
    // TODO(13.2): march part k of `count` equally long parts of the span. No thread may write beyond the
    // last part. About 4 lines.
    // <solution>
    if (k >= count) return;
    const float length_m = (span.far_m - span.near_m) / float(count);
    const Span<float> part{span.near_m + float(k) * length_m, span.near_m + float(k + 1) * length_m};
    parts[k] = march(field, ray, part, settings);
    // <stub>
    //| if (k < count) parts[k] = {glm::vec3(course::kTodo), course::kTodo};
    // </solution>
}

// The whole ray: all parts at the same time, then put together.
template <class Field>
Seen<float> march_in_parts(const Field& field, const Ray<float>& ray, Span<float> span,
                           MarchSettings settings, int count) {
    course::DeviceBuffer<Seen<float>> parts(count);
    // One block more than needed, so that the guard in the kernel is not left to luck.
    march_parts_kernel<<<count / 32 + 2, 32>>>(parts.data(), field, ray, span, settings, count);
    CUDA_CHECK(cudaGetLastError());
    Seen<float> seen;
    for (const Seen<float>& part : parts.download()) seen = behind(seen, part);
    return seen;
}

}  // namespace volume
