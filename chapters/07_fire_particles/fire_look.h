/// @file
/// How a fire looks: plain structs, all light linear. From them follow the shaders and textures that are
/// made.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace fire {

enum class Blend {
    additive,  ///< light on top of light: the order does not matter
    alpha      ///< covers what is behind it: right only when drawn from back to front
};

/// How the particles of one kind are drawn. `burnt` is the part of its life that a particle has behind it:
/// age / life, 0 at birth and 1 at death.
struct SpriteLook {
    Blend blend = Blend::additive;
    float radius_start_m = 0.02f, radius_end_m = 0.02f;  ///< at burnt = 0 and 1, linear between
    float stretch_s = 0;       ///< a sprite is longer along its velocity by what it flies in this time
    float fade_in = 0.1f;      ///< part of the life in which it appears...
    float fade_out = 0.3f;     ///< ...and in which it goes
    float wisps = 0.5f;        ///< 0: a smooth spot; 1: torn to shreds by the texture
    float softness_m = 0.02f;  ///< it fades over this distance where it meets something solid

    // Light it gives off (additive).
    float temperature_start_K = 1900,
          temperature_end_K = 1400;  ///< start 0: `colour` instead of a black body
    float light =
        0.05f;  ///< luminance of one sprite's middle at 1900 K; a flame is dozens on top of each other
    glm::vec3 colour{1};  ///< multiplies the light; alpha: what it reflects

    // How much it covers (alpha).
    float opacity = 0;
};

/// Something solid that a fire stands on or sits on: a cylinder with round ends.
struct Rod {
    glm::vec3 from_m, to_m;
    float radius_m;
    enum Material { wood = 0, wax = 1, wick = 2 } material = wood;
    float embers = 0;  ///< 0 to 1: how much of it glows
};
constexpr int kMaxRods = 10;

/// Where the fire's light comes from, as what it falls on sees it. The light's inverse square is softened
/// within `size_m`.
struct FireLight {
    glm::vec3 position_m{0, 0.3f, 0};
    glm::vec3 intensity{1};  ///< linear light on a surface 1 m away that faces it
    float size_m = 0.1f;
};
constexpr int kMaxLights = 4;

/// What is there besides the fire, and the film that it is photographed on.
struct Stage {
    std::vector<Rod> rods;
    bool ground = true;
    glm::vec3 ground_colour{0.20f, 0.16f, 0.13f};
    float ground_grain_m = 0.05f;  ///< size of its lumps; 0: a table top
    /// The evening sky's light at the horizon and overhead. It is what dark smoke is seen against, and it
    /// lights, faintly, what the fire does not.
    glm::vec3 sky_low{0.026f, 0.029f, 0.038f}, sky_high{0.009f, 0.0115f, 0.017f};
    float exposure = 1;   ///< light that the film gets; doubling it is one stop
    float glare = 0.05f;  ///< part of the light that the lens scatters over the picture
};

}  // namespace fire
