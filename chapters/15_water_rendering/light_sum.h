/// @file
/// Light of several samples a pixel, added up, and the picture made of it.
#pragma once
#include <cmath>

#include "15_water_rendering/passes.h"

namespace water {

/// Where in its pixel sample k looks: points that fill the square evenly, however many there are (Roberts' R2
/// sequence: multiples of 1/p and 1/p^2, p the root of p^3 = p + 1).
inline glm::vec2 sample_place(int k) {
    const auto part = [k](double step) { return float(std::fmod(0.5 + k * step, 1.0) - 0.5); };
    return {part(0.7548776662466927), part(0.5698402909980532)};
}

/// Linear light, and the film that turns it into a picture.
class LightSum {
  public:
    LightSum(int width_px, int height_px)
        : light_(width_px, height_px, GL_RGBA32F, Framebuffer::Depth::none),
          picture_(width_px, height_px, GL_SRGB8_ALPHA8, Framebuffer::Depth::none),
          film_({"fullscreen.vert", "water_film.frag"}) {}

    void clear() {
        light_.bind();
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
        samples_ = 0;
    }
    /// Adds what `program` draws, which is in use and knows its scene.
    void add(const WholePicture& whole) {
        light_.bind();
        const Adding adding;
        whole.draw();
        ++samples_;
    }
    void develop(float exposure, const WholePicture& whole) {
        picture_.bind();
        film_.use();
        light_.colour().bind(0);
        film_.set("light_sum", 0);
        film_.set("exposure", exposure / float(std::max(1, samples_)));
        glEnable(GL_FRAMEBUFFER_SRGB);
        whole.draw();
        glDisable(GL_FRAMEBUFFER_SRGB);
    }
    const Framebuffer& picture() const { return picture_; }

    /// Mean light of each pixel, three numbers each, bottom row first: what errors are measured in.
    std::vector<float> light() const {
        std::vector<float> rgb(std::size_t(3) * light_.width() * light_.height());
        glBindFramebuffer(GL_READ_FRAMEBUFFER, light_.id());
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, light_.width(), light_.height(), GL_RGB, GL_FLOAT, rgb.data());
        course::check_gl("reading light back");
        for (float& value : rgb) value /= float(std::max(1, samples_));
        return rgb;
    }

  private:
    Framebuffer light_, picture_;
    ShaderProgram film_;
    int samples_ = 0;
};

}  // namespace water
