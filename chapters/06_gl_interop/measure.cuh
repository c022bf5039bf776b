/// @file
/// What this chapter's measurements share.
#pragma once
#include <cmath>

#include "06_gl_interop/fountain_scene.cuh"

namespace interop {

/// Waits for all that CUDA and OpenGL have been told to do: only then does a clock tell the time of a frame.
inline void finish() {
    CUDA_CHECK(cudaDeviceSynchronize());
    glFinish();
}

/// All droplets in flight, as they are in a fountain that has run for a while.
inline void grow(SharedFountain& fountain, const particle_loop::Fountain& scene) {
    for (std::uint32_t step = 0; step < life_steps(scene); ++step) fountain.step();
}

/// Root mean square of the difference, in steps of the 255 that a colour has.
inline double difference(const course::Image& a, const course::Image& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.rgb.size(); ++k) sum += (a.rgb[k] - b.rgb[k]) * (a.rgb[k] - b.rgb[k]);
    return std::sqrt(sum / double(a.rgb.size()));
}

}  // namespace interop
