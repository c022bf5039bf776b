/// @file
/// Particles in a tank on screen, from arrays that a simulation keeps in device memory for itself.
#pragma once
#include "06_gl_interop/interop_buffer.cuh"
#include "06_gl_interop/particle_renderer.h"

namespace interop {

/// The tank as the first picture shows it: from the front, a little above the particles.
inline course::OrbitCamera first_view(const Box& tank) {
    course::OrbitCamera orbit;
    orbit.target_m = tank.centre_m();
    orbit.target_m.y = tank.low_m.y + 0.40f * (tank.high_m.y - tank.low_m.y);
    orbit.distance_m = 2.4f * tank.half_diagonal_m();
    orbit.yaw_rad = 0.42f;
    orbit.pitch_rad = 0.30f;
    return orbit;
}

/// What is looked at, and how.
struct TankScene {
    Box tank;
    Drawing drawing = Drawing::spheres;
    float radius_m = 0.01f;      ///< of a sphere
    float white_at_m_per_s = 3;  ///< speed at which particles are white
    bool edges = true;           ///< the tank's twelve edges, over all that is drawn so far
};

/// Draws up to `max_particles` particles. Needs a current OpenGL context.
class TankView {
  public:
    TankView(const TankScene& scene, std::size_t max_particles, int width_px, int height_px)
        : position_(max_particles),
          velocity_(max_particles),
          radius_m_(scene.radius_m),
          renderer_(width_px, height_px, look(scene)) {}

    //! [show]
    /// Copies positions and velocities into the OpenGL buffers, on the device, and draws them.
    void draw(const float4* position, const float4* velocity, std::size_t count,
              const course::Camera& camera) {
        copy(position_, position, count);
        copy(velocity_, velocity, count);
        renderer_.draw(position_.gl_buffer(), &velocity_.gl_buffer(), count, radius_m_, camera);
    }
    //! [show]
    course::Image image() const { return renderer_.image(); }
    const course::Framebuffer& picture() const { return renderer_.picture(); }
    std::string handover() const { return position_.why(); }

  private:
    static void copy(InteropBuffer<float4>& to, const float4* from, std::size_t count) {
        CUDA_CHECK(cudaMemcpy(to.map(), from, count * sizeof(float4), cudaMemcpyDeviceToDevice));
        to.unmap();
    }
    static Look look(const TankScene& scene) {
        Look look;
        look.drawing = scene.drawing;
        look.palette = water_palette(scene.white_at_m_per_s);
        look.region = scene.tank;
        look.region_edges = scene.edges;
        look.floor_tile_m = 0.1f;
        return look;
    }

    InteropBuffer<float4> position_, velocity_;
    float radius_m_;
    ParticleRenderer renderer_;
};

}  // namespace interop
