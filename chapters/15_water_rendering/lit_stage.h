/// @file
/// What the shaders of this chapter know of the scene: sky, sun, tank, ball, water.
#pragma once
#include "15_water_rendering/look.h"
#include "15_water_rendering/passes.h"

namespace water {

/// Texture units, one for each thing that shaders look up.
enum Unit { kSkyUnit, kSunshineUnit, kFieldUnit, kFreeUnit, kFirstUnit, kThicknessUnit, kInputUnit };

/// The sky, drawn once, and everything that shaders are told about a scene.
class LitStage {
  public:
    LitStage(const Light& light, const WholePicture& whole)
        : light_(light), sky_(kSkyWidth, kSkyWidth / 2, GL_RGBA16F, Framebuffer::Depth::none) {
        read_smoothly(sky_.colour(), GL_REPEAT);  // round the compass
        const ShaderProgram paint({"fullscreen.vert", "water_sky.frag"});
        sky_.bind();
        paint.use();
        paint.set("picture_px", glm::vec2(sky_.width(), sky_.height()));
        paint.set("to_sun", light.to_sun);
        whole.draw();
    }

    /// For water_stage.frag and water_tank.frag, and what is the same for all rays in water.
    void set(const ShaderProgram& p, const Stage& stage, const Look& look) const {
        sky_.colour().bind(kSkyUnit);
        p.set("sky_map", int(kSkyUnit));
        p.set("sunshine_map", int(kSunshineUnit));
        p.set("caustics", 0);  // until a Sunshine says otherwise
        p.set("to_sun", light_.to_sun);
        p.set("sun_light", light_.sun);
        p.set("sky_light", light_.sky);
        p.set("tank_low_m", stage.tank_low_m);
        p.set("tank_high_m", stage.tank_high_m);
        p.set("ball_m", glm::vec4(stage.ball.middle_m, stage.ball.radius_m));
        p.set("absorption_per_m", light_.absorption_per_m);
        p.set("scattering_per_m", light_.scattering_per_m);
        p.set("scattered", light_.scattered);
        p.set("use_schlick", int(look.schlick));
    }
    const Light& light() const { return light_; }

  private:
    static constexpr int kSkyWidth = 1024;
    Light light_;
    Framebuffer sky_;
};

/// Particles keep half a spacing off the glass, and a surface half a spacing off the particles' middles. What
/// is nearer to a wall than this is taken to reach it.
inline float wall_gap_m(float spacing_m) {
    return 1.2f * spacing_m;
}

}  // namespace water
