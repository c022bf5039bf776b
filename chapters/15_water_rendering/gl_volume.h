/// @file
/// A field in space that shaders can read at any point.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>
#include <string>

#include "common/gl_objects.h"

namespace water {

/// A texture of one 32-bit number a texel, mixed between its eight neighbours where it is read.
/// @throws BadInput if OpenGL can't have one of that size
class VolumeTexture : public course::GlObject<course::GlKind::texture> {
  public:
    /// @param filter  GL_LINEAR, or GL_NEAREST: the nearest texel as it is
    explicit VolumeTexture(glm::ivec3 size, GLint filter = GL_LINEAR) : size_(size) {
        GLint largest = 0;
        glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
        if (std::max(size.x, std::max(size.y, size.z)) > largest)
            throw course::BadInput("OpenGL takes no field of " + std::to_string(size.x) + " x " +
                                   std::to_string(size.y) + " x " + std::to_string(size.z) +
                                   " nodes here: take a coarser one");
        glBindTexture(GL_TEXTURE_3D, id());
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, size.x, size.y, size.z, 0, GL_RED, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, filter);
        glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, filter);
        for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
            glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
    }
    /// All texels, x fastest, from a buffer object: no copy through the host.
    void read_from(const course::GlBuffer& buffer) {
        glBindTexture(GL_TEXTURE_3D, id());
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer.id());
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, size_.x, size_.y, size_.z, GL_RED, GL_FLOAT, nullptr);
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    }
    void bind(int unit) const {
        glActiveTexture(GL_TEXTURE0 + GLenum(unit));
        glBindTexture(GL_TEXTURE_3D, id());
    }
    glm::ivec3 size() const { return size_; }

  private:
    glm::ivec3 size_;
};

}  // namespace water
