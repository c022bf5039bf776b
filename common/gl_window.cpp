#include "common/gl_window.h"

#ifdef COURSE_WITH_WINDOW
#include <GLFW/glfw3.h>
#endif

namespace course {

#ifdef COURSE_WITH_WINDOW
namespace {

std::string last_glfw_error() {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return reason ? reason : "no reason given";
}

class GlfwWindow : public Window {
  public:
    GlfwWindow(int width_px, int height_px, const std::string& title) {
        if (!glfwInit())
            throw NoOpenGl("--window needs a display and there is none (" + last_glfw_error() +
                           "); without --window the pictures are written to files");
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);  // macOS gives a core context only with it
        glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
        window_ = glfwCreateWindow(width_px, height_px, title.c_str(), nullptr, nullptr);
        if (!window_) {
            const std::string reason = last_glfw_error();
            glfwTerminate();
            throw NoOpenGl("no window with OpenGL 3.3: " + reason +
                           " (Debian: libgl1-mesa-dri, or the GPU's own driver)");
        }
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(1);  // one picture a screen refresh
        load_functions("GLFW window");
        glfwSetWindowUserPointer(window_, this);
        glfwSetKeyCallback(window_, on_key);
        glfwSetCursorPosCallback(window_, on_move);
        glfwSetScrollCallback(window_, on_scroll);
    }
    ~GlfwWindow() override {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }

    bool closed() const override { return glfwWindowShouldClose(window_); }

    WindowEvents poll() override {
        events_ = {};
        glfwPollEvents();
        return events_;
    }

    void copy(const Framebuffer& picture) override {
        int width = 0, height = 0;  // more than was asked for on a high-density screen
        glfwGetFramebufferSize(window_, &width, &height);
        glDisable(GL_FRAMEBUFFER_SRGB);  // the picture's bytes are sRGB already
        glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.id());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                          GL_LINEAR);
    }
    void swap() override { glfwSwapBuffers(window_); }

    Image read() const override {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_, &width, &height);
        return read_pixels(0, width, height);
    }

    void set_title(const std::string& title) override { glfwSetWindowTitle(window_, title.c_str()); }
    void* glfw_window() override { return window_; }

  private:
    static GlfwWindow& self(GLFWwindow* window) {
        return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
    }
    static void on_key(GLFWwindow* window, int key, int, int action, int) {
        WindowEvents& events = self(window).events_;
        const bool pressed = action == GLFW_PRESS;
        if (key == GLFW_KEY_ESCAPE && pressed) glfwSetWindowShouldClose(window, GLFW_TRUE);
        if (key == GLFW_KEY_SPACE && pressed) events.pause = !events.pause;
        if ((key == GLFW_KEY_S || key == GLFW_KEY_RIGHT) && action != GLFW_RELEASE) events.step = true;
        if (key == GLFW_KEY_R && pressed) events.reset = true;
        if (key == GLFW_KEY_P && pressed) events.screenshot = true;
        if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9 && pressed) events.digit = key - GLFW_KEY_0;
    }
    static void on_move(GLFWwindow* window, double x, double y) {
        GlfwWindow& w = self(window);
        const double dx = x - w.cursor_x_, dy = y - w.cursor_y_;
        w.cursor_x_ = x;
        w.cursor_y_ = y;
        if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
            w.events_.drag_x_px += dx;
            w.events_.drag_y_px += dy;
        } else if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS) {
            w.events_.pan_x_px += dx;
            w.events_.pan_y_px += dy;
        }
    }
    static void on_scroll(GLFWwindow* window, double, double clicks) {
        self(window).events_.scroll += clicks;
    }

    GLFWwindow* window_ = nullptr;
    WindowEvents events_;
    double cursor_x_ = 0, cursor_y_ = 0;
};

}  // namespace

std::unique_ptr<Window> make_window(int width_px, int height_px, const std::string& title) {
    return std::make_unique<GlfwWindow>(width_px, height_px, title);
}

#else

std::unique_ptr<Window> make_window(int, int, const std::string&) {
    throw NoOpenGl(
        "--window: this build has no windows, since GLFW was missing or COURSE_WINDOW is OFF (Debian: "
        "install "
        "libglfw3-dev, then configure again); without --window the pictures are written to files");
}

#endif

}  // namespace course
