/// @file
/// Heaps of marbles whose stiffest wave is known: they tell where the limit of the step is.
#pragma once
#include <random>
#include <vector>

#include "09_water_spring_mass/diagnostics.cuh"

namespace spring_mass {

//! [packed]
/// Marbles at rest at a distance where push and pull are equal, so that a packing holds together with no
/// walls and no load: a lattice of springs k + a, on which 1 m is the distance of neighbours.
struct Lattice {
    MaterialOf<double> material;
    std::vector<glm::dvec3> position;
};

inline Lattice packed(Packing packing, double stiffness_N_per_m = 100) {
    Lattice lattice;
    // k d = (k + a) 1 m. Friction without bound: tangential dashpots always act.
    lattice.material = {1.02, 1, stiffness_N_per_m, 0, 0, 1e6, 0.02 * stiffness_N_per_m, 0, {0, 0, 0}};
    const auto add = [&](double x, double y, double z) { lattice.position.push_back({x, y, z}); };
    const double s = std::sqrt(0.5);
    switch (packing) {
        case Packing::pair:
            for (int i = 0; i < 2; ++i) add(i, 0, 0);
            break;
        case Packing::chain:
            for (int i = 0; i < 60; ++i) add(i, 0, 0);
            break;
        case Packing::cubic:
            for (int i = 0; i < 14 * 14 * 14; ++i) add(i % 14, i / 14 % 14, i / 196);
            break;
        case Packing::fcc:  // every second point of a finer cubic lattice
            for (int i = 0; i < 18 * 18 * 18; ++i)
                if ((i % 18 + i / 18 % 18 + i / 324) % 2 == 0)
                    add(s * (i % 18), s * (i / 18 % 18), s * (i / 324));
            break;
    }
    return lattice;
}
//! [packed]

inline Material in_float(const MaterialOf<double>& m) {
    return {float(m.diameter_m),
            float(m.mass_kg),
            float(m.stiffness_N_per_m),
            float(m.normal_damping_per_s),
            float(m.tangential_damping_per_s),
            float(m.friction),
            float(m.attraction_N_per_m),
            float(m.drag_per_s),
            glm::vec3(m.gravity_m_per_s2)};
}

//! [stays_small]
/// A small shake, then steps of the kernels: does it stay small?
inline bool stays_small(const Lattice& lattice, double dt_s, int steps) {
    constexpr double kShake_m = 1e-4;
    std::mt19937 random(2);
    std::uniform_real_distribution<double> shake(-kShake_m, kShake_m);
    std::vector<float4> position;
    for (const glm::dvec3& p : lattice.position)
        position.push_back(make_float4(float(p.x + shake(random)), float(p.y + shake(random)),
                                       float(p.z + shake(random)), 0));
    Marbles marbles(in_float(lattice.material), {{-30, -30, -30}, {90, 90, 90}}, position,
                    std::vector<float4>(position.size(), make_float4(0, 0, 0, 0)));
    for (int step = 0; step < steps; ++step) marbles.step(float(dt_s));
    const std::vector<float4> x = by_id(marbles, marbles.positions());
    for (std::size_t i = 0; i < x.size(); ++i)
        // 30 times the shake: near its limit leapfrog swings 1 / sqrt(1 - 0.99^2) = 7 times as far.
        if (!(glm::length(glm::dvec3(grid::xyz(x[i])) - lattice.position[i]) < 30 * kShake_m)) return false;
    return true;
}
//! [stays_small]

}  // namespace spring_mass
