/// @file
/// How a scene looks: plain structs, all colours in linear light. From them follow the shaders that run and
/// the OpenGL objects that are made.
#pragma once
#include <array>
#include <glm/glm.hpp>

/// Chapter 06: particles on screen.
namespace interop {

/// Four colours of rising speed; the shader mixes between neighbours.
struct Palette {
    std::array<glm::vec3, 4> colours;
    float top_m_per_s = 1;  ///< speed of the last colour
};

/// Deep blue at rest, turquoise in motion, white foam at `top_m_per_s` and above.
inline Palette water_palette(float top_m_per_s) {
    return {{glm::vec3(0.003f, 0.060f, 0.185f), glm::vec3(0.006f, 0.185f, 0.400f),
             glm::vec3(0.060f, 0.440f, 0.620f), glm::vec3(0.82f, 0.91f, 0.95f)},
            top_m_per_s};
}

struct Light {
    glm::vec3 towards{-0.37f, 0.81f, 0.45f};  ///< direction of the key light; its length does not matter
    glm::vec3 key{1.95f, 1.84f, 1.66f};
    glm::vec3 sky{0.07f, 0.16f, 0.30f};  ///< overhead
    glm::vec3 horizon{0.27f, 0.36f, 0.44f};
    glm::vec3 ground{0.068f, 0.097f, 0.130f};  ///< part of the light that the floor throws back
};

/// An axis-aligned box, in metres.
struct Box {
    glm::vec3 low_m{-0.5f, 0, -0.5f};
    glm::vec3 high_m{0.5f, 1, 0.5f};
    glm::vec3 centre_m() const { return 0.5f * (low_m + high_m); }
    float half_diagonal_m() const { return 0.5f * glm::length(high_m - low_m); }
};

enum class Drawing {
    points,  ///< a dot a particle: no light, no shadow, the cheapest
    spheres  ///< lit spheres with correct depth
};

struct Look {
    Drawing drawing = Drawing::spheres;
    Palette palette = water_palette(3);
    Light light;
    Box region;                  ///< where the particles are: shadows cover it, the floor is its lower face
    bool region_edges = false;   ///< draw the region as a tank of twelve lines
    bool shadows = true;         ///< spheres only: the key light's shadows
    float occlusion_radii = 5;   ///< spheres only: reach of the dimming between near spheres; 0: none
    int samples_per_axis = 2;    ///< spheres only: 2 means 4 samples a pixel, smooth outlines
    int mesh_rings = 0;          ///< spheres only, to compare: made of 4 rings^2 triangles; 0: impostors
    float floor_tile_m = 0.25f;  ///< distance of the lines on the floor
};

}  // namespace interop
