/// @file
/// The water's surface on screen: a mesh in OpenGL's buffers, drawn with soft light.
#pragma once
#include <memory>

#include "10_water_sph/water_view.cuh"
#include "14_surface_generation/explain.h"
#include "14_surface_generation/gl_mesh.cuh"
#include "14_surface_generation/mesh_renderer.h"

namespace surface {

inline interop::Box tank_of(const Settings& settings) {
    const sph::Box& tank = settings.water.scene.tank;
    return {{tank.low_m.x, tank.low_m.y, tank.low_m.z}, {tank.high_m.x, tank.high_m.y, tank.high_m.z}};
}

/// Needs a current OpenGL context.
class SurfaceView {
  public:
    SurfaceView(const Settings& settings, int width_px, int height_px)
        : surface_(settings.surface), renderer_(width_px, height_px, look(settings)) {}

    //! [draw]
    /// Particles to picture. What comes to the host: the box around the particles, and how many regions,
    /// bricks, crossed rows, vertices and triangles there are.
    void draw(const float4* position, std::uint32_t n, const course::Camera& camera) {
        surface_.build(position, n);
        mesh_.take(surface_);
        renderer_.draw(mesh_.buffers(), camera);
    }
    //! [draw]

    const Surface& surface() const { return surface_; }
    course::Image image() const { return renderer_.image(); }
    const course::Framebuffer& picture() const { return renderer_.picture(); }
    std::string handover() const { return mesh_.handover(); }

  private:
    static interop::Look look(const Settings& settings) {
        interop::Look look;
        look.region = tank_of(settings);
        look.region_edges = true;
        look.floor_tile_m = 0.1f;
        return look;
    }

    Surface surface_;
    GlMesh mesh_;
    MeshRenderer renderer_;
};

/// Whichever view the settings ask for; the others are not made.
class View {
  public:
    View(const Settings& settings, const sph::Start& start, int width, int height) {
        if (settings.drawing == Drawing::surface)
            surface_ = std::make_unique<SurfaceView>(settings, width, height);
        else
            particles_ = std::make_unique<interop::TankView>(sph::look_of(settings.water, start),
                                                             start.water.size(), width, height);
    }
    void draw(const sph::Water& water, const course::Camera& camera) {
        if (surface_)
            surface_->draw(water.position(), water.size(), camera);
        else
            particles_->draw(water.position(), water.velocity(), water.size(), camera);
    }
    const course::Framebuffer& picture() const {
        return surface_ ? surface_->picture() : particles_->picture();
    }
    course::Image image() const { return course::read_image(picture()); }
    std::string handover() const { return surface_ ? surface_->handover() : particles_->handover(); }
    const Surface* surface() const { return surface_ ? &surface_->surface() : nullptr; }

  private:
    std::unique_ptr<SurfaceView> surface_;
    std::unique_ptr<interop::TankView> particles_;
};

}  // namespace surface
