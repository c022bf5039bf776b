/// @file
/// Draws a fire from OpenGL buffers: sprites into a floating-point picture, a lens's glare, film, sRGB.
///
/// For each picture:
/// \code
/// renderer.begin(camera, lights);                // the dark stage, lit by the fire
/// renderer.draw({&position, &velocity, 0, n}, look);  // once for each kind of particle; any number of times
/// renderer.finish();                             // film: picture() and image() are ready
/// \endcode
/// Particles come as two buffers of float4, as flame.cuh keeps them: position xyz in metres and the age in
/// seconds (below 0: not born, not drawn); velocity xyz in m/s and the life in seconds.
#pragma once
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "07_fire_particles/blackbody.h"
#include "07_fire_particles/fire_look.h"
#include "07_fire_particles/wisp_texture.h"
#include "common/camera.h"
#include "common/gl_target.h"
#include "common/shader.h"

namespace fire {

/// Particles first ... first + count - 1 of two OpenGL buffers (none of them mapped).
struct SpriteRange {
    const course::GlBuffer* position = nullptr;  ///< float4: xyz (m), age (s)
    const course::GlBuffer* velocity = nullptr;  ///< float4: xyz (m/s), life (s)
    std::size_t first = 0, count = 0;
    /// One float each that multiplies a sprite's light (additive) or opacity (alpha); nullptr: 1 for all.
    const course::GlBuffer* gain = nullptr;
};

/// Owns the shaders, textures and framebuffers for one stage at one picture size. Needs a current context.
class FireRenderer {
  public:
    /// @throws course::BadInput if a shader does not compile or the picture is too large for the driver
    FireRenderer(int width_px, int height_px, const Stage& stage);

    /// Starts a picture: the stage as the fire's light shows it. At most kMaxLights lights.
    void begin(const course::Camera& camera, const std::vector<FireLight>& lights);
    /// Adds sprites on top of what has been drawn since begin(): alpha-blended ones have to come sorted, from
    /// back to front. @throws std::logic_error if a buffer is too small or mapped
    void draw(const SpriteRange& sprites, const SpriteLook& look);
    /// Exposes the film.
    void finish();

    /// What finish() left: sRGB colours.
    const course::Framebuffer& picture() const { return picture_; }
    course::Image image() const { return course::read_image(picture_); }
    /// The sprites alone in linear light, RGBA with the colours premultiplied, bottom row first.
    std::vector<glm::vec4> light() const;

    Stage stage;  ///< exposure, glare and sky may change between pictures

  private:
    using Program = course::ShaderProgram;
    void set_camera(const Program& program) const;
    void set_lights(const Program& program) const;
    void bind_input(GLuint input, int floats, const course::GlBuffer& buffer, std::size_t first,
                    std::size_t count);
    void draw_whole_picture(const course::Framebuffer& target);
    void blur(const course::Framebuffer& from, const course::Framebuffer& to, glm::vec2 step);

    glm::mat4 view_{1}, projection_{1};
    std::vector<FireLight> lights_;
    course::VertexArray particles_, no_vertices_;
    course::Framebuffer scenery_;  ///< what is solid: light and depth
    course::Framebuffer light_;    ///< sprites, in 32-bit floats: see the README on why not 16
    course::Framebuffer picture_;
    std::optional<std::array<course::Framebuffer, 2>> glare_;
    course::Texture ramp_, wisps_;
    Program scenery_program_, sprites_, film_;
    std::optional<Program> blur_;
};

// ------------------------------------------------------------------------------------------------- making

constexpr int kRampSize = 256;
constexpr int kGlareShrink = 4;  // the glare is smooth: a quarter of the pixels on each axis shows all of it

//! [make]
inline FireRenderer::FireRenderer(int width_px, int height_px, const Stage& stage_)
    : stage(stage_),
      scenery_(width_px, height_px, GL_RGBA16F, course::Framebuffer::Depth::float32),
      light_(width_px, height_px, GL_RGBA32F, course::Framebuffer::Depth::none),
      picture_(width_px, height_px, GL_SRGB8_ALPHA8, course::Framebuffer::Depth::none),
      ramp_(kRampSize, 1, GL_RGBA32F),
      wisps_(kWispTexels, kWispTexels, GL_RGBA32F),
      scenery_program_({"fullscreen.vert", "fire_stage.frag", "fire_noise.frag"}),
      sprites_({"fire_sprite.vert", "fire_sprite.frag"}),
      film_({"fullscreen.vert", "fire_film.frag"}) {
    if (stage.rods.size() > kMaxRods) throw std::logic_error("a stage has at most 10 rods");
    const auto fill = [](const course::Texture& texture, int width, int height,
                         const std::vector<glm::vec4>& texels) {
        texture.bind(0);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    };
    fill(ramp_, kRampSize, 1, blackbody_ramp_table(kRampSize));
    fill(wisps_, kWispTexels, kWispTexels, wisp_texture());
    if (stage.glare > 0) {
        const auto small = [&] {
            return course::Framebuffer(std::max(1, width_px / kGlareShrink),
                                       std::max(1, height_px / kGlareShrink), GL_RGBA16F,
                                       course::Framebuffer::Depth::none);
        };
        glare_.emplace(std::array<course::Framebuffer, 2>{small(), small()});
        for (const course::Framebuffer& part : *glare_) {
            part.colour().bind(0);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        }
        blur_.emplace(std::vector<std::string>{"fullscreen.vert", "fire_blur.frag"});
    }
    course::check_gl("making the fire's renderer");
}
//! [make]

// ------------------------------------------------------------------------------------------------ drawing

inline void FireRenderer::begin(const course::Camera& camera, const std::vector<FireLight>& lights) {
    if (lights.size() > kMaxLights) throw std::logic_error("a fire has at most 4 lights");
    view_ = camera.view();
    projection_ = camera.projection(float(picture_.width()) / float(picture_.height()));
    lights_ = lights;
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_BLEND);

    const Program& p = scenery_program_;
    p.use();
    set_camera(p);
    set_lights(p);
    p.set("ground", stage.ground ? 1 : 0);
    p.set("ground_colour", stage.ground_colour);
    p.set("ground_grain_m", stage.ground_grain_m);
    p.set("sky_low", stage.sky_low);
    p.set("sky_high", stage.sky_high);
    p.set("rod_count", int(stage.rods.size()));
    for (std::size_t k = 0; k < stage.rods.size(); ++k) {
        const Rod& rod = stage.rods[k];
        const std::string index = "[" + std::to_string(k) + "]";
        p.set(("rod_from" + index).c_str(), glm::vec4(rod.from_m, rod.radius_m));
        p.set(("rod_to" + index).c_str(), glm::vec4(rod.to_m, rod.embers));
        p.set(("rod_material" + index).c_str(), int(rod.material));
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);  // every pixel writes its depth
    draw_whole_picture(scenery_);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);

    light_.bind();
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    course::check_gl("drawing the stage");
}

//! [draw]
inline void FireRenderer::draw(const SpriteRange& sprites, const SpriteLook& look) {
    if (sprites.count == 0) return;
    glBindVertexArray(particles_.id());
    bind_input(0, 4, *sprites.position, sprites.first, sprites.count);
    bind_input(1, 4, *sprites.velocity, sprites.first, sprites.count);
    if (sprites.gain) {
        bind_input(2, 1, *sprites.gain, sprites.first, sprites.count);
    } else {
        glDisableVertexAttribArray(2);
        glVertexAttrib1f(2, 1);  // one value for all
    }
    const bool additive = look.blend == Blend::additive;
    const Program& p = sprites_;
    p.use();
    set_camera(p);
    set_lights(p);
    p.set("sky_high", stage.sky_high);
    p.set("radius_m", glm::vec2(look.radius_start_m, look.radius_end_m));
    p.set("temperature_K", glm::vec2(look.temperature_start_K, look.temperature_end_K));
    p.set("ramp_K", glm::vec2(kRampLow_K, kRampHigh_K));
    p.set("fade", glm::vec2(look.fade_in, look.fade_out));
    p.set("stretch_s", look.stretch_s);
    p.set("light", look.light);
    p.set("colour", look.colour);
    p.set("opacity", look.opacity);
    p.set("additive", additive ? 1 : 0);
    p.set("wisps", look.wisps);
    p.set("softness_m", look.softness_m);
    p.set("ramp", 0);
    p.set("wisp_map", 1);
    p.set("solid_depth", 2);
    ramp_.bind(0);
    wisps_.bind(1);
    scenery_.depth().bind(2);

    light_.bind();
    glEnable(GL_BLEND);
    // Premultiplied colours: what is there, dimmed by the sprite's alpha, plus its light. Alpha 0 only adds.
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, GLsizei(sprites.count));
    glDisable(GL_BLEND);
    course::check_gl("drawing sprites");
}
//! [draw]

inline void FireRenderer::finish() {
    if (glare_) {
        const course::Framebuffer &a = (*glare_)[0], &b = (*glare_)[1];
        blur(light_, a, glm::vec2(0));  // shrink
        // Wider each time: together they fall off like a lens's glare, bright near and faint far.
        for (const float width : {1.0f, 2.0f, 4.0f}) {
            blur(a, b, glm::vec2(width / float(a.width()), 0));
            blur(b, a, glm::vec2(0, width / float(a.height())));
        }
    }
    film_.use();
    scenery_.colour().bind(0);
    light_.colour().bind(1);
    if (glare_) (*glare_)[0].colour().bind(2);
    scenery_.depth().bind(3);
    film_.set("scenery", 0);
    film_.set("fire", 1);
    film_.set("glare_map", 2);
    film_.set("solid_depth", 3);
    film_.set("glare", glare_ ? stage.glare : 0.0f);
    film_.set("exposure", stage.exposure);
    film_.set("picture_px", glm::vec2(picture_.width(), picture_.height()));
    glEnable(GL_FRAMEBUFFER_SRGB);  // the shader computes in linear light, the picture stores sRGB
    draw_whole_picture(picture_);
    glDisable(GL_FRAMEBUFFER_SRGB);
    course::check_gl("exposing the film");
}

inline std::vector<glm::vec4> FireRenderer::light() const {
    std::vector<glm::vec4> texels(std::size_t(light_.width()) * light_.height());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, light_.id());
    glReadPixels(0, 0, light_.width(), light_.height(), GL_RGBA, GL_FLOAT, texels.data());
    course::check_gl("reading the fire's light");
    return texels;
}

// -------------------------------------------------------------------------------------------------- parts

inline void FireRenderer::set_camera(const Program& program) const {
    program.set("view", view_);
    program.set("projection", projection_);
    program.set("camera_to_world", glm::inverse(view_));
    program.set("picture_px", glm::vec2(picture_.width(), picture_.height()));
}

inline void FireRenderer::set_lights(const Program& program) const {
    program.set("light_count", int(lights_.size()));
    for (std::size_t k = 0; k < lights_.size(); ++k) {
        const std::string index = "[" + std::to_string(k) + "]";
        program.set(("light_at" + index).c_str(), glm::vec4(lights_[k].position_m, lights_[k].size_m));
        program.set(("light_colour" + index).c_str(), lights_[k].intensity);
    }
}

/// Shader input number `input` is read from `buffer`, starting with particle `first`, one value an instance.
inline void FireRenderer::bind_input(GLuint input, int floats, const course::GlBuffer& buffer,
                                     std::size_t first, std::size_t count) {
    const std::size_t bytes = sizeof(float) * std::size_t(floats);
    if (bytes * (first + count) > buffer.bytes())
        throw std::logic_error("more sprites to draw than the buffers hold");
    glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
    GLint mapped = GL_FALSE;
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_MAPPED, &mapped);
    if (mapped) throw std::logic_error("a buffer to draw from is mapped: unmap it first");
    glVertexAttribPointer(input, floats, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<const void*>(bytes * first));
    glEnableVertexAttribArray(input);
    glVertexAttribDivisor(input, 1);
}

inline void FireRenderer::draw_whole_picture(const course::Framebuffer& target) {
    target.bind();
    glBindVertexArray(no_vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

inline void FireRenderer::blur(const course::Framebuffer& from, const course::Framebuffer& to,
                               glm::vec2 step) {
    blur_->use();
    from.colour().bind(0);
    blur_->set("source", 0);
    blur_->set("step_uv", step);
    blur_->set("target_px", glm::vec2(to.width(), to.height()));
    draw_whole_picture(to);
}

}  // namespace fire
