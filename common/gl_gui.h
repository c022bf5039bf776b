/// @file
/// Switches, sliders and text over a window's picture, by Dear ImGui where it is installed.
#pragma once
#include <memory>

#include "common/gl_window.h"

namespace course {

/// Does this build have panels? Without Dear ImGui (Debian: libimgui-dev) windows work by keys alone.
bool gui_available();

/// A frame of panels, between begin() and end(): ImGui's own functions, as its manual says. Where there is no
/// ImGui both do nothing. Have one at a time; it goes before its window.
class Gui {
  public:
    explicit Gui(Window& window);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// After Window::poll(). Takes from `events` what the mouse did on a panel.
    void begin(WindowEvents& events);
    /// Draws the panels over what Window::copy() left. Then Window::swap() shows both.
    void end();
};

}  // namespace course
