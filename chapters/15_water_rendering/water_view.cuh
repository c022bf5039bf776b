/// @file
/// One view of a run, however it is drawn.
#pragma once
#include "06_gl_interop/tank_view.cuh"
#include "15_water_rendering/simulation.cuh"
#include "15_water_rendering/surface_view.cuh"

namespace water {

/// Has what its look needs and no more. Needs a current OpenGL context.
class WaterView {
  public:
    WaterView(const Look& look, const WaterScene& scene, const Run& run, int width_px, int height_px) {
        if (look.drawing == Drawing::points || look.drawing == Drawing::spheres) {
            interop::TankScene tank;
            tank.tank = {scene.stage.tank_low_m, scene.stage.tank_high_m};
            tank.drawing =
                look.drawing == Drawing::points ? interop::Drawing::points : interop::Drawing::spheres;
            tank.radius_m = 0.55f * run.spacing_m;
            tank.white_at_m_per_s = float(run.white_m_per_s);
            particles_.emplace(tank, std::max<std::size_t>(1, run.size()), width_px, height_px);
        } else {
            surface_.emplace(width_px, height_px, look, scene.stage, run.spacing_m);
        }
    }

    void draw(const Run& run, const course::Camera& camera) {
        if (surface_) {
            surface_->draw(run.position(), run.size(), run.ball(), camera);
            return;
        }
        plain_clock_.clear();
        const auto wait = [] {
            CUDA_CHECK(cudaDeviceSynchronize());
            glFinish();
        };
        plain_clock_.time("particles", wait,
                          [&] { particles_->draw(run.position(), run.velocity(), run.size(), camera); });
    }

    const course::Framebuffer& picture() const {
        return surface_ ? surface_->picture() : particles_->picture();
    }
    course::Image image() const { return course::read_image(picture()); }
    PassClock& clock() { return surface_ ? surface_->clock() : plain_clock_; }
    const std::optional<SurfaceView>& surface() const { return surface_; }

  private:
    std::optional<interop::TankView> particles_;
    std::optional<SurfaceView> surface_;
    PassClock plain_clock_;
};

}  // namespace water
