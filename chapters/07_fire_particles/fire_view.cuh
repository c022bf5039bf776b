/// @file
/// A scene on screen: its renderer, and the sorting of what covers.
#pragma once
#include <memory>

#include "07_fire_particles/depth_sort.cuh"

namespace fire {

enum class SmokeOrder {
    sorted,   ///< from back to front: right
    unsorted  ///< as the particles lie in memory: cheaper, and wrong
};

/// Draws one fire. Needs a current OpenGL context.
class FireView {
  public:
    FireView(const FireScene& scene, int width_px, int height_px, SmokeOrder order = SmokeOrder::sorted,
             int depth_slices = kDepthSlices)
        : renderer_(width_px, height_px, scene.stage) {
        // Light adds up in any order: only what covers has to be sorted.
        std::uint32_t largest = 0;
        for (int k = 0; k < scene.fire.kind_count; ++k)
            if (scene.looks[k].blend == Blend::alpha) largest = std::max(largest, scene.fire.kind[k].count);
        if (largest > 0 && order == SmokeOrder::sorted)
            sort_ = std::make_unique<DepthSort>(largest, depth_slices);
    }

    //! [draw_fire]
    /// The smoke first, then what shines: flames are seen through it, as if it were behind them.
    void draw(SharedFire& fire, const course::Camera& camera) {
        renderer_.begin(camera, lights_at(fire.scene(), fire.time_s()));
        draw_kinds(fire, Blend::alpha, camera);
        draw_kinds(fire, Blend::additive, camera);
        renderer_.finish();
    }
    //! [draw_fire]

    FireRenderer& renderer() { return renderer_; }
    course::Image image() const { return renderer_.image(); }
    const course::Framebuffer& picture() const { return renderer_.picture(); }

    /// The particles of one way of blending.
    void draw_kinds(SharedFire& fire, Blend blend, const course::Camera& camera) {
        const FireScene& scene = fire.scene();
        for (int k = 0; k < scene.fire.kind_count; ++k) {
            const ParticleKind& kind = scene.fire.kind[k];
            if (scene.looks[k].blend != blend) continue;
            if (blend == Blend::alpha && sort_) {
                sort_->sort(fire, kind.first, kind.count, camera);
                renderer_.draw(
                    {&sort_->position().gl_buffer(), &sort_->velocity().gl_buffer(), 0, kind.count},
                    scene.looks[k]);
            } else {
                renderer_.draw(
                    {&fire.position().gl_buffer(), &fire.velocity().gl_buffer(), kind.first, kind.count},
                    scene.looks[k]);
            }
        }
    }

  private:
    FireRenderer renderer_;
    std::unique_ptr<DepthSort> sort_;
};

}  // namespace fire
