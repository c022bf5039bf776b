/// @file
/// An OpenGL 3.3 core context: headless through EGL, or a window (gl_window.h).
#pragma once
#include <memory>
#include <string>

#include "common/errors.h"

namespace course {

/// No OpenGL context can be had here. The message says why and names the package that mends it.
struct NoOpenGl : BadInput {
    using BadInput::BadInput;
};

/// What the driver says about itself.
struct GlInfo {
    std::string version;   ///< e.g. "4.5 (Core Profile) Mesa 22.3.6"
    std::string renderer;  ///< e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string platform;  ///< how the context was made, e.g. "EGL device 0 of 1"
};

/// Owns a context that is current on the thread that made it. GL objects must be destroyed before it.
class GlContext {
  public:
    virtual ~GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;
    const GlInfo& info() const { return info_; }

  protected:
    GlContext() = default;
    /// Loads the GL functions and reads what the driver says. Call it once the context is current.
    void load_functions(const std::string& platform);

  private:
    GlInfo info_;
};

/// A context with no window and no display server: the first EGL device that gives OpenGL 3.3 core, else
/// Mesa's surfaceless platform. It draws into framebuffer objects (gl_target.h). Have one at a time.
/// @throws NoOpenGl
std::unique_ptr<GlContext> make_headless_context();

}  // namespace course
