/// @file
/// A picture of droplets with no graphics library: every droplet adds a small Gaussian spot of light to a
/// canvas, and at the end the light becomes a photograph.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "01_particle_loop/particle_loop.h"
#include "common/image.h"

namespace particle_loop {

/// A pinhole camera that looks at a point; y is up.
struct Camera {
    glm::vec3 eye_m{0.0f, 2.4f, 9.0f};
    glm::vec3 target_m{0.0f, 1.3f, 0.0f};
    float view_height_m = 4.8f;  ///< what fits into the picture at the target's distance
    float shutter_s = 0.010f;    ///< exposure time: a droplet is drawn as the streak it flies meanwhile
};

/// Light per pixel, linear (twice the number is twice the light), red, green, blue.
class Canvas {
  public:
    Canvas(int width_px, int height_px, const Camera& camera)
        : width_(width_px),
          height_(height_px),
          light_(std::size_t(width_px) * height_px, glm::vec3(0.0f)),
          eye_(camera.eye_m),
          forward_(glm::normalize(camera.target_m - camera.eye_m)),
          right_(glm::normalize(glm::cross(forward_, glm::vec3(0, 1, 0)))),
          up_(glm::cross(right_, forward_)),
          focal_px_(height_px * glm::length(camera.target_m - camera.eye_m) / camera.view_height_m) {}

    int width() const { return width_; }
    int height() const { return height_; }
    glm::vec3& at(int x, int y) { return light_[std::size_t(y) * width_ + x]; }

    /// Direction in which pixel (x, y) looks, and where the camera stands.
    glm::vec3 ray(float x, float y) const {
        return glm::normalize(focal_px_ * forward_ + (x - 0.5f * width_) * right_ -
                              (y - 0.5f * height_) * up_);
    }
    glm::vec3 eye() const { return eye_; }

    //! [spot]
    /// Adds a Gaussian spot of light. Near droplets are larger; one smaller than a pixel is drawn a pixel
    /// large and dimmer by as much, so that it gives the same light wherever it lies between the pixels.
    void spot(glm::vec3 position_m, float radius_m, glm::vec3 light) {
        const glm::vec3 d = position_m - eye_;
        const float depth_m = glm::dot(d, forward_);
        if (!(depth_m > 0.1f)) return;  // behind the camera, or not a number
        const float x = 0.5f * width_ + focal_px_ * glm::dot(d, right_) / depth_m;
        const float y = 0.5f * height_ - focal_px_ * glm::dot(d, up_) / depth_m;
        const float true_px = focal_px_ * radius_m / depth_m;
        const float drawn_px = std::max(true_px, 0.7f);
        const float reach = 2.5f * drawn_px;  // beyond, the spot has less than 5 % of its brightness
        if (!(x > -reach && x < width_ + reach && y > -reach && y < height_ + reach)) return;
        const glm::vec3 peak = light * (true_px * true_px) / (drawn_px * drawn_px);
        const int x0 = std::max(0, int(x - reach)), x1 = std::min(width_ - 1, int(x + reach));
        const int y0 = std::max(0, int(y - reach)), y1 = std::min(height_ - 1, int(y + reach));
        for (int py = y0; py <= y1; ++py)
            for (int px = x0; px <= x1; ++px) {
                const float dx = px + 0.5f - x, dy = py + 0.5f - y;
                at(px, py) += peak * std::exp(-0.5f * (dx * dx + dy * dy) / (drawn_px * drawn_px));
            }
    }
    //! [spot]

    //! [develop]
    /// Light to picture: 1 - exp(-light) lets bright places saturate softly, then sRGB encoding.
    course::Image develop() const {
        course::Image image(width_, height_);
        for (std::size_t k = 0; k < light_.size(); ++k)
            for (int c = 0; c < 3; ++c)
                image.rgb[3 * k + c] = course::to_srgb(1.0f - std::exp(-light_[k][c]));
        return image;
    }
    //! [develop]

  private:
    int width_, height_;
    std::vector<glm::vec3> light_;
    glm::vec3 eye_, forward_, right_, up_;
    float focal_px_;
};

/// Night sky and wet ground, lit by the lamps around the nozzle.
inline void draw_surroundings(Canvas& canvas) {
    for (int y = 0; y < canvas.height(); ++y)
        for (int x = 0; x < canvas.width(); ++x) {
            const glm::vec3 ray = canvas.ray(x + 0.5f, y + 0.5f);
            glm::vec3& light = canvas.at(x, y);
            if (ray.y >= 0.0f) {
                light += glm::mix(glm::vec3(0.007f, 0.011f, 0.022f), glm::vec3(0.002f, 0.003f, 0.009f),
                                  std::min(1.0f, 4.0f * ray.y));
                continue;
            }
            const glm::vec3 ground = canvas.eye() - ray * (canvas.eye().y / ray.y);
            const float r2 = ground.x * ground.x + ground.z * ground.z;
            light += glm::vec3(0.006f, 0.009f, 0.018f) + glm::vec3(0.03f, 0.075f, 0.12f) / (1.0f + 0.3f * r2);
        }
}

/// The first `count` droplets as streaks, and their mirror images in the wet ground.
inline void draw_droplets(Canvas& canvas, const std::vector<Particle>& particles, std::uint32_t count,
                          const Camera& camera) {
    constexpr int kSpotsPerStreak = 6;
    constexpr float kRadius_m = 0.0055f;
    // However many droplets there are, the picture gets the same light; a few alone are not made suns.
    const float brightness = std::min(3.0f, 19000.0f / float(particles.size())) / kSpotsPerStreak;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Particle& p = particles[i];
        // Lit from below: warm near the lamps, blue far above them.
        const float from_lamp_m = glm::length(p.position_m - glm::vec3(0.0f, 0.2f, 0.0f));
        const float t = std::min(1.0f, from_lamp_m / 2.3f);
        const glm::vec3 light =
            brightness * glm::mix(glm::vec3(1.7f, 1.25f, 0.75f), glm::vec3(0.12f, 0.42f, 0.95f), t);
        for (int k = 0; k < kSpotsPerStreak; ++k) {
            glm::vec3 where = p.position_m - p.velocity_m_per_s * (camera.shutter_s * k / kSpotsPerStreak);
            canvas.spot(where, kRadius_m, light);
            where.y = -where.y;
            canvas.spot(where, kRadius_m, 0.25f * light);
        }
    }
}

/// The whole picture.
inline course::Image picture(const std::vector<Particle>& particles, std::uint32_t count, int width_px,
                             int height_px, const Camera& camera = {}) {
    Canvas canvas(width_px, height_px, camera);
    draw_surroundings(canvas);
    draw_droplets(canvas, particles, count, camera);
    return canvas.develop();
}

}  // namespace particle_loop
