/// @file
/// The marbles on screen: chapter 06's renderer, fed from the simulation's arrays.
#pragma once
#include "06_gl_interop/interop_buffer.cuh"
#include "06_gl_interop/particle_renderer.h"
#include "09_water_spring_mass/run.cuh"

namespace spring_mass {

/// The tank as the first picture shows it: from the front, a little above the marbles.
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

/// Draws the marbles. Needs a current OpenGL context.
class MarblesView {
  public:
    MarblesView(const Settings& settings, const Start& start, int width_px, int height_px)
        : position_(start.marbles.size()),
          velocity_(start.marbles.size()),
          radius_m_(0.5f * start.marbles.material().diameter_m),
          renderer_(width_px, height_px, look(settings)) {}

    //! [show]
    /// Copies positions and velocities into the OpenGL buffers, on the device, and draws them.
    void draw(const Marbles& marbles, const course::Camera& camera) {
        copy(position_, marbles.position());
        copy(velocity_, marbles.velocity());
        renderer_.draw(position_.gl_buffer(), &velocity_.gl_buffer(), marbles.size(), radius_m_, camera);
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
    static interop::Look look(const Settings& settings) {
        const Box& tank = settings.scene.tank;
        interop::Look look;
        look.drawing =
            settings.drawing == Drawing::points ? interop::Drawing::points : interop::Drawing::spheres;
        // White where marbles are as fast as a free fall from the top of the block makes them.
        const Scene& scene = settings.scene;
        const float top_m = scene.block_low_m.y + scene.block_size_m.y - scene.tank.low_m.y;
        look.palette = interop::water_palette(1.1f * std::sqrt(2 * 9.81f * top_m));
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

}  // namespace spring_mass
