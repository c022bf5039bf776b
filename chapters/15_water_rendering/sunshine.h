/// @file
/// Sunlight on the ground: one photon for each small patch, followed through the water to where it lands.
#pragma once
#include <optional>

#include "15_water_rendering/lit_stage.h"

namespace water {

/// A map of the ground: the part of the sun's light that arrives. 1 where no water is in the way.
class Sunshine {
  public:
    /// @param texels  along its longer side
    Sunshine(const Stage& stage, const Light& light, int texels)
        : trace_({"fullscreen.vert", "sunshine_trace.frag", "water_path.frag", "water_tank.frag",
                  "water_stage.frag", "water_optics.frag"}),
          splat_({"sunshine_splat.vert", "sunshine_splat.frag"}) {
        // Where the sun throws the shadow of the whole tank, and the ground under it.
        const glm::vec3 low = stage.tank_low_m, high = stage.tank_high_m;
        const glm::vec2 cast = -glm::vec2(light.to_sun.x, light.to_sun.z) / light.to_sun.y * (high.y - low.y);
        const glm::vec2 a(low.x, low.z), b(high.x, high.z);
        const float margin_m = 0.05f * glm::length(b - a);
        const glm::vec2 map_low = glm::min(a, a + cast) - margin_m,
                        map_high = glm::max(b, b + cast) + margin_m;
        rectangle_m_ = glm::vec4(map_low, map_high - map_low);
        const float texel_m = std::max(rectangle_m_.z, rectangle_m_.w) / float(texels);
        const glm::ivec2 size = glm::max(glm::ivec2(1), glm::ivec2((map_high - map_low) / texel_m));
        map_.emplace(size.x, size.y, GL_RGBA32F, Framebuffer::Depth::none);
        read_smoothly(map_->colour());
        const glm::ivec2 photons = size * kPhotonsPerTexel2 / 2;
        landings_.emplace(photons.x, photons.y, GL_RGBA32F, Framebuffer::Depth::none);
    }

    /// Follows all photons. @param set_scene  tells a program about stage and field
    template <class SetScene>
    void draw(const WholePicture& whole, const glm::vec3& absorption_per_m, SetScene&& set_scene) {
        landings_->bind();
        trace_.use();
        set_scene(trace_);
        trace_.set("sunshine_m", rectangle_m_);
        trace_.set("picture_px", glm::vec2(landings_->width(), landings_->height()));
        whole.draw();

        map_->bind();
        glClearColor(1, 1, 1, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        splat_.use();
        landings_->colour().bind(kInputUnit);
        splat_.set("landings", int(kInputUnit));
        splat_.set("sunshine_m", rectangle_m_);
        splat_.set("map_px", glm::vec2(map_->width(), map_->height()));
        splat_.set("absorption_per_m", absorption_per_m);
        glEnable(GL_PROGRAM_POINT_SIZE);
        const Adding adding;
        glDrawArrays(GL_POINTS, 0, 2 * landings_->width() * landings_->height());
    }
    /// For water_stage.frag.
    void set(const ShaderProgram& p) const {
        map_->colour().bind(kSunshineUnit);
        p.set("sunshine_m", rectangle_m_);
        p.set("caustics", 1);
    }
    const Framebuffer& map() const { return *map_; }
    const Framebuffer& landings() const { return *landings_; }
    glm::vec4 rectangle_m() const { return rectangle_m_; }

  private:
    static constexpr int kPhotonsPerTexel2 = 3;  // times 1/2: of photons along an axis, for each texel
    glm::vec4 rectangle_m_;
    std::optional<Framebuffer> map_, landings_;
    ShaderProgram trace_, splat_;
};

}  // namespace water
