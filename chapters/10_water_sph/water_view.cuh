/// @file
/// The water on screen: chapter 06's renderer, fed from the simulation's arrays.
#pragma once
#include "06_gl_interop/interop_buffer.cuh"
#include "06_gl_interop/particle_renderer.h"
#include "10_water_sph/run.cuh"

namespace sph {

/// The tank as the first picture shows it: from the front, a little above the water.
inline course::OrbitCamera first_view(const Box& tank) {
    const glm::vec3 low(tank.low_m.x, tank.low_m.y, tank.low_m.z),
        high(tank.high_m.x, tank.high_m.y, tank.high_m.z);
    course::OrbitCamera orbit;
    orbit.target_m =
        glm::vec3(0.5f * (low.x + high.x), low.y + 0.40f * (high.y - low.y), 0.5f * (low.z + high.z));
    orbit.distance_m = 1.2f * glm::length(high - low);
    orbit.yaw_rad = 0.42f;
    orbit.pitch_rad = 0.30f;
    return orbit;
}

/// Draws one body of water. Needs a current OpenGL context.
class WaterView {
  public:
    template <class AnyWater>
    WaterView(const Settings& settings, const StartOf<AnyWater>& start, int width_px, int height_px)
        : position_(start.water.size()),
          velocity_(start.water.size()),
          radius_m_(0.55f * start.spacing_m),
          renderer_(width_px, height_px, look(settings, start)) {}

    //! [show]
    /// Copies positions and velocities into the OpenGL buffers, on the device, and draws them.
    template <class AnyWater>
    void draw(const AnyWater& water, const course::Camera& camera) {
        copy(position_, water.position());
        copy(velocity_, water.velocity());
        renderer_.draw(position_.gl_buffer(), &velocity_.gl_buffer(), water.size(), radius_m_, camera);
    }
    //! [show]
    course::Image image() const { return renderer_.image(); }
    const course::Framebuffer& picture() const { return renderer_.picture(); }
    std::string handover() const { return position_.why(); }

  private:
    static void copy(interop::InteropBuffer<float4>& to, const float4* from) {
        CUDA_CHECK(cudaMemcpy(to.map(), from, to.size() * sizeof(float4), cudaMemcpyDeviceToDevice));
        to.unmap();
    }
    template <class AnyWater>
    static interop::Look look(const Settings& settings, const StartOf<AnyWater>& start) {
        const Box& tank = settings.scene.tank;
        interop::Look look;
        look.drawing =
            settings.drawing == Drawing::points ? interop::Drawing::points : interop::Drawing::spheres;
        // White where water is as fast as a free fall from the top of the block makes it.
        look.palette = interop::water_palette(1.1f * start.water.fluid().sound_speed_m_per_s /
                                              (6 * settings.choice.stiffness) * 1.4142f);
        look.region = {{tank.low_m.x, tank.low_m.y, tank.low_m.z},
                       {tank.high_m.x, tank.high_m.y, tank.high_m.z}};
        look.region_edges = true;
        look.floor_tile_m = 0.1f;
        return look;
    }

    interop::InteropBuffer<float4> position_, velocity_;
    float radius_m_;
    interop::ParticleRenderer renderer_;
};

}  // namespace sph
