/// @file
/// What light does where air and water meet, and on its way through water: the formulas of the shaders
/// (water_optics.frag), for tests and tables.
#pragma once
#include <algorithm>
#include <cmath>

/// Chapter 15: water as the eye knows it.
namespace water {

constexpr double kWaterIndex = 1.333;  // refractive index of water at 20 C, yellow light; air's is 1
constexpr double kGlassIndex = 1.5;    // of window glass

/// How much of unpolarised light a smooth surface throws back. The rest goes through.
//! [fresnel]
/// Fresnel's equations.
/// @param cosine  of the angle between ray and normal, on the side that the ray comes from; 0 to 1
/// @param index   refractive index beyond the surface over the one before it
template <class Real>
Real fresnel_exact(Real cosine, Real index) {
    const Real sine2_beyond = (1 - cosine * cosine) / (index * index);  // Snell
    if (sine2_beyond >= 1) return 1;                                    // total reflection
    const Real beyond = std::sqrt(1 - sine2_beyond);
    const Real across = (cosine - index * beyond) / (cosine + index * beyond);
    const Real along = (index * cosine - beyond) / (index * cosine + beyond);
    return (across * across + along * along) / 2;
}

/// Schlick's approximation (1994). Its angle is the one in the thinner medium, on whichever side the ray is.
template <class Real>
Real fresnel_schlick(Real cosine, Real index) {
    if (index < 1) {
        const Real sine2_beyond = (1 - cosine * cosine) / (index * index);
        if (sine2_beyond >= 1) return 1;
        cosine = std::sqrt(1 - sine2_beyond);
    }
    const Real head_on = (index - 1) / (index + 1), r0 = head_on * head_on;
    const Real missing = 1 - cosine, missing2 = missing * missing;
    return r0 + (1 - r0) * missing2 * missing2 * missing;
}
//! [fresnel]

/// What a clean pane throws back: r from its near face, and from its far face what goes to and fro in it.
/// r + (1-r)^2 r (1 + r^2 + r^4 + ...) = 2r / (1 + r).
inline double pane_reflection(double cosine) {
    const double once = fresnel_exact(cosine, kGlassIndex);
    return 2 * once / (1 + once);
}

/// Farther than this from the normal, light does not get out of water: 48.6 degrees.
inline double critical_angle_rad() {
    return std::asin(1 / kWaterIndex);
}

}  // namespace water
