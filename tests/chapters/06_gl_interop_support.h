// Helpers of chapter 06's tests: a context or a skip, pictures and depths as arrays, programs run from
// outside.
#pragma once
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "06_gl_interop/particle_renderer.h"
#include "06_gl_interop/sphere_ray.h"
#include "common/gl_context.h"
#include "tests/support/course_test.h"

namespace gl_test {

/// A headless context, or the case is skipped.
inline std::unique_ptr<course::GlContext> context_or_skip() {
    try {
        return course::make_headless_context();
    } catch (const course::NoOpenGl& reason) {
        course::skip(reason.what());
    }
}

inline course::GlBuffer buffer_of(const std::vector<glm::vec4>& values) {
    course::GlBuffer buffer(values.size() * sizeof(glm::vec4));
    glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(buffer.bytes()), values.data());
    return buffer;
}

/// A sphere scene with nothing but spheres: one sample a pixel, no shadows, no occlusion.
inline interop::Look bare_spheres() {
    interop::Look look;
    look.samples_per_axis = 1;
    look.shadows = false;
    look.occlusion_radii = 0;
    look.region = {{-1, -1, -1}, {1, 1, 1}};
    return look;
}

/// What the surface pass stored, row 0 at the bottom.
struct Surface {
    int width, height;
    std::vector<float> depth;             // as OpenGL stores it; 1: nothing there
    std::vector<glm::vec4> normal_speed;  // camera coordinates, m/s

    explicit Surface(const course::Framebuffer& framebuffer)
        : width(framebuffer.width()),
          height(framebuffer.height()),
          depth(std::size_t(width) * height),
          normal_speed(depth.size()) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
        glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
        glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, normal_speed.data());
        course::check_gl("reading the surface");
    }
    bool covered(int x, int y) const { return depth[std::size_t(y) * width + x] < 1; }
};

/// How a program ended, and all it printed.
struct Ended {
    int exit_code = -1;
    std::string output;
};
inline Ended run(const std::string& command) {
    Ended ended;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    REQUIRE(pipe);
    std::array<char, 4096> part;
    while (std::size_t got = fread(part.data(), 1, part.size(), pipe)) ended.output.append(part.data(), got);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
    return ended;
}

/// "cd somewhere and run this program of the course there", as a learner would.
inline std::string program(const std::string& name) {
    return std::string(COURSE_BIN_DIR) + "/" + name;
}

/// An empty folder that goes with its owner.
struct TemporaryFolder {
    std::filesystem::path path;
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "course_06_XXXXXX").string();
        REQUIRE(mkdtemp(pattern.data()));
        path = pattern;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

}  // namespace gl_test
