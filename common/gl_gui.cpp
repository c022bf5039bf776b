#include "common/gl_gui.h"

#ifdef COURSE_WITH_GUI
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#endif

namespace course {

#ifdef COURSE_WITH_GUI

bool gui_available() {
    return true;
}

Gui::Gui(Window& window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // no file that remembers where panels were
    ImGui_ImplGlfw_InitForOpenGL(static_cast<GLFWwindow*>(window.glfw_window()), true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::begin(WindowEvents& events) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (ImGui::GetIO().WantCaptureMouse)
        events.drag_x_px = events.drag_y_px = events.pan_x_px = events.pan_y_px = events.scroll = 0;
}

void Gui::end() {
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

#else

bool gui_available() {
    return false;
}
Gui::Gui(Window&) {}
Gui::~Gui() = default;
void Gui::begin(WindowEvents&) {}
void Gui::end() {}

#endif

}  // namespace course
