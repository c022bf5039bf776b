/// @file
/// Where pictures are drawn: textures for colour and depth instead of a window.
#pragma once
#include <algorithm>
#include <optional>

#include "common/errors.h"
#include "common/gl_objects.h"
#include "common/image.h"

namespace course {

/// A texture of `width` x `height` texels without mipmaps, read at its nearest texel, clamped at its edges.
class Texture : public GlObject<GlKind::texture> {
  public:
    /// @param internal_format what is stored, e.g. GL_SRGB8_ALPHA8 or GL_DEPTH_COMPONENT32F
    Texture(int width, int height, GLint internal_format) {
        const bool depth = internal_format == GL_DEPTH_COMPONENT32F;
        glBindTexture(GL_TEXTURE_2D, id());
        glTexImage2D(GL_TEXTURE_2D, 0, internal_format, width, height, 0,
                     depth ? GL_DEPTH_COMPONENT : GL_RGBA, depth ? GL_FLOAT : GL_UNSIGNED_BYTE, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    void bind(int unit) const {
        glActiveTexture(GL_TEXTURE0 + GLenum(unit));
        glBindTexture(GL_TEXTURE_2D, id());
    }
};

/// A framebuffer with one texture for colour, one for depth, or both.
class Framebuffer : public GlObject<GlKind::framebuffer> {
  public:
    enum class Depth { none, float32 };

    /// @param colour_format e.g. GL_SRGB8_ALPHA8; 0 for depth alone
    /// @throws BadInput when the driver can't draw into it (a size beyond its limit, mostly)
    Framebuffer(int width, int height, GLint colour_format, Depth depth) : width_(width), height_(height) {
        const auto too_large = [&] {
            return BadInput("OpenGL can't draw a picture of " + std::to_string(width) + " x " +
                            std::to_string(height) + " pixels here");
        };
        GLint largest = 0;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
        if (width > largest || height > largest) throw too_large();
        glBindFramebuffer(GL_FRAMEBUFFER, id());
        if (colour_format) {
            colour_.emplace(width, height, colour_format);
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_->id(), 0);
        } else {
            glDrawBuffer(GL_NONE);
            glReadBuffer(GL_NONE);
        }
        if (depth == Depth::float32) {
            depth_.emplace(width, height, GL_DEPTH_COMPONENT32F);
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_->id(), 0);
        }
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw too_large();
    }

    /// Everything drawn from now on goes here, over its whole area.
    void bind() const {
        glBindFramebuffer(GL_FRAMEBUFFER, id());
        glViewport(0, 0, width_, height_);
    }
    int width() const { return width_; }
    int height() const { return height_; }
    const Texture& colour() const { return colour_.value(); }
    const Texture& depth() const { return depth_.value(); }

  private:
    int width_, height_;
    std::optional<Texture> colour_, depth_;
};

/// The colours of a framebuffer object (or of the window: 0) as an image. OpenGL's first row is the bottom
/// one, an image's the top one.
inline Image read_pixels(GLuint framebuffer, int width, int height) {
    Image image(width, height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    for (int y = 0; y < height / 2; ++y)
        std::swap_ranges(image.pixel(0, y), image.pixel(0, y) + 3 * width, image.pixel(0, height - 1 - y));
    check_gl("reading a picture back");
    return image;
}
inline Image read_image(const Framebuffer& framebuffer) {
    return read_pixels(framebuffer.id(), framebuffer.width(), framebuffer.height());
}

}  // namespace course
