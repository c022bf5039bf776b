/// @file
/// What a look needs: kernels of a picture, objects of OpenGL. Tests hold it against what really happens.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "15_water_rendering/look.h"

namespace water {

/// Objects of OpenGL that exist while a view does, by kind.
struct GlNeeds {
    int buffers = 0, vertex_arrays = 0, textures = 0, framebuffers = 0, programs = 0;
    void add(int buffer, int vertex_array, int texture, int framebuffer, int program) {
        buffers += buffer;
        vertex_arrays += vertex_array;
        textures += texture;
        framebuffers += framebuffer;
        programs += program;
    }
};

//! [gl_needs]
/// Once a picture with water in it has been drawn.
inline GlNeeds gl_needs(const Look& look) {
    GlNeeds n;
    if (look.drawing == Drawing::points || look.drawing == Drawing::spheres) {
        n.add(2, 2, 2, 1, 1);  // positions and speeds; the picture; the tank's edges
        if (look.drawing == Drawing::points)
            n.add(0, 0, 0, 0, 2);  // floor and sky, points
        else
            n.add(0, 0, 3, 2, 3);  // spheres before lighting, shadow map; three passes
        return n;
    }
    n.add(0, 1, 3, 3, 2);  // the sky, the light, the picture; the rays' pass and the film's
    if (!look.first_marched) n.add(0, 0, 2, 1, 0);  // the first surface
    if (look.shows_thickness()) n.add(0, 0, 1, 1, 0);
    if (look.has_mesh()) n.add(3, 1, 0, 0, look.shows_thickness() ? 2 : 1);
    if (look.has_volume()) n.add(2, 0, 2, 0, 0);  // the field, and how far rays may go in it
    if (look.has_sunshine()) n.add(0, 0, 2, 2, 2);
    if (look.drawing == Drawing::screen_space) n.add(1, 1, 3, 2, 4);
    return n;
}
//! [gl_needs]

/// Kernels of one picture by the start of their names, with how often each is launched; chapter 14's are
/// named by one each.
inline std::vector<std::pair<std::string, int>> kernels_per_picture(const Look& look) {
    const int field = look.has_field(), mesh = look.has_mesh(), volume = look.has_volume();
    return {{"field_kernel", field},          {"smooth_kernel", 3 * look.smoothing_rounds * field},
            {"vertices_kernel<true>", mesh},  {"triangles_kernel", mesh},
            {"unpack_bricks_kernel", volume}, {"find_surface_kernel", volume},
            {"grow_free_kernel", 8 * volume}};
}

/// The answer to --explain.
inline std::string explain(const Look& look, bool draws) {
    if (!draws)
        return "left out: OpenGL, its context and all its objects, the field and the mesh, since nothing is "
               "drawn\n";
    const GlNeeds gl = gl_needs(look);
    std::string kernels;
    for (const auto& [name, count] : kernels_per_picture(look))
        if (count)
            kernels +=
                (kernels.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
    std::string text = "each picture: " + (kernels.empty() ? "no kernel" : "kernels " + kernels) + "\n";
    text += "OpenGL: " + std::to_string(gl.buffers) + " buffers, " + std::to_string(gl.vertex_arrays) +
            " vertex arrays, " + std::to_string(gl.textures) + " textures, " +
            std::to_string(gl.framebuffers) + " framebuffers, " + std::to_string(gl.programs) + " programs\n";
    if (look.drawing == Drawing::points)
        text += "left out: field, mesh, normals, spheres, lighting, shadows\n";
    if (look.drawing == Drawing::spheres)
        text += "left out: field, mesh; an array of normals (the pixel's ray knows the sphere's)\n";
    if (look.drawing == Drawing::screen_space)
        text +=
            "left out: field, mesh, normals (they follow from depths); light inside the water, caustics\n";
    if (look.drawing == Drawing::surface) {
        text += "left out: spheres and their pass; colours of particles\n";
        if (!look.has_volume()) text += "left out: the field as a texture, caustics (nothing is marched)\n";
        if (look.has_volume() && !look.shows_thickness())
            text += "left out: a pass for the water's thickness\n";
        if (!look.has_mesh()) text += "left out: the mesh (all rays are marched)\n";
    }
    if (look.schlick) text += "left out: Fresnel's equations (Schlick's formula instead)\n";
    return text;
}

}  // namespace water
