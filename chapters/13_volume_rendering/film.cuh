/// @file
/// From linear light to a photograph: the lens's glare and the film curve of chapter 07, as kernels.
#pragma once
#include <cuda_runtime.h>

#include <algorithm>

#include "13_volume_rendering/ray.h"
#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "common/image.h"

namespace volume {

constexpr int kGlareShrink = 4;  // glare is smooth: a quarter of the pixels on each axis shows all of it

/// One thread per small pixel: the mean light of the up to 16 pixels that it covers.
inline __global__ void shrink_kernel(float4* small, const float4* light, int width, int height,
                                     int small_width, int small_height) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= small_width * small_height) return;
    const int x0 = i % small_width * kGlareShrink, y0 = i / small_width * kGlareShrink;
    glm::vec3 sum(0);
    int count = 0;
    for (int y = y0; y < min(y0 + kGlareShrink, height); ++y)
        for (int x = x0; x < min(x0 + kGlareShrink, width); ++x, ++count) {
            const float4 v = light[y * width + x];
            sum += glm::vec3(v.x, v.y, v.z);
        }
    sum /= float(count);
    small[i] = make_float4(sum.x, sum.y, sum.z, 0);
}

/// One thread per pixel: 17 samples of a Gaussian along `step`; the rim continues beyond the picture.
inline __global__ void blur_kernel(float4* to, const float4* from, int width, int height, int step_x,
                                   int step_y) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= width * height) return;
    glm::vec3 sum(0);
    float weights = 0;
    for (int k = -8; k <= 8; ++k) {
        const int x = min(max(i % width + k * step_x, 0), width - 1);
        const int y = min(max(i / width + k * step_y, 0), height - 1);
        const float weight = std::exp(-float(k * k) / 16.0f);  // 0.02 at the last sample: no edge
        const float4 v = from[y * width + x];
        sum += weight * glm::vec3(v.x, v.y, v.z);
        weights += weight;
    }
    sum /= weights;
    to[i] = make_float4(sum.x, sum.y, sum.z, 0);
}

/// How a picture is exposed; the values of a Stage of chapter 07.
struct Film {
    float exposure = 1;
    float glare =
        0.05f;  ///< part of the light that the lens scatters over the picture; 0: no such kernels run
};

//! [film]
/// Film runs out of grains: each colour comes near 1 and never reaches it, red first, then green. So the deep
/// orange of a black body turns yellow where there is much of it, as on a photograph; and cream in its core,
/// since the filters over the three colours overlap, and each sees 3 % of the light as such.
__host__ __device__ inline glm::vec3 exposed(glm::vec3 light, float exposure) {
    light = glm::mix(light, glm::vec3(glm::dot(light, glm::vec3(0.2126f, 0.7152f, 0.0722f))), 0.03f);
    return glm::vec3(1.0f) - glm::exp(-exposure * light);
}
//! [film]

__host__ __device__ inline float srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// A fixed number in [-1/2, 1/2) for each pixel. Before rounding to 8 bits it keeps the dark free of bands.
__host__ __device__ inline float grain(int x, int y) {
    const float v = 0.06711056f * (float(x) + 0.5f) + 0.00583715f * (float(y) + 0.5f);
    const float w = 52.9829189f * (v - std::floor(v));
    return w - std::floor(w) - 0.5f;
}

/// One thread per pixel: 8-bit sRGB in a word, red lowest. `small` may be nullptr: no glare.
inline __global__ void film_kernel(std::uint32_t* pixels, const float4* light, const float4* small, Film film,
                                   int width, int height, int small_width, int small_height) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= width * height) return;
    const int x = i % width, y = i / width;
    glm::vec3 here(light[i].x, light[i].y, light[i].z);
    if (small) {
        // Bilinear between the centres of the small picture's pixels.
        const float u = fminf(fmaxf((float(x) + 0.5f) / kGlareShrink - 0.5f, 0.0f), float(small_width - 1));
        const float v = fminf(fmaxf((float(y) + 0.5f) / kGlareShrink - 0.5f, 0.0f), float(small_height - 1));
        const int x0 = int(u), y0 = int(v), x1 = min(x0 + 1, small_width - 1),
                  y1 = min(y0 + 1, small_height - 1);
        const auto at = [&](int a, int b) {
            const float4 s = small[b * small_width + a];
            return glm::vec3(s.x, s.y, s.z);
        };
        const glm::vec3 scattered = glm::mix(glm::mix(at(x0, y0), at(x1, y0), u - float(x0)),
                                             glm::mix(at(x0, y1), at(x1, y1), u - float(x0)), v - float(y0));
        here = glm::mix(here, scattered, film.glare);
    }
    const glm::vec3 tone = exposed(here, film.exposure);
    std::uint32_t word = 0;
    for (int c = 0; c < 3; ++c) {
        const float value = 255 * srgb(fminf(fmaxf(tone[c], 0.0f), 1.0f)) + grain(x, y) + 0.5f;
        word |= std::uint32_t(fminf(fmaxf(value, 0.0f), 255.0f)) << (8 * c);
    }
    pixels[i] = word;
}

/// Memory for pictures of one size.
class Darkroom {
  public:
    Darkroom(int width, int height, bool glare)
        : width_(width),
          height_(height),
          small_width_((width + kGlareShrink - 1) / kGlareShrink),
          small_height_((height + kGlareShrink - 1) / kGlareShrink),
          pixels_(std::size_t(width) * height) {
        if (!glare) return;
        a_ = course::DeviceBuffer<float4>(std::size_t(small_width_) * small_height_);
        b_ = course::DeviceBuffer<float4>(a_.size());
    }

    course::Image develop(const float4* light, Film film) {
        const bool glare = film.glare > 0 && a_.size() > 0;
        const unsigned blocks = blocks_for(pixels_.size()), small_blocks = blocks_for(a_.size());
        if (glare) {
            shrink_kernel<<<small_blocks, kThreads>>>(a_.data(), light, width_, height_, small_width_,
                                                      small_height_);
            // Wider each time: together they fall off like a lens's glare, bright near and faint far.
            for (const int step : {1, 2, 4}) {
                blur_kernel<<<small_blocks, kThreads>>>(b_.data(), a_.data(), small_width_, small_height_,
                                                        step, 0);
                blur_kernel<<<small_blocks, kThreads>>>(a_.data(), b_.data(), small_width_, small_height_, 0,
                                                        step);
            }
            CUDA_CHECK(cudaGetLastError());
        }
        film_kernel<<<blocks, kThreads>>>(pixels_.data(), light, glare ? a_.data() : nullptr, film, width_,
                                          height_, small_width_, small_height_);
        CUDA_CHECK(cudaGetLastError());
        course::Image image(width_, height_);
        const std::vector<std::uint32_t> words = pixels_.download();
        for (std::size_t i = 0; i < words.size(); ++i)
            for (int c = 0; c < 3; ++c) image.rgb[3 * i + c] = std::uint8_t(words[i] >> (8 * c));
        return image;
    }

  private:
    static constexpr unsigned kThreads = 128;
    static unsigned blocks_for(std::size_t n) { return unsigned((n + kThreads - 1) / kThreads); }
    int width_, height_, small_width_, small_height_;
    course::DeviceBuffer<std::uint32_t> pixels_;
    course::DeviceBuffer<float4> a_, b_;
};

}  // namespace volume
