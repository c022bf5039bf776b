/// @file
/// What a surface is made with.
#pragma once
#include <string>

#include "common/errors.h"

namespace surface {

enum class FieldKind {
    colour,       ///< sum of volume x W, about 1 inside (Mueller, Charypar and Gross, 2003)
    zhu_bridson,  ///< 1 - distance from the neighbours' mean place / radius (after Zhu and Bridson, 2005)
    anisotropic   ///< the colour field with blobs that lie flat (after Yu and Turk, 2013)
};

//! [SurfaceSettings]
/// Everything a surface depends on, apart from its particles. Lengths without a unit in their name are in
/// units of the particles' spacing.
struct SurfaceSettings {
    FieldKind kind = FieldKind::anisotropic;
    float particle_spacing_m = 0.02f;  ///< each particle stands for a cube of this edge
    float nodes_per_spacing = 2;       ///< resolution: nodes of the field for each spacing
    float iso = 0;                     ///< where the surface is; 0: default_iso()
    float radius = 0;                  ///< of a round blob; 0: default_radius()
    float neighbour_reach = 3;         ///< anisotropic: particles so near say how a blob lies
    float pull = 0.6f;   ///< anisotropic: 0: a blob stays at its particle, 1: at its neighbours' mean
    bool sparse = true;  ///< bricks where particles are, or everywhere in the box around them
};
//! [SurfaceSettings]

//! [defaults]
/// Wide enough to melt neighbours into one, and not so wide that a drop of three particles is lost. Flat
/// blobs are thinner than round ones, so they may be wider.
inline float default_radius(FieldKind kind) {
    return kind == FieldKind::anisotropic ? 2.5f : 2.0f;
}

/// Puts a flat surface about half a spacing beyond the outermost particles: where the water ends if each
/// particle fills a cube around it. For the colour field that is half its value inside; for Zhu and Bridson's
/// the distance decides; for flat blobs, which have been pulled inwards, it is a compromise: 0.3 leaves the
/// surface an eighth of a spacing too low, and makes of a single particle a drop of 1.2 times its volume;
/// less would mend the one and spoil the other.
inline float default_iso(FieldKind kind, float radius) {
    if (kind == FieldKind::zhu_bridson) return radius > 1 ? 1 - 0.5f / radius : 0.5f;
    return kind == FieldKind::anisotropic ? 0.3f : 0.5f;
}
//! [defaults]

/// With nothing left to be chosen. @throws course::BadInput naming what makes no sense
inline SurfaceSettings complete(SurfaceSettings s) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(s.particle_spacing_m >= 1e-12f && s.particle_spacing_m <= 1e12f,
         "the particles' spacing must be from 1e-12 to 1e12 m, not " + std::to_string(s.particle_spacing_m) +
             " m");
    want(s.nodes_per_spacing >= 0.25f && s.nodes_per_spacing <= 64,
         "a surface takes 0.25 to 64 nodes for each spacing of the particles, not " +
             std::to_string(s.nodes_per_spacing));
    if (s.radius == 0) s.radius = default_radius(s.kind);
    want(s.radius >= 0.5f && s.radius <= 8,
         "a blob's radius must be 0.5 to 8 spacings of the particles, not " + std::to_string(s.radius));
    if (s.iso == 0) s.iso = default_iso(s.kind, s.radius);
    want(s.iso >= 1e-3f && s.iso <= 1e30f,
         "the iso-value must be at least 0.001, since the field is 0 where no particle is, not " +
             std::to_string(s.iso));
    want(s.neighbour_reach >= 0.5f && s.neighbour_reach <= 8,
         "a blob's neighbours are looked for within 0.5 to 8 spacings, not " +
             std::to_string(s.neighbour_reach));
    want(s.pull >= 0 && s.pull <= 1, "a blob is pulled by a part from 0 to 1, not " + std::to_string(s.pull));
    return s;
}

}  // namespace surface
