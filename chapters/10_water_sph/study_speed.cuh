/// @file
/// Study `speed`: particle-steps per second of the whole step, with the passes as they are and as one writes
/// them first, at about 30 and about 70 neighbours. Beside the clock it prints processor time, which hardly
/// depends on what else the machine does.
#pragma once
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "05_spatial_grid/neighbours.cuh"
#include "10_water_sph/passes_by_row.cuh"
#include "10_water_sph/run.cuh"
#include "10_water_sph/sph_cpu.h"
#include "10_water_sph/study_water.cuh"

namespace sph {

constexpr const char* kPassVariants[] = {"rows of float4", "rows of columns", "whole vectors"};

/// One step with the passes of a variant in place of the water's own.
inline void step_by(std::string_view variant, Water& water, float dt_s) {
    const std::uint32_t blocks = grid::blocks_for(water.size(), 128);
    const auto passes_on = [&](std::string_view name, auto vectors_of) {
        const WaterArrays now = water.arrays();  // sorting has swapped arrays
        if (name == "density")
            density_by_row_kernel<<<blocks, 128>>>(now.density, now.pressure_term, vectors_of(now).first,
                                                   now.ranges, now.cells, water.fluid(), water.box(), now.n);
        else
            force_by_row_kernel<<<blocks, 128>>>(now.acceleration, vectors_of(now).first,
                                                 vectors_of(now).second, now.density, now.pressure_term,
                                                 now.ranges, now.cells, water.fluid(), water.box(), now.n);
        CUDA_CHECK(cudaGetLastError());
    };
    const auto float4s = [](const WaterArrays& w) {
        return std::pair(Float4s(w.position), Float4s(w.velocity));
    };
    const auto columns = [](const WaterArrays& w) {
        return std::pair(w.position_columns, w.velocity_columns);
    };
    water.step(dt_s, NoGuest(), [&](std::string_view name, auto pass) {
        if (variant == kPassVariants[2] || (name != "density" && name != "forces"))
            pass();
        else if (variant == kPassVariants[0])
            passes_on(name, float4s);
        else
            passes_on(name, columns);
    });
}

/// Neighbours within the support, mean over all particles; images in the walls not counted.
inline double mean_neighbours(Water& water) {
    const WaterArrays a = water.arrays();
    course::DeviceBuffer<std::uint32_t> count(a.n);
    grid::neighbours_coherent_kernel<<<grid::blocks_for(a.n, 128), 128>>>(
        count.data(), a.position, a.ranges, a.cells, water.fluid().support_m, a.n);
    CUDA_CHECK(cudaGetLastError());
    double sum = 0;
    for (const std::uint32_t c : count.download()) sum += c;
    return sum / a.n;
}

/// Accelerations of some 300 particles far from the walls against the same sums in double: rms difference
/// over rms size.
inline double acceleration_error(const Water& water) {
    const Fluid& fluid = water.fluid();
    const Box& box = water.box();
    const Points<double> x = points_of(water.positions().download()),
                         v = points_of(water.velocities().download()),
                         a = points_of(water.accelerations().download());
    const double h = fluid.support_m, m = fluid.mass_kg;
    const auto far_from_walls = [&](const glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] - (&box.low_m.x)[axis] < 2 * h || (&box.high_m.x)[axis] - p[axis] < 2 * h)
                return false;
        return true;
    };
    const auto around = [&](const glm::dvec3& centre, const std::vector<std::size_t>& candidates,
                            double reach) {
        std::vector<std::size_t> found;
        for (const std::size_t j : candidates)
            if (distance(x[j] - centre) < reach) found.push_back(j);
        return found;
    };
    std::vector<std::size_t> all(x.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    const double rho0 = fluid.rest_density_kg_per_m3, nu = fluid.viscosity_m2_per_s;
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); i += x.size() / 300) {
        if (!far_from_walls(x[i])) continue;
        const std::vector<std::size_t> candidates = around(x[i], all, 2 * h);
        const auto density_of = [&](std::size_t j) {
            double sum = 0;
            for (const std::size_t k : candidates) {
                const double q = distance(x[j] - x[k]) / h;
                sum += poly6(q * q);
            }
            return m * sum / (h * h * h);
        };
        const auto term_of = [&](double rho) {
            return pressure_of<EquationOfState::linear>(fluid, rho) / (rho * rho);
        };
        const double rho_i = density_of(i);
        const float3 g = fluid.gravity_m_per_s2;
        glm::dvec3 exact(g.x, g.y, g.z);
        for (const std::size_t j : around(x[i], candidates, h)) {
            if (j == i) continue;
            const glm::dvec3 d = x[i] - x[j];
            const double r = distance(d), q = r / h, rho_j = density_of(j);
            exact += m * (term_of(rho_i) + term_of(rho_j)) * spiky_slope(q) / (h * h * h * h) * (d / r);
            exact += nu * rho0 * m / (rho_i * rho_j) * viscosity_laplacian(q) / (h * h * h * h * h) *
                     (v[j] - v[i]);
        }
        const double off = distance(a[i] - exact);
        difference += off * off;
        size += distance(exact) * distance(exact);
    }
    return std::sqrt(difference / size);
}

/// The dam break of so many particles, 100 steps after its start.
inline Start moving_water(std::uint32_t particles, float support_in_spacings) {
    Settings settings;
    settings.scene = find_scene(all_scenes(), "dam_break");
    settings.particles = particles;
    settings.choice.support_in_spacings = support_in_spacings;
    Start start = make_start(settings);
    for (int step = 0; step < 100; ++step) start.water.step(start.dt_s);
    return start;
}

inline void study_speed(course::Study& study) {
    course::on_device(study);
    const std::vector<std::uint32_t> sizes = study.quick
                                                 ? std::vector<std::uint32_t>{1u << 12, 1u << 14}
                                                 : std::vector<std::uint32_t>{1u << 14, 1u << 16, 1u << 17};
    study.expect(int(2 * 3 * sizes.size()));
    for (const float support : {2.0f, 2.6f})
        for (const std::uint32_t n : sizes) {
            Start start = moving_water(n, support);
            const int steps = std::max(2, int((study.quick ? 1u << 16 : 1u << 17) / n));
            std::fflush(stdout);  // what is measured so far is not lost if the rest takes too long
            std::vector<std::function<void()>> works;
            std::vector<std::vector<double>> processor_s(std::size(kPassVariants));
            for (std::size_t k = 0; k < std::size(kPassVariants); ++k)
                works.push_back([&, k] {
                    const std::clock_t before = std::clock();
                    for (int step = 0; step < steps; ++step)
                        step_by(kPassVariants[k], start.water, start.dt_s);
                    CUDA_CHECK(cudaDeviceSynchronize());
                    processor_s[k].push_back(double(std::clock() - before) / CLOCKS_PER_SEC);
                });
            const std::vector<course::Timing> timing = time_in_turn(study.quick ? 3 : 9, works);
            std::printf("%u particles, %.1f neighbours in the support; million particle-steps per second:\n",
                        n, mean_neighbours(start.water));
            for (std::size_t k = 0; k < works.size(); ++k) {
                step_by(kPassVariants[k], start.water, 0);
                const course::Timing step = timing[k].per(steps);
                const double processor_ns = 1e9 * course::timing_of(processor_s[k]).per(steps).median_s / n;
                std::printf("  %-16s %5.2f (quartiles %.2f to %.2f); %.0f ns of processor time each\n",
                            kPassVariants[k], 1e-6 * n / step.median_s, 1e-6 * n / step.high_s,
                            1e-6 * n / step.low_s, processor_ns);
                study.add(
                    {(support < 2.5f ? "30 neighbours, " : "70 neighbours, ") + std::string(kPassVariants[k]),
                     double(n), double(n), acceleration_error(start.water), step});
            }
        }
}

}  // namespace sph
