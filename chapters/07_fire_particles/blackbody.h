/// @file
/// The colour of something that glows: from a temperature to linear sRGB.
///
/// Soot in a flame is a good black body. Its light is Planck's spectrum, seen through the three
/// colour-matching functions of CIE 1931, turned into the three primaries of a screen. All in linear light,
/// where light adds.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "07_fire_particles/cie_1931.h"

/// Chapter 07: fire from particles that do not know each other.
namespace fire {

//! [blackbody_xyz]
/// X, Y and Z of a black body, with the same unknown factor at every temperature: Planck's spectrum, weighted
/// with what the eye makes of each wavelength, and summed.
inline glm::dvec3 blackbody_xyz(double temperature_K) {
    constexpr double kSecondRadiation_mK = 1.438776877e-2;  // h c / k
    glm::dvec3 sum(0);
    for (int k = 0; k < kCieCount; ++k) {
        const double nm = kCieFirst_nm + k * kCieStep_nm;
        const double spectrum =
            std::pow(nm / 560, -5) / std::expm1(kSecondRadiation_mK / (1e-9 * nm * temperature_K));
        sum += spectrum * kColourMatching[k];
    }
    return sum;
}
//! [blackbody_xyz]

/// Chromaticity (x, y): colour without brightness.
inline glm::dvec2 chromaticity(glm::dvec3 xyz) {
    return glm::dvec2(xyz) / (xyz.x + xyz.y + xyz.z);
}

//! [to_linear_srgb]
/// CIE XYZ to the linear light of an sRGB screen: the inverse of its primaries' XYZ (IEC 61966-2-1, white
/// point D65). Colours that no screen can show have a negative component.
inline glm::dvec3 xyz_to_linear_srgb(glm::dvec3 xyz) {
    return {3.2409699 * xyz.x - 1.5373832 * xyz.y - 0.4986108 * xyz.z,
            -0.9692436 * xyz.x + 1.8759675 * xyz.y + 0.0415551 * xyz.z,
            0.0556301 * xyz.x - 0.2039770 * xyz.y + 1.0569715 * xyz.z};
}
inline glm::dvec3 chromaticity_to_linear_srgb(glm::dvec2 xy) {  // of luminance 1
    return xyz_to_linear_srgb(glm::dvec3(xy.x, xy.y, 1 - xy.x - xy.y) / xy.y);
}
//! [to_linear_srgb]

/// Luminance of linear sRGB.
inline double luminance(glm::dvec3 rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

//! [ramp]
/// The luminance of this temperature counts as 1: the hot body of a candle flame.
constexpr double kReferenceTemperature_K = 1900;
constexpr float kRampLow_K = 1000, kRampHigh_K = 2600;

/// A black body of one temperature: its colour at luminance 1, and the natural logarithm of its luminance in
/// units of that at kReferenceTemperature_K. Logarithm, since from 1000 to 2000 K it grows 170,000-fold.
inline glm::vec4 blackbody_ramp(double temperature_K) {
    const glm::dvec3 xyz = blackbody_xyz(temperature_K);
    // Below 1900 K blue is negative: redder than any screen. Cut it off, and keep the luminance.
    glm::dvec3 rgb = glm::max(xyz_to_linear_srgb(xyz / xyz.y), glm::dvec3(0));
    rgb /= luminance(rgb);
    return glm::vec4(rgb, std::log(xyz.y / blackbody_xyz(kReferenceTemperature_K).y));
}

/// `size` temperatures, evenly from kRampLow_K to kRampHigh_K: what the shaders read as a texture.
inline std::vector<glm::vec4> blackbody_ramp_table(int size) {
    std::vector<glm::vec4> table;
    for (int k = 0; k < size; ++k)
        table.push_back(blackbody_ramp(kRampLow_K + (kRampHigh_K - kRampLow_K) * k / (size - 1.0)));
    return table;
}
//! [ramp]

}  // namespace fire
