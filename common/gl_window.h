/// @file
/// A window with an OpenGL 3.3 core context. What it shows was drawn off screen and is copied into it, so
/// that window and headless pictures have the same pixels.
#pragma once
#include <memory>
#include <string>

#include "common/camera.h"
#include "common/gl_context.h"
#include "common/gl_target.h"

namespace course {

/// What the user did since the last poll. Keys count once a press.
struct WindowEvents {
    double drag_x_px = 0, drag_y_px = 0;  ///< mouse moved with the left button held
    double pan_x_px = 0, pan_y_px = 0;    ///< mouse moved with the right button held
    double scroll = 0;                    ///< wheel clicks, up is positive
    bool pause = false;                   ///< space
    bool step = false;                    ///< S or right arrow
    bool reset = false;                   ///< R
    bool screenshot = false;              ///< P
    int digit = 0;                        ///< 1 to 9: that key; 0: none of them
};

/// A window of fixed size.
class Window : public GlContext {
  public:
    virtual bool closed() const = 0;  ///< closed by the user (or by Esc)
    virtual WindowEvents poll() = 0;
    /// Copies a picture to the window, where it is seen after swap().
    virtual void copy(const Framebuffer& picture) = 0;
    virtual void swap() = 0;
    /// What copy() left in the window, as an image; call it before swap().
    virtual Image read() const = 0;
    virtual void set_title(const std::string& title) = 0;
    virtual void* glfw_window() = 0;  ///< for what draws over the picture (gl_gui.h)
    void show(const Framebuffer& picture) {
        copy(picture);
        swap();
    }
};

/// Moves the camera as the mouse did.
inline void steer(OrbitCamera& orbit, const WindowEvents& events, int height_px) {
    constexpr float kTurn = 0.006f;  // radians a pixel: half a turn takes about 500 pixels
    orbit.orbit(-kTurn * float(events.drag_x_px), kTurn * float(events.drag_y_px));
    orbit.pan(-float(events.pan_x_px) / float(height_px), float(events.pan_y_px) / float(height_px));
    orbit.zoom(float(events.scroll));
}

/// @throws NoOpenGl when there is no display, or when this build has no windows (GLFW was missing).
std::unique_ptr<Window> make_window(int width_px, int height_px, const std::string& title);

}  // namespace course
