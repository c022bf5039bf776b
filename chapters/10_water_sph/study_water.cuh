/// @file
/// What the measurements of this chapter share: water without an edge, and the time of a step.
#pragma once
#include <Random123/philox.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "10_water_sph/diagnostics.cuh"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace sph {

//! [lattice_box]
/// A closed box filled by a cubic lattice. Its walls are mirrors half a spacing away, so each particle sees
/// what it would see in a lattice without end, and the true density is known: all mass by all volume.
struct LatticeBox {
    std::vector<float4> position;
    Box box;
};

constexpr float kLatticeSpacing = 1.0f / 64;  // m; a power of two: places on the lattice are exact in fp32

inline LatticeBox lattice_box(int nx, int ny, int nz, float spacing_m = kLatticeSpacing) {
    LatticeBox lattice{{}, {{0, 0, 0}, {nx * spacing_m, ny * spacing_m, nz * spacing_m}}};
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x)
                lattice.position.push_back(
                    make_float4((x + 0.5f) * spacing_m, (y + 0.5f) * spacing_m, (z + 0.5f) * spacing_m, 0));
    return lattice;
}
//! [lattice_box]

/// Water that has no pressure on that lattice, no weight, and may be pulled as well as pushed.
inline Fluid lattice_fluid(float support_in_spacings) {
    Fluid fluid;
    fluid.support_m = support_in_spacings * kLatticeSpacing;
    fluid.mass_kg = float(double(fluid.rest_density_kg_per_m3) * kLatticeSpacing * kLatticeSpacing *
                          kLatticeSpacing / lattice_density(support_in_spacings));
    fluid.gravity_m_per_s2 = {0, 0, 0};
    fluid.lowest_pressure_Pa = -1e30f;
    return fluid;
}

/// Moves each particle by up to `distance_m` along each axis, at random and the same way in each run.
inline void shake(std::vector<float4>& position, float distance_m) {
    for (std::uint32_t i = 0; i < position.size(); ++i) {
        const auto random = r123::Philox4x32()({{i, 0, 0, 0}}, {{1, 0}});
        const auto moved = [&](float x, std::uint32_t bits) {
            return x + distance_m * (bits * 0x1p-31f - 1.0f);
        };
        position[i] = make_float4(moved(position[i].x, random[0]), moved(position[i].y, random[1]),
                                  moved(position[i].z, random[2]), 0);
    }
}

inline std::vector<float4> at_rest(std::size_t n) {
    return std::vector<float4>(n, make_float4(0, 0, 0, 0));
}

//! [time_in_turn]
/// Seconds of each of several works, measured in turn: a machine that is busy for a while slows all of them
/// alike.
inline std::vector<course::Timing> time_in_turn(int repeats,
                                                const std::vector<std::function<void()>>& works) {
    std::vector<std::vector<double>> seconds(works.size());
    for (int k = 0; k <= repeats; ++k)  // the first round warms up
        for (std::size_t w = 0; w < works.size(); ++w) {
            const auto start = std::chrono::steady_clock::now();
            works[w]();
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
            if (k > 0) seconds[w].push_back(taken.count());
        }
    std::vector<course::Timing> timings;
    for (const auto& of_one : seconds) timings.push_back(course::timing_of(of_one));
    return timings;
}
//! [time_in_turn]

/// Seconds of one step of each water. Steps of 0 s move nothing and compute everything.
inline std::vector<course::Timing> time_steps(std::vector<Water>& waters, int repeats) {
    std::vector<std::function<void()>> works;
    std::vector<int> steps;
    for (Water& water : waters) {
        steps.push_back(std::max(1, 20000 / int(water.size())));  // some milliseconds at least
        works.push_back([&water, count = steps.back()] {
            for (int step = 0; step < count; ++step) water.step(0);
            CUDA_CHECK(cudaDeviceSynchronize());
        });
    }
    std::vector<course::Timing> timings = time_in_turn(repeats, works);
    for (std::size_t k = 0; k < timings.size(); ++k) timings[k] = timings[k].per(steps[k]);
    return timings;
}

}  // namespace sph
