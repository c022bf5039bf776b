/// @file
/// OpenGL objects that delete themselves, and a count of them, by which tests prove that a scene makes no
/// object it does not need and leaves none behind.
#pragma once
#include <GL/glew.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/errors.h"

namespace course {

enum class GlKind { buffer, vertex_array, texture, framebuffer, program };
constexpr int kGlKinds = 5;

/// How many GL objects of one kind exist now, and how many were ever made.
struct GlCount {
    int live = 0, made = 0;
};
inline GlCount& gl_count(GlKind kind) {
    static GlCount counts[kGlKinds];
    return counts[int(kind)];
}
/// The same for all kinds together.
inline GlCount gl_count() {
    GlCount all;
    for (int k = 0; k < kGlKinds; ++k) {
        all.live += gl_count(GlKind(k)).live;
        all.made += gl_count(GlKind(k)).made;
    }
    return all;
}

/// Owns one GL name. Move-only; needs a current context when made and when destroyed.
template <GlKind kind>
class GlObject {
  public:
    GlObject() {
        if constexpr (kind == GlKind::buffer) glGenBuffers(1, &id_);
        if constexpr (kind == GlKind::vertex_array) glGenVertexArrays(1, &id_);
        if constexpr (kind == GlKind::texture) glGenTextures(1, &id_);
        if constexpr (kind == GlKind::framebuffer) glGenFramebuffers(1, &id_);
        if constexpr (kind == GlKind::program) id_ = glCreateProgram();
        ++gl_count(kind).live;
        ++gl_count(kind).made;
    }
    GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~GlObject() {
        if (id_ == 0) return;
        if constexpr (kind == GlKind::buffer) glDeleteBuffers(1, &id_);
        if constexpr (kind == GlKind::vertex_array) glDeleteVertexArrays(1, &id_);
        if constexpr (kind == GlKind::texture) glDeleteTextures(1, &id_);
        if constexpr (kind == GlKind::framebuffer) glDeleteFramebuffers(1, &id_);
        if constexpr (kind == GlKind::program) glDeleteProgram(id_);
        --gl_count(kind).live;
    }
    GLuint id() const { return id_; }

  private:
    GLuint id_ = 0;
};

using VertexArray = GlObject<GlKind::vertex_array>;

/// A buffer object of fixed size, contents undefined until written.
class GlBuffer : public GlObject<GlKind::buffer> {
  public:
    /// @throws BadInput when OpenGL has not that much memory, naming the bytes asked for.
    explicit GlBuffer(std::size_t bytes) : bytes_(bytes) {
        glBindBuffer(GL_ARRAY_BUFFER, id());
        glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(bytes), nullptr, GL_DYNAMIC_DRAW);
        if (glGetError() == GL_OUT_OF_MEMORY)
            throw BadInput("OpenGL has not the " + std::to_string(bytes) +
                           " bytes for a buffer: ask for fewer particles");
    }
    std::size_t bytes() const { return bytes_; }

  private:
    std::size_t bytes_;
};

/// Throws if OpenGL has recorded an error since the last call. `doing` completes "OpenGL error while ...".
inline void check_gl(const std::string& doing) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    const char* name = error == GL_INVALID_ENUM                    ? "invalid enum"
                       : error == GL_INVALID_VALUE                 ? "invalid value"
                       : error == GL_INVALID_OPERATION             ? "invalid operation"
                       : error == GL_INVALID_FRAMEBUFFER_OPERATION ? "invalid framebuffer operation"
                       : error == GL_OUT_OF_MEMORY                 ? "out of memory"
                                                                   : "unknown error";
    while (glGetError() != GL_NO_ERROR) {
    }  // the next check is to report what comes after this one
    throw std::runtime_error("OpenGL error while " + doing + ": " + name);
}

}  // namespace course
