/// @file
/// Water from particles to picture, by a mesh or by the screen: the passes in their order.
#pragma once
#include "14_surface_generation/gl_mesh.cuh"
#include "15_water_rendering/field_volume.cuh"
#include "15_water_rendering/light_sum.h"
#include "15_water_rendering/screen_space.h"
#include "15_water_rendering/sunshine.h"

namespace water {

/// The shader files that a look needs. What it leaves out is not even compiled.
//! [shader_files]
inline std::vector<std::string> shader_files(const Look& look) {
    const bool marched = look.has_volume() && look.inside == Inside::marched;
    return {"fullscreen.vert",
            "water_view.frag",
            look.first_marched ? "water_first_march.frag" : "water_first_drawn.frag",
            marched ? "water_path.frag" : "water_thickness.frag",
            "water_tank.frag",
            "water_stage.frag",
            "water_optics.frag"};
}
//! [shader_files]

/// Draws water as the eye knows it. Needs a current OpenGL context.
class SurfaceView {
  public:
    /// @throws course::BadInput if a shader does not compile or the picture is too large for the driver
    SurfaceView(int width_px, int height_px, const Look& look, const Stage& stage, float spacing_m,
                const Light& light = {})
        : look_(checked(look)),
          stage_(stage),
          spacing_m_(spacing_m),
          lit_(light, whole_),
          sum_(width_px, height_px),
          view_(shader_files(look_)) {
        if (!look_.first_marched) first_.emplace(width_px, height_px, look_.shows_thickness());
        if (look_.has_field()) {
            surface::SurfaceSettings settings;
            settings.particle_spacing_m = spacing_m;
            settings.nodes_per_spacing = look_.nodes_per_spacing;
            surface_.emplace(settings);
        }
        if (look_.has_volume()) volume_.emplace();
        if (look_.has_sunshine()) sunshine_.emplace(stage, light, look_.sunshine_texels);
        if (look_.has_mesh()) {
            mesh_.emplace();
            mesh_pass_.emplace(look_.shows_thickness());
        }
        if (look_.drawing == Drawing::screen_space) screen_.emplace(width_px, height_px);
        course::check_gl("making the water's view");
    }

    //! [draw]
    /// Draws the particles' water as seen by the camera.
    void draw(const float4* position, std::uint32_t count, const Ball& ball, const course::Camera& camera) {
        stage_.ball = ball;
        clock_.clear();
        if (surface_) make_surface(position, count);
        if (screen_) take_particles(position, count);
        if (sunshine_)
            time("sunshine", [&] {
                sunshine_->draw(whole_, lit_.light().absorption_per_m,
                                [&](const ShaderProgram& p) { set_scene(p); });
            });
        sum_.clear();
        for (int k = 0; k < look_.samples; ++k) add_sample(count, camera, k);
        time("film", [&] { sum_.develop(look_.exposure, whole_); });
        course::check_gl("drawing water");
    }
    //! [draw]

    const Framebuffer& picture() const { return sum_.picture(); }
    course::Image image() const { return course::read_image(picture()); }
    std::vector<float> light() const { return sum_.light(); }
    const Look& look() const { return look_; }
    PassClock& clock() { return clock_; }
    const std::optional<surface::Surface>& surface() const { return surface_; }
    const std::optional<Sunshine>& sunshine() const { return sunshine_; }

  private:
    template <class Work>
    void time(const char* pass, Work&& work) {
        const auto wait = [] {
            CUDA_CHECK(cudaDeviceSynchronize());
            glFinish();
        };
        clock_.time(pass, wait, work);
    }

    void make_surface(const float4* position, std::uint32_t count) {
        time("field", [&] { surface_->build(position, count); });
        time("smoothing", [&] { smoothed_.build(*surface_, look_.smoothing_rounds); });
        if (mesh_) time("mesh", [&] { mesh_->take(smoothed_); });
        if (volume_) time("volume", [&] { volume_->take(smoothed_); });
    }
    void take_particles(const float4* position, std::uint32_t count) {
        if (count == 0) return;
        if (!particles_ || particles_->size() < count) {
            particles_.reset();
            particles_ = std::make_unique<interop::InteropBuffer<float4>>(count);
        }
        CUDA_CHECK(cudaMemcpy(particles_->map(), position, count * sizeof(float4), cudaMemcpyDeviceToDevice));
        particles_->unmap();
    }

    //! [add_sample]
    void add_sample(std::uint32_t count, const course::Camera& camera, int k) {
        Shot shot{camera, picture().width(), picture().height(), sample_place(k)};
        if (mesh_pass_) {
            time("first surface",
                 [&] { mesh_pass_->draw(*first_, mesh_->buffers(), stage_, gap_m(), shot); });
        }
        if (screen_ && k == 0) {  // too dear for each sample
            shot.shift_px = {0, 0};
            const GLuint buffer = count ? particles_->gl_buffer().id() : 0;
            time("first surface", [&] { screen_->draw(*first_, buffer, count, spacing_m_, shot, whole_); });
            shot.shift_px = sample_place(k);
        }
        time("light", [&] {
            view_.use();
            set_scene(view_);
            shot.set(view_);
            if (first_) first_->set(view_);
            if (sunshine_) sunshine_->set(view_);
            sum_.add(whole_);
        });
    }
    //! [add_sample]

    void set_scene(const ShaderProgram& p) const {
        lit_.set(p, stage_, look_);
        p.set("wall_gap_m", gap_m());
        p.set("bend", int(look_.inside == Inside::thickness));
        if (!volume_) return;
        volume_->texture().bind(kFieldUnit);
        p.set("field", int(kFieldUnit));
        volume_->free_texture().bind(kFreeUnit);
        p.set("free_blocks", int(kFreeUnit));
        p.set("block_m", volume_->block_m());
        p.set("blocks_size_m", volume_->block_m() * glm::vec3(volume_->free_texture().size()));
        p.set("iso", volume_->iso());
        p.set("field_low_m", volume_->low_m());
        p.set("field_size_m", volume_->size_m());
        p.set("field_cell_m", volume_->node_m());
        p.set("step_m", volume_->node_m() * look_.step_in_nodes);
    }
    float gap_m() const { return wall_gap_m(spacing_m_); }

    Look look_;
    Stage stage_;
    float spacing_m_;
    WholePicture whole_;
    LitStage lit_;
    LightSum sum_;
    ShaderProgram view_;
    PassClock clock_;
    // Only what the look needs is made.
    std::optional<FirstSurface> first_;
    std::optional<surface::Surface> surface_;
    SmoothedSurface smoothed_;
    std::optional<FieldVolume> volume_;
    std::optional<Sunshine> sunshine_;
    std::optional<surface::GlMesh> mesh_;
    std::optional<MeshPass> mesh_pass_;
    std::optional<ScreenSpace> screen_;
    std::unique_ptr<interop::InteropBuffer<float4>> particles_;
};

}  // namespace water
