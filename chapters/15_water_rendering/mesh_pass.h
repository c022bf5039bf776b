/// @file
/// The mesh of the water, drawn: which surface is seen first at each pixel, and how much water lies along the
/// ray.
#pragma once
#include "14_surface_generation/mesh_renderer.h"
#include "15_water_rendering/lit_stage.h"

namespace water {

/// What screen-space passes and mesh passes leave for water_view.frag: normal and distance of the first
/// surface, and, if it is wanted, the thickness.
struct FirstSurface {
    Framebuffer surface;
    std::optional<Framebuffer> thickness;

    FirstSurface(int width_px, int height_px, bool with_thickness)
        : surface(width_px, height_px, GL_RGBA32F, Framebuffer::Depth::float32) {
        if (with_thickness) thickness.emplace(width_px, height_px, GL_R32F, Framebuffer::Depth::none);
    }
    void set(const ShaderProgram& p) const {
        surface.colour().bind(kFirstUnit);
        p.set("first_surface", int(kFirstUnit));
        if (!thickness) return;
        thickness->colour().bind(kThicknessUnit);
        p.set("thickness_map", int(kThicknessUnit));
    }
};

class MeshPass {
  public:
    explicit MeshPass(bool with_thickness) : nearest_({"water_mesh.vert", "water_mesh.frag"}) {
        if (with_thickness)
            all_.emplace(std::vector<std::string>{"water_mesh.vert", "water_mesh_thickness.frag"});
    }

    void draw(const FirstSurface& to, const surface::MeshBuffers& mesh, const Stage& stage, float gap_m,
              const Shot& shot) {
        if (mesh.triangles) bind(mesh);
        to.surface.bind();
        glEnable(GL_DEPTH_TEST);
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        draw_with(nearest_, mesh, stage, gap_m, shot);
        glDisable(GL_DEPTH_TEST);
        if (!all_) return;
        to.thickness->bind();
        glClear(GL_COLOR_BUFFER_BIT);
        const Adding adding;
        draw_with(*all_, mesh, stage, gap_m, shot);
    }

  private:
    void bind(const surface::MeshBuffers& mesh) {
        glBindVertexArray(vertices_.id());
        for (const auto& [input, buffer] : {std::pair{0u, mesh.position}, std::pair{1u, mesh.normal}}) {
            glBindBuffer(GL_ARRAY_BUFFER, buffer);
            glVertexAttribPointer(input, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
            glEnableVertexAttribArray(input);
        }
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.index);
    }
    static void draw_with(const ShaderProgram& p, const surface::MeshBuffers& mesh, const Stage& stage,
                          float gap_m, const Shot& shot) {
        if (mesh.triangles == 0) return;
        p.use();
        shot.set(p);
        p.set("tank_low_m", stage.tank_low_m);
        p.set("tank_high_m", stage.tank_high_m);
        p.set("wall_gap_m", gap_m);
        glDrawElements(GL_TRIANGLES, GLsizei(3 * mesh.triangles), GL_UNSIGNED_INT, nullptr);
    }

    course::VertexArray vertices_;
    ShaderProgram nearest_;
    std::optional<ShaderProgram> all_;
};

}  // namespace water
