/// @file
/// The vortex fire on screen: chapter 07's renderer, told by the vortons how bright each flame burns.
#pragma once
#include "07_fire_particles/fire_view.cuh"
#include "08_fire_vortex/vortex_scene.cuh"

namespace vortex {

/// A vortex fire whose particles lie in OpenGL's memory.
class SharedVortexFire {
  public:
    explicit SharedVortexFire(const VortexScene& scene)
        : scene_(scene), flames_(scene.fire), vortons_(scene.fire.fire, scene.model) {}

    void step() {
        vortons_.step(flames_.map(), scene_.fire.dt_s);
        flames_.unmap();
    }
    void check_state() {
        const fire::FlameArrays flames = flames_.map();
        vortons_.check_state(flames, scene_.fire.dt_s);
        flames_.unmap();
    }
    void reset() {
        flames_.reset();
        vortons_ = VortexFire(scene_.fire.fire, scene_.model);
    }
    float time_s() const { return vortons_.time_s(scene_.fire.dt_s); }
    const VortexScene& scene() const { return scene_; }
    fire::SharedFire& flames() { return flames_; }
    const VortexFire& vortons() const { return vortons_; }

  private:
    VortexScene scene_;
    fire::SharedFire flames_;
    VortexFire vortons_;
};

/// Draws one fire. Needs a current OpenGL context.
class VortexView {
  public:
    VortexView(const VortexScene& scene, int width_px, int height_px)
        : view_(scene.fire, width_px, height_px), gain_(fire::particle_count(scene.fire.fire)) {}

    //! [draw]
    /// Smoke first, then what shines, as in chapter 07.
    void draw(SharedVortexFire& fire, const course::Camera& camera) {
        draw(fire, camera, fire.scene().shading);
    }
    void draw(SharedVortexFire& fire, const course::Camera& camera, const Shading& shading) {
        const VortexScene& scene = fire.scene();
        fire::FireRenderer& renderer = view_.renderer();
        if (fire.vortons().model().ball.radius_m > 0) place_ball(renderer, fire.vortons().flow().ball);
        renderer.begin(camera, fire::lights_at(scene.fire, fire.time_s()));
        view_.draw_kinds(fire.flames(), fire::Blend::alpha, camera);
        shade<Known::vorticity>(fire, shading);
        for (int k = 0; k < scene.fire.fire.kind_count; ++k) {
            const fire::ParticleKind& kind = scene.fire.fire.kind[k];
            if (scene.fire.looks[k].blend != fire::Blend::additive) continue;
            const bool burns = k == 0;  // sparks shine as they did
            renderer.draw({&fire.flames().position().gl_buffer(), &fire.flames().velocity().gl_buffer(),
                           kind.first, kind.count, burns ? &gain_.gl_buffer() : nullptr},
                          scene.fire.looks[k]);
        }
        renderer.finish();
    }
    //! [draw]

    //! [draw_map]
    /// A slice through the flames as a map: blue where `kKnown` is 0, red from `full` on. Every flame is
    /// drawn in both colours, with as much of each as its value says.
    template <Known kKnown>
    void draw_map(SharedVortexFire& fire, const course::Camera& camera, float full, float slice_m) {
        const VortexScene& scene = fire.scene();
        const fire::ParticleKind& flame = scene.fire.fire.kind[0];
        fire::SpriteLook look = scene.fire.looks[0];
        look.temperature_start_K = 0;  // no black body: the colour alone, however old the flame is
        look.light *= 0.5f;
        fire::FireRenderer& renderer = view_.renderer();
        const fire::Stage stage = renderer.stage;
        renderer.stage.sky_low = renderer.stage.sky_high = glm::vec3(0);  // a map wants no sky
        renderer.begin(camera, {});
        for (const bool high : {false, true}) {
            shade<kKnown>(fire, {high ? 0.0f : 1.0f, high ? 1.0f : 0.0f, full, slice_m});
            look.colour = high ? glm::vec3(1, 0.10f, 0) : glm::vec3(0, 0.10f, 1);
            renderer.draw({&fire.flames().position().gl_buffer(), &fire.flames().velocity().gl_buffer(),
                           flame.first, flame.count, &gain_.gl_buffer()},
                          look);
        }
        renderer.finish();
        renderer.stage = stage;
    }
    //! [draw_map]

    course::Image image() const { return view_.image(); }
    const course::Framebuffer& picture() const { return view_.picture(); }

  private:
    template <Known kKnown>
    void shade(SharedVortexFire& fire, const Shading& shading) {
        const fire::FlameArrays flames = fire.flames().map();
        fire.vortons().shade<kKnown>(gain_.map(), flames.position, shading);
        gain_.unmap();
        fire.flames().unmap();
    }

    /// The stage's last solid is the ball: a rod that is as good as without length.
    static void place_ball(fire::FireRenderer& renderer, const Ball& ball) {
        fire::Rod& last = renderer.stage.rods.back();
        last.from_m = ball.centre_m - glm::vec3(0, 5e-3f, 0);
        last.to_m = ball.centre_m + glm::vec3(0, 5e-3f, 0);
    }

    fire::FireView view_;
    interop::InteropBuffer<float> gain_;
};

}  // namespace vortex
