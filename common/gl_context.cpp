#include "common/gl_context.h"

// GLEW comes before every other OpenGL header.
#include <GL/glew.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstring>
#include <vector>

namespace course {

void GlContext::load_functions(const std::string& platform) {
    glewExperimental = GL_TRUE;  // core profiles have no extension string, which old GLEWs look at
    const GLenum status = glewInit();
    // Debian's GLEW is built for GLX. Under EGL it loads every function, then finds no X display and says so.
    constexpr GLenum kNoGlxDisplay = 4;
    if (status != GLEW_OK && status != kNoGlxDisplay)
        throw NoOpenGl("OpenGL functions can't be loaded (GLEW: " +
                       std::string(reinterpret_cast<const char*>(glewGetErrorString(status))) + ")");
    glGetError();  // GLEW may leave an error behind that is not ours
    info_ = {reinterpret_cast<const char*>(glGetString(GL_VERSION)),
             reinterpret_cast<const char*>(glGetString(GL_RENDERER)), platform};
}

namespace {

template <class Function>
Function egl_function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool has_extension(EGLDisplay display, const char* name) {
    const char* all = eglQueryString(display, EGL_EXTENSIONS);
    return all && std::strstr(all, name);
}

struct Candidate {
    EGLDisplay display;
    std::string platform;
};

// Displays that need no X or Wayland server, the best first. EGL_DEFAULT_DISPLAY is not among them: with no
// server it fails, and with one it may be another machine's.
std::vector<Candidate> headless_displays() {
    const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    std::vector<Candidate> found;
    if (!get_display) return found;
    if (query_devices && has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        query_devices(16, devices, &count);
        for (EGLint k = 0; k < count; ++k)
            found.push_back({get_display(EGL_PLATFORM_DEVICE_EXT, devices[k], nullptr),
                             "EGL device " + std::to_string(k) + " of " + std::to_string(count)});
    }
    if (has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        found.push_back({get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                         "EGL surfaceless (Mesa)"});
    return found;
}

class HeadlessContext : public GlContext {
  public:
    // Throws NoOpenGl with the step that failed.
    explicit HeadlessContext(const Candidate& candidate) : display_(candidate.display) {
        const auto want = [&](bool good, const char* step) {
            if (good) return;
            eglTerminate(display_);
            throw NoOpenGl(candidate.platform + ": " + step);
        };
        if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr))
            throw NoOpenGl(candidate.platform + ": no display");
        want(eglBindAPI(EGL_OPENGL_API), "no desktop OpenGL");
        const EGLint config_wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                        EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config{};
        EGLint count = 0;
        want(eglChooseConfig(display_, config_wanted, &config, 1, &count) && count == 1, "no configuration");
        const EGLint context_wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                         3,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         3,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_NONE};
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, context_wanted);
        want(context_ != EGL_NO_CONTEXT, "no OpenGL 3.3 core context");
        want(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_), "context without surface");
        load_functions(candidate.platform);
    }
    ~HeadlessContext() override {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }

  private:
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> make_headless_context() {
    std::string reasons;
    for (const Candidate& candidate : headless_displays()) {
        try {
            return std::make_unique<HeadlessContext>(candidate);
        } catch (const NoOpenGl& reason) {
            reasons += (reasons.empty() ? "" : "; ") + std::string(reason.what());
        }
    }
    throw NoOpenGl("no OpenGL without a display: " +
                   (reasons.empty() ? "EGL offers neither devices nor a surfaceless platform" : reasons) +
                   " (Debian: install libgl1-mesa-dri and libegl1, or the NVIDIA driver's libnvidia-gl)");
}

}  // namespace course

// Sanitizer builds ask these functions how to go about their work.
extern "C" {
const char* __asan_default_options();
const char* __tsan_default_suppressions();

// Mesa keeps memory until the process ends, and the leak check hangs over naming it (gcc 12): programs with
// OpenGL go without. The simulator reports leaked device memory itself.
const char* __asan_default_options() {
    return "detect_leaks=0";
}
// Mesa's software renderer destroys mutexes that its threads have just left.
const char* __tsan_default_suppressions() {
    return "race:swrast_dri.so";
}
}
