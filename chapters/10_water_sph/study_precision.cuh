/// @file
/// Study `precision`: the forces of one body of water at several distances from the origin, in float and in
/// double.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "10_water_sph/sph_cpu.h"
#include "10_water_sph/study_water.cuh"

namespace sph {

/// Shaken water in a closed box at the origin, and the same moved away along all three axes: exactly the same
/// forces, if numbers had no end.
struct MovedWater {
    LatticeBox lattice;
    Fluid fluid = lattice_fluid(2);
    Points<double> at_origin;

    explicit MovedWater(int per_edge) : lattice(lattice_box(per_edge, per_edge, per_edge)) {
        // Shaken by float jitters, then by a part of them in double: places that need all digits of a double.
        shake(lattice.position, 0.2f * kLatticeSpacing);
        for (const glm::dvec3& x : points_of(lattice.position))
            at_origin.push_back(x * (1 - 1 / (300 * kPi)));
    }
    Box box_at(double distance_m) const {
        const float d = float(distance_m), edge = lattice.box.high_m.x;
        return {{d, d, d}, {d + edge, d + edge, d + edge}};
    }
    template <class T>
    Points<T> at(double distance_m) const {
        Points<T> points;
        for (const glm::dvec3& x : at_origin) points.push_back(glm::vec<3, T>(x + distance_m));
        return points;
    }
};

/// Acceleration of each particle, all pairs, computed in T throughout.
template <class T>
Points<double> acceleration_in(const MovedWater& water, const Points<T>& position, double distance_m) {
    const Box box = water.box_at(distance_m);
    const Points<T> velocity(position.size(), glm::vec<3, T>(0));
    Points<double> result;
    for (const auto& a : acceleration_cpu<EquationOfState::linear>(
             position, velocity, density_cpu(position, water.fluid, box), water.fluid, box))
        result.push_back(glm::dvec3(a));
    return result;
}

inline double relative_rms(const Points<double>& found, const Points<double>& exact) {
    double sum = 0, norm = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double error = distance(found[i] - exact[i]), size = distance(exact[i]);
        sum += error * error;
        norm += size * size;
    }
    return std::sqrt(sum / norm);
}

/// The accelerations of the float kernels, by particle.
inline Points<double> acceleration_of_kernels(const MovedWater& water, double distance_m) {
    std::vector<float4> position;
    for (const glm::vec3& x : water.at<float>(distance_m)) position.push_back(make_float4(x.x, x.y, x.z, 0));
    const Water kernels(water.fluid, water.box_at(distance_m), EquationOfState::linear, position,
                        at_rest(position.size()));
    return points_of(by_id(kernels, kernels.accelerations()));
}

inline void study_precision(course::Study& study) {
    course::on_device(study);
    const MovedWater water(study.quick ? 6 : 8);
    const auto in_double = water.at<double>(1);
    const auto in_float = water.at<float>(1);
    std::vector<Water> kernels;
    kernels.emplace_back(water.fluid, water.box_at(0), EquationOfState::linear, water.lattice.position,
                         at_rest(in_float.size()));
    const int repeats = study.quick ? 5 : 9;
    const auto all_pairs = time_in_turn(repeats, {[&] { acceleration_in(water, in_double, 1); },
                                                  [&] { acceleration_in(water, in_float, 1); }});
    const course::Timing grid = time_steps(kernels, repeats)[0];

    const Points<double> exact = acceleration_in<double>(water, water.at_origin, 0);
    const std::vector<double> distances_m{1, 10, 100, 1e3, 1e4};  // sums cost the same at all of them
    const auto add = [&](const char* method, double distance_m, const Points<double>& found,
                         const course::Timing& timing) {
        study.add({method, distance_m, double(exact.size()), relative_rms(found, exact), timing, 1});
    };
    for (const double d : distances_m)
        add("double, all pairs", d, acceleration_in(water, water.at<double>(d), d), all_pairs[0]);
    for (const double d : distances_m)
        add("float, all pairs", d, acceleration_in(water, water.at<float>(d), d), all_pairs[1]);
    for (const double d : distances_m)
        if (coordinate_resolution_m(float(d + 1)) <= kCoarsestCoordinate * water.fluid.support_m)
            add("float, kernels with grid", d, acceleration_of_kernels(water, d), grid);
}

}  // namespace sph
