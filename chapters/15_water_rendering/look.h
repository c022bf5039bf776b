/// @file
/// How water is drawn, as plain structs. From them follow the passes that run, the buffers and the OpenGL
/// objects that are made.
#pragma once
#include <glm/glm.hpp>
#include <string>

namespace water {

enum class Drawing {
    points,        ///< chapter 06's points
    spheres,       ///< chapter 06's lit spheres
    screen_space,  ///< a surface made of the spheres' depths, in the picture alone
    surface        ///< chapter 14's mesh
};

/// What happens to light that has gone into the water.
enum class Inside {
    marched,    ///< followed through the field, from surface to surface
    thickness,  ///< bent once, then as much water as the straight ray crosses
    straight    ///< not bent at all
};

//! [Look]
struct Look {
    Drawing drawing = Drawing::surface;
    Inside inside = Inside::marched;  ///< surface only: screen space knows no inside
    bool first_marched = false;       ///< surface only, to compare: no mesh, the eye's rays are marched, too
    bool schlick = false;             ///< the cheaper formula in place of Fresnel's
    bool caustics = true;             ///< sunlight through water, on the ground; needs Inside::marched
    int samples = 4;                  ///< rays a pixel
    float nodes_per_spacing = 2;      ///< of the field
    int smoothing_rounds = 6;         ///< of the field
    float step_in_nodes = 1;          ///< of the march through it
    int sunshine_texels = 500;        ///< along the longer side of the map of the sunshine
    float exposure = 0.85f;

    bool has_field() const { return drawing == Drawing::surface; }
    bool has_volume() const { return has_field() && (inside == Inside::marched || first_marched); }
    bool has_mesh() const { return has_field() && !first_marched; }
    bool has_sunshine() const { return has_volume() && inside == Inside::marched && caustics; }
    bool shows_thickness() const { return drawing == Drawing::screen_space || inside != Inside::marched; }
};
//! [Look]

/// A look whose parts go together. The screen shows no inside to march through: there the thickness has to
/// do. And whoever marches from the eye to the water marches on in it.
inline Look checked(Look look) {
    if (look.drawing == Drawing::screen_space && look.inside == Inside::marched)
        look.inside = Inside::thickness;
    if (look.drawing != Drawing::surface) look.first_marched = false;
    if (look.first_marched) look.inside = Inside::marched;
    return look;
}

/// Light and water of all scenes. Colours are linear.
struct Light {
    glm::vec3 to_sun = glm::normalize(glm::vec3(-0.55f, 0.78f, -0.42f));
    glm::vec3 sun{2.1f, 1.9f, 1.6f};     ///< on a surface that faces the sun
    glm::vec3 sky{0.42f, 0.52f, 0.66f};  ///< on a level surface, from all over the sky
    /// Of red, green and blue light. Clean water takes about a tenth of that: a tank is to look like a pool.
    glm::vec3 absorption_per_m{4.2f, 0.9f, 0.55f};
    float scattering_per_m = 0.35f;
    glm::vec3 scattered{0.10f, 0.34f, 0.42f};  ///< what scattering sends to the eye
};

/// A ball in the tank; radius 0: there is none.
struct Ball {
    glm::vec3 middle_m{0};
    float radius_m = 0;
};

/// What stands around the water.
struct Stage {
    glm::vec3 tank_low_m{0}, tank_high_m{1};
    Ball ball;
};

}  // namespace water
