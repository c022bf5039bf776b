/// @file
/// A few shapes and words on a course::Image: enough for the figures of this chapter and the next.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <string>

#include "common/image.h"
#include "common/letters.h"

/// Shapes, words and colours.
namespace patterns::drawing {

struct Colour {
    std::uint8_t r, g, b;
};

// Colours that people with any colour vision can tell apart: Okabe and Ito's palette, and greys.
constexpr Colour kOrange{230, 159, 0}, kSkyBlue{86, 180, 233}, kGreen{0, 158, 115}, kBlue{0, 114, 178},
    kVermilion{213, 94, 0}, kBlack{0, 0, 0}, kGrey{150, 150, 150}, kPale{222, 222, 222},
    kCream{253, 240, 210}, kPaper{252, 252, 250};

/// Draws with smooth edges: a pixel takes as much of the colour as its distance to the shape's edge says.
class Canvas {
  public:
    Canvas(int width, int height) : image_(width, height) { rectangle({0, 0}, {width, height}, kPaper); }

    void disc(glm::vec2 centre, float radius, Colour colour) {
        paint(centre - radius, centre + radius, colour,
              [=](glm::vec2 p) { return glm::length(p - centre) - radius; });
    }
    void ring(glm::vec2 centre, float radius, float width, Colour colour) {
        paint(centre - radius - width, centre + radius + width, colour,
              [=](glm::vec2 p) { return std::abs(glm::length(p - centre) - radius) - width / 2; });
    }
    void line(glm::vec2 from, glm::vec2 to, float width, Colour colour) {
        const glm::vec2 along = to - from;
        const float length_squared = std::max(glm::dot(along, along), 1e-6f);  // a point has no direction
        paint(glm::min(from, to) - width, glm::max(from, to) + width, colour, [=](glm::vec2 p) {
            const float t = glm::clamp(glm::dot(p - from, along) / length_squared, 0.0f, 1.0f);
            return glm::length(p - from - t * along) - width / 2;
        });
    }
    void rectangle(glm::vec2 low, glm::vec2 high, Colour colour) {
        paint(low, high, colour, [=](glm::vec2 p) {
            const glm::vec2 outside = glm::max(low - p, p - high);
            return std::max(outside.x, outside.y);
        });
    }
    /// One line of text, its top left corner at `at`; a capital is about 7 * scale pixels high.
    void text(glm::vec2 at, const std::string& words, Colour colour, float scale) {
        course::for_each_stroke(words, [&](glm::vec2 low, glm::vec2 high) {
            rectangle(at + scale * low, at + scale * high, colour);
        });
    }
    static float text_width(const std::string& words, float scale) { return scale * course::width_of(words); }
    const course::Image& image() const { return image_; }

  private:
    /// @param distance  of a point from the shape's edge in pixels, negative inside
    template <class Distance>
    void paint(glm::vec2 low, glm::vec2 high, Colour colour, Distance distance) {
        const int x0 = std::max(0, int(low.x) - 1), x1 = std::min(image_.width - 1, int(high.x) + 1);
        const int y0 = std::max(0, int(low.y) - 1), y1 = std::min(image_.height - 1, int(high.y) + 1);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const float covered = glm::clamp(0.5f - distance(glm::vec2(x, y) + 0.5f), 0.0f, 1.0f);
                const std::uint8_t ink[3] = {colour.r, colour.g, colour.b};
                std::uint8_t* pixel = image_.pixel(x, y);
                for (int c = 0; c < 3; ++c)
                    pixel[c] = std::uint8_t(pixel[c] + covered * (ink[c] - pixel[c]) + 0.5f);
            }
    }

    course::Image image_;
};

}  // namespace patterns::drawing
