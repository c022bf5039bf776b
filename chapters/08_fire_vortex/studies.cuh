/// @file
/// The studies of this chapter: what the far field costs and is worth, and how large a time step may be.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "08_fire_vortex/vortex_cpu.h"
#include "08_fire_vortex/vortons.cuh"
#include "common/gpu_timer.h"
#include "common/program.h"
#include "common/study.h"

namespace vortex {

//! [plume]
/// Vortons as a fire has them: rings round a plume that widens as it rises, each pushed off its place and
/// tilted at random. Their far fields add up instead of cancelling: that is what makes a plume rise.
struct Plume {
    std::vector<float4> position, strength;
    float core_m, cell_m;
};
inline Plume make_plume(std::uint32_t n, std::uint64_t seed) {
    Plume plume;
    constexpr float kHeight_m = 2, kRadius_m = 0.25f, kWidens = 0.3f, kCirculation_m_per_s = 2;
    for (std::uint32_t i = 0; i < n; ++i) {
        const particle_loop::Uniforms r = particle_loop::random_start(seed, i, 0);
        const float y = kHeight_m * r.u[0], angle = 6.2831853f * r.u[1];
        const float radius = (kRadius_m + kWidens * y) * (1 + 0.6f * (r.u[2] + r.u[3] - 1));
        const glm::vec3 out(std::cos(angle), 0, std::sin(angle));
        const glm::vec3 x = radius * out + glm::vec3(0, y, 0);
        // Circulation per height, shared by all vortons of the same height: alpha = Gamma dl.
        const float size = kCirculation_m_per_s * 6.2831853f * radius * kHeight_m / float(n);
        const glm::vec3 tilt(2 * r.u[4] - 1, 2 * r.u[5] - 1, 2 * r.u[6] - 1);
        const glm::vec3 alpha = size * (glm::cross(out, glm::vec3(0, 1, 0)) + 0.7f * tilt);
        plume.position.push_back(make_float4(x.x, x.y, x.z, 1));
        plume.strength.push_back(make_float4(-alpha.x, -alpha.y, -alpha.z, 0));
    }
    // Four vortons to a cell, were they all in a column of 1.1 m by 1.1 m; most of them are.
    const float volume_m3 = 2 * 1.1f * 1.1f;
    plume.cell_m = std::cbrt(4 * volume_m3 / float(n));
    plume.core_m = 0.8f * plume.cell_m;
    return plume;
}
//! [plume]

/// The velocities at some cells, by the sum over all vortons in double.
struct Truth {
    std::vector<std::uint32_t> cell;
    std::vector<glm::dvec3> velocity;
    double mean_square = 0;
};
inline Truth find_truth(const Plume& plume, const CellGrid& cells, std::uint32_t samples) {
    Truth truth;
    samples = std::min(samples, cells.cell_count());
    for (std::uint32_t k = 0; k < samples; ++k) {
        // Every so many cells, with a step that is no multiple of a row.
        const std::uint32_t c = std::uint32_t((std::uint64_t(k) * 2654435761u) % cells.cell_count());
        const glm::dvec3 u(field_at_cpu(plume.position, plume.strength,
                                        glm::dvec3(centre_m(cells, cell_at(cells.size, c))), plume.core_m));
        truth.cell.push_back(c);
        truth.velocity.push_back(u);
        truth.mean_square += glm::dot(u, u) / samples;
    }
    return truth;
}

/// Root mean square of the error at those cells, relative to that of the velocity.
inline double error_against(const Truth& truth, const std::vector<float4>& field) {
    double sum = 0;
    for (std::size_t k = 0; k < truth.cell.size(); ++k) {
        const glm::dvec3 wrong = glm::dvec3(xyz(field[truth.cell[k]])) - truth.velocity[k];
        sum += glm::dot(wrong, wrong) / double(truth.cell.size());
    }
    return std::sqrt(sum / truth.mean_square);
}

/// A way to make the velocity grid, as the study names it.
struct FarMethod {
    std::string name;
    FarField far_field;
};

//! [measure_far_field]
/// One point: the time of a whole velocity grid, from vortons in any order to velocities, and its error.
/// The direct sum over many cells takes minutes; then a slab of the grid is timed, and the time scaled.
inline void add_far_field_point(course::Study& study, const Plume& plume, const CellGrid& cells,
                                const Truth& truth, const FarMethod& method, double value) {
    const std::uint32_t n = std::uint32_t(plume.position.size());
    const course::DeviceBuffer<float4> position(plume.position), strength(plume.strength);
    VelocityGrid velocity(n, cells.cell_count(), method.far_field);
    double pairs = double(n) * cells.cell_count(), scale = 1;
    CellGrid timed = cells;
    const double most_pairs = study.quick ? 1e8 : 4e8;
    if (method.far_field.far == Far::direct && pairs > most_pairs) {
        timed.size.z = std::max(1, int(cells.size.z * most_pairs / pairs));
        scale = double(cells.size.z) / timed.size.z;
    }
    const auto build = [&] {
        velocity.build(position.data(), strength.data(), n, timed, plume.core_m);
        CUDA_CHECK(cudaDeviceSynchronize());
    };
    const course::Timing timing = course::time_work(study.quick ? 3 : 5, build).per(1 / scale);
    // Of a slab, only those samples that lie in it count: cells are numbered z last, so it begins the grid.
    Truth seen = truth;
    if (scale > 1) {
        seen.cell.clear(), seen.velocity.clear();
        for (std::size_t k = 0; k < truth.cell.size(); ++k)
            if (truth.cell[k] < timed.cell_count()) {
                seen.cell.push_back(truth.cell[k]);
                seen.velocity.push_back(truth.velocity[k]);
            }
    }
    study.add({method.name, value, double(n), error_against(seen, velocity.download()), timing, 1});
}
//! [measure_far_field]

inline CellGrid plume_grid(const Plume& plume) {
    return fire_grid(grid::bounds_cpu(plume.position), plume.cell_m, 1u << 20);
}

/// Error against time at one number of vortons: the reach is what a method's points differ in.
inline void study_far_field(course::Study& study) {
    course::on_device(study);
    const std::uint32_t n = study.quick ? 4096 : 16384;
    const Plume plume = make_plume(n, 3);
    const CellGrid cells = plume_grid(plume);
    const Truth truth = find_truth(plume, cells, study.quick ? 300 : 1000);
    const std::vector<int> cut = study.quick ? std::vector<int>{1, 3, 6}
                                             : std::vector<int>{1, 2, 3, 4, 6, 8, 12},
                           kept = study.quick ? std::vector<int>{1, 2, 3} : std::vector<int>{1, 2, 3, 4, 6};
    study.expect(int(cut.size() + 2 * kept.size()) + 1);
    for (const int reach : cut)
        add_far_field_point(study, plume, cells, truth, {"far field dropped", {Far::dropped, reach}}, reach);
    for (const int reach : kept)
        add_far_field_point(study, plume, cells, truth, {"far cells as one vorton", {Far::cells, reach}},
                            reach);
    for (const int reach : kept)
        add_far_field_point(study, plume, cells, truth, {"pyramid of cells", {Far::pyramid, reach}}, reach);
    add_far_field_point(study, plume, cells, truth, {"direct sum", {Far::direct, 1}}, cells.size.y);
}

/// The same against the number of vortons: who wins where?
inline void study_far_field_size(course::Study& study) {
    course::on_device(study);
    const std::vector<int> exponents =
        study.quick ? std::vector<int>{10, 12, 14} : std::vector<int>{10, 11, 12, 13, 14, 15, 16, 17};
    const std::vector<FarMethod> methods{{"far field dropped, reach 1", {Far::dropped, 1}},
                                         {"far field dropped, reach 4", {Far::dropped, 4}},
                                         {"far cells as one vorton", {Far::cells, 1}},
                                         {"pyramid of cells", {Far::pyramid, 1}},
                                         {"direct sum", {Far::direct, 1}}};
    constexpr int kLastExponentOfCells = 15;
    study.expect(int(exponents.size() * methods.size()) -
                 std::max(0, exponents.back() - kLastExponentOfCells));
    for (const int exponent : exponents) {
        const Plume plume = make_plume(1u << exponent, 3);
        const CellGrid cells = plume_grid(plume);
        const Truth truth = find_truth(plume, cells, study.quick ? 200 : 400);
        for (const FarMethod& method : methods) {
            // Cells times cells: four minutes at 2^17. The line is long enough to be continued by eye.
            if (method.far_field.far == Far::cells && exponent > kLastExponentOfCells) continue;
            add_far_field_point(study, plume, cells, truth, method, double(1u << exponent));
        }
    }
}

// ------------------------------------------------------------------------------------------ the time step

//! [pair]
constexpr float kPairCore_m = 0.4f;

/// Turn rate of two vortons 1 m apart whose cores turn at that rate: each goes with alpha q / (4 pi d^2) on a
/// circle of radius d / 2.
inline double pair_turn_rad_per_s(double core_turn_rad_per_s_) {
    const double alpha = core_turn_rad_per_s_ / core_turn_rad_per_s(1, kPairCore_m);
    return alpha * WinckelmansLeonard::q_over_r3(1.0, double(kPairCore_m) * kPairCore_m) / (2 * kPi);
}

/// Two vortons that go round each other, on a grid fine enough that the time step is all that matters.
/// @returns their distance after `turns` turns over that at the start; infinite if it is no number
inline double pair_growth(double core_turn, double turns, double dt_s, Stepping stepping) {
    const float alpha = float(core_turn / core_turn_rad_per_s(1, kPairCore_m));
    VelocityGrid velocity(2, 4500, {Far::direct, 1});
    course::DeviceBuffer<float4> position({make_float4(-0.5f, 0, 0, 1), make_float4(0.5f, 0, 0, 1)}),
        strength({make_float4(0, 0, alpha, 0), make_float4(0, 0, alpha, 0)}), halfway_x(2), halfway_a(2);
    VortonPhysics physics;
    physics.core_m = kPairCore_m;
    physics.stretching = physics.baroclinic = false;
    physics.decay_time_s = physics.cooling_time_s = 1e30f;
    physics.max_turn_rad_per_s = 1e30f;
    const int steps = std::max(1, int(std::lround(turns * 2 * kPi / pair_turn_rad_per_s(core_turn) / dt_s)));
    Surroundings around;
    // Flat, since nothing moves along z. Cells of a fifth of a core: with half a core, what a vorton reads of
    // its own field between the cells' centres is not nought any longer, and as large as its partner's.
    around.cells = {glm::vec3(-1.2f, -1.2f, -0.2f), 12.5f, glm::ivec3(30, 30, 5)};
    for (int k = 0; k < steps; ++k)
        step_vortons(velocity, {position.data(), strength.data()}, {halfway_x.data(), halfway_a.data()}, 2,
                     around, physics, stepping, float(dt_s));
    const std::vector<float4> end = position.download();
    const double distance = glm::length(glm::dvec3(xyz(end[0])) - glm::dvec3(xyz(end[1])));
    return std::isfinite(distance) ? distance : INFINITY;
}
//! [pair]

//! [pair_limit]
/// The limit by theory, for a pair that may come apart or together by `growth` (1.1: 10 %) during its turns.
///
/// With w the pair's turn rate, Euler's method takes each vorton along the tangent: the distance grows by
/// sqrt(1 + (w dt)^2) a step. And w falls as d^-3, so d^6 = 1 + 3 w0^2 dt t. The midpoint method errs by only
/// (w dt)^4 / 16 a step, inwards: d^12 = 1 - (3/4) w0^4 dt^3 t.
inline double pair_limit_s(Stepping stepping, double turn_rad_per_s, double turns, double growth) {
    const double w_dt = stepping == Stepping::euler
                            ? (std::pow(growth, 6) - 1) / (6 * kPi * turns)
                            : std::cbrt((1 - std::pow(growth, -12)) / (1.5 * kPi * turns));
    return w_dt / turn_rad_per_s;
}
//! [pair_limit]

inline void map_vortons(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<double> turns =
        map.quick ? std::vector<double>{3, 300} : std::vector<double>{1, 10, 100, 1000};
    map.expect(int(2 * turns.size()));
    for (const Stepping stepping : {Stepping::euler, Stepping::midpoint})
        for (const double core_turn : turns) {
            const double limit = pair_limit_s(stepping, pair_turn_rad_per_s(core_turn), 1, 1.1);
            map.column(stepping == Stepping::euler ? "Euler" : "midpoint", core_turn, limit,
                       {0.25, 0.5, 0.8, 1.25, 2, 4, 8}, map.quick ? 2 : 4, [&](double dt_s) {
                           const double growth = pair_growth(core_turn, 1, dt_s, stepping);
                           return growth < 1.1 && growth > 1 / 1.1;
                       });
        }
}

inline void declare_studies(course::Program& program) {
    program.study(
        course::StudyQuestion{"far_field", "Which sum gives a plume's velocity grid at what error and cost?",
                              "root mean square velocity error at the cells, relative, against the sum "
                              "over all vortons in double",
                              "reach_in_cells"},
        study_far_field);
    program.study(
        course::StudyQuestion{"far_field_size", "From how many vortons on does which sum pay?",
                              "root mean square velocity error at the cells, relative, against the sum "
                              "over all vortons in double",
                              "n", course::StudyPlot::time_against_value},
        study_far_field_size);
    program.stability(
        course::StabilityQuestion{"vortons", "How long may a step of strong vortons be?",
                                  "after one turn two vortons are still within 10 % of their distance",
                                  "growth per step of a pair: Euler's (w dt)^2 / 2 outwards, the midpoint "
                                  "method's (w dt)^4 / 16 inwards",
                                  "turn of a core (rad/s)"},
        map_vortons);
}

}  // namespace vortex
