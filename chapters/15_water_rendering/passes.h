/// @file
/// What all passes share: a triangle over the whole picture, textures read between texels, and a clock.
#pragma once
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "common/camera.h"
#include "common/gl_target.h"
#include "common/shader.h"

namespace water {

using course::Framebuffer;
using course::ShaderProgram;

/// Milliseconds of each pass, in order. Off unless asked for: each measurement makes the GPU idle twice.
class PassClock {
  public:
    bool on = false;

    template <class Wait, class Work>
    void time(const char* pass, Wait&& wait, Work&& work) {
        if (!on) {
            work();
            return;
        }
        wait();
        const auto start = std::chrono::steady_clock::now();
        work();
        wait();
        add(pass, 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    void clear() { passes_.clear(); }
    const std::vector<std::pair<std::string, double>>& passes() const { return passes_; }
    double total_ms() const {
        double sum = 0;
        for (const auto& pass : passes_) sum += pass.second;
        return sum;
    }

  private:
    /// A pass that runs several times for one picture is one entry.
    void add(const std::string& pass, double milliseconds) {
        for (auto& [name, sum] : passes_)
            if (name == pass) {
                sum += milliseconds;
                return;
            }
        passes_.push_back({pass, milliseconds});
    }
    std::vector<std::pair<std::string, double>> passes_;
};

/// The texture is read between its texels: the mean of the nearest four by their distance.
inline void read_smoothly(const course::Texture& texture, GLint wrap_across = GL_CLAMP_TO_EDGE) {
    texture.bind(0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_across);
}

/// Runs a fragment shader for each pixel of the bound framebuffer.
class WholePicture {
  public:
    void draw() const {
        glDisable(GL_DEPTH_TEST);
        glBindVertexArray(no_vertices_.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    GLuint vertices() const { return no_vertices_.id(); }

  private:
    course::VertexArray no_vertices_;
};

/// Adds what is drawn to what is there, while it lives.
struct Adding {
    Adding() {
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
    }
    ~Adding() { glDisable(GL_BLEND); }
};

/// A camera and the picture it makes. `shift_px`: by parts of a pixel, so that each sample sees another
/// place.
struct Shot {
    course::Camera camera;
    int width_px, height_px;
    glm::vec2 shift_px{0};

    glm::mat4 view() const { return camera.view(); }
    glm::mat4 projection() const {
        glm::mat4 p = camera.projection(float(width_px) / float(height_px));
        p[2][0] += 2 * shift_px.x / float(width_px);
        p[2][1] += 2 * shift_px.y / float(height_px);
        return p;
    }
    void set(const ShaderProgram& program) const {
        program.set("view", view());
        program.set("projection", projection());
        program.set("camera_to_world", glm::inverse(view()));
        program.set("eye_m", camera.eye_m);
        program.set("near_m", camera.near_m);
        program.set("picture_px", glm::vec2(width_px, height_px));
        program.set("pixel_rad", camera.field_of_view_rad / float(height_px));
    }
};

}  // namespace water
