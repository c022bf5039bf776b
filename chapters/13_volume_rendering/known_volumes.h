/// @file
/// Volumes whose pictures are known: a slab, a Gaussian cloud, a ball. One colour, evaluated, not stored.
#pragma once
#include "13_volume_rendering/march.cuh"

namespace volume {

/// The same everywhere between two planes.
template <class Real>
struct Slab {
    static constexpr bool kSkips = false;
    Real extinction_per_m, emission, thickness_m;
    __host__ __device__ Matter<Real> at(glm::vec<3, Real>) const {
        return {extinction_per_m, glm::vec<3, Real>(emission)};
    }
    __host__ __device__ glm::vec<3, Real> low_m() const { return {-1, -1, 0}; }
    __host__ __device__ glm::vec<3, Real> high_m() const { return {1, 1, thickness_m}; }
};

/// Density exp(-r^2 / 2 s^2) around the origin, cut off at |z| = half_depth_m. It absorbs by it, and glows
/// with a Gaussian along z of its own width or, if that is 0, with a constant source function.
template <class Real>
struct GaussianCloud {
    static constexpr bool kSkips = false;
    Real extinction_per_m, width_m, source, emission = 0, emission_width_m = 0, half_depth_m = 1;
    __host__ __device__ Matter<Real> at(glm::vec<3, Real> x) const {
        const Real sigma = extinction_per_m * std::exp(-glm::dot(x, x) / (2 * width_m * width_m));
        if (emission_width_m > 0)
            return {sigma, glm::vec<3, Real>(
                               emission * std::exp(-x.z * x.z / (2 * emission_width_m * emission_width_m)))};
        return {sigma, glm::vec<3, Real>(sigma * source)};
    }
    __host__ __device__ glm::vec<3, Real> low_m() const { return {-1, -1, -half_depth_m}; }
    __host__ __device__ glm::vec<3, Real> high_m() const { return {1, 1, half_depth_m}; }
};

/// The same everywhere inside a ball of radius 1 m.
template <class Real>
struct Ball {
    static constexpr bool kSkips = false;
    Real extinction_per_m, emission;
    __host__ __device__ Matter<Real> at(glm::vec<3, Real> x) const {
        if (glm::dot(x, x) > 1) return {};
        return {extinction_per_m, glm::vec<3, Real>(emission)};
    }
    __host__ __device__ glm::vec<3, Real> low_m() const { return glm::vec<3, Real>(-1); }
    __host__ __device__ glm::vec<3, Real> high_m() const { return glm::vec<3, Real>(1); }
};

}  // namespace volume
