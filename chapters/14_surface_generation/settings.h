/// @file
/// What a surface is made with.
#pragma once
#include <string>

#include "common/errors.h"

namespace surface {

enum class FieldKind {
    colour,       ///< sum of volume x W, about 1 inside (Mueller, Charypar and Gross, 2003)
    zhu_bridson,  ///< 1 - distance from the neighbours' mean place / radius (after Zhu and Bridson, 2005)
    anisotropic   ///< the colour field with blobs that lie flat (Yu and Turk, 2013)
};

/// Everything a surface depends on, apart from its particles. Lengths in units of the particles' spacing are
/// marked so.
struct SurfaceSettings {
    FieldKind kind = FieldKind::anisotropic;
    float particle_spacing_m = 0.02f;  ///< each particle stands for a cube of this edge
    float nodes_per_spacing = 2;       ///< resolution: nodes of the field for each spacing
    float iso = 0;                     ///< where the surface is; 0: what suits the kind of field
    float radius = 2;                  ///< of a blob, in spacings
    float neighbour_reach = 3;         ///< anisotropic: whom a blob looks at, in spacings
    bool sparse = true;                ///< bricks where particles are, or everywhere in the box around them
};

//! [default_iso]
/// The value that a flat surface of settled water has half a spacing beyond its outermost particles: where
/// the water ends if each particle fills a cube around it. Measured by the study `flat`.
inline float default_iso(const SurfaceSettings& settings) {
    switch (settings.kind) {
        case FieldKind::colour:
            return 0.5f;
        case FieldKind::zhu_bridson:
            return 1 - 0.5f / settings.radius;
        case FieldKind::anisotropic:
            return 0.5f;
    }
    return 0.5f;
}
//! [default_iso]

/// @throws course::BadInput naming what makes no sense
inline void check_settings(const SurfaceSettings& s) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(s.particle_spacing_m > 0 && s.particle_spacing_m < 1e30f,
         "the particles' spacing must be above 0, not " + std::to_string(s.particle_spacing_m) + " m");
    want(s.nodes_per_spacing >= 0.25f && s.nodes_per_spacing <= 64,
         "a surface takes 0.25 to 64 nodes for each spacing of the particles, not " +
             std::to_string(s.nodes_per_spacing));
    want(s.iso == 0 || (s.iso >= 1e-3f && s.iso < 1e30f),
         "the iso-value must be at least 0.001 (the field is 0 where no particle is), not " +
             std::to_string(s.iso));
    want(s.radius >= 0.5f && s.radius <= 8, "a blob's radius is 0.5 to 8 spacings");
    want(s.neighbour_reach >= 0.5f && s.neighbour_reach <= 8, "neighbours are looked for within 0.5 to 8 spacings");
}

}  // namespace surface
