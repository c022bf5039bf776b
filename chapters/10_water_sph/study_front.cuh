/// @file
/// Study `front`: how fast water runs that a gate no longer holds, against a measurement of 1952.
#pragma once
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "10_water_sph/diagnostics.cuh"
#include "10_water_sph/scene.cuh"
#include "10_water_sph/study_water.cuh"

namespace sph {

//! [front]
/// When the front passed Z column widths from the far side of the column, at T = t sqrt(2 g / a): J. C.
/// Martin and W. J. Moyce, Phil. Trans. R. Soc. A 244 (1952), table 2, a column a = 2.25 inches wide and
/// twice as high. (Taken from the Ocellaris project, which gives the table; points that the PySPH project
/// read off the paper's figure agree.)
struct Passing {
    double width, time;
};
constexpr std::array<Passing, 15> kMartinMoyce{{{1.11, 0.41},
                                                {1.22, 0.84},
                                                {1.44, 1.19},
                                                {1.67, 1.43},
                                                {1.89, 1.63},
                                                {2.11, 1.83},
                                                {2.33, 1.98},
                                                {2.56, 2.20},
                                                {2.78, 2.32},
                                                {3.00, 2.51},
                                                {3.22, 2.65},
                                                {3.44, 2.83},
                                                {3.67, 2.98},
                                                {3.89, 3.11},
                                                {4.11, 3.33}}};

/// Their column as water: a sheet of it, periodic across.
inline Scene martin_moyce(int spacings_wide) {
    const float a = 2.25f * 0.0254f, thick = 2 * a / spacings_wide;
    return {"Martin and Moyce",
            {{0, 0, 0}, {6 * a, 3 * a, thick}, {Wall::slip, Wall::slip, Wall::periodic}},
            {0, 0, 0},
            {a, 2 * a, thick}};
}

/// When its front passed each of their marks, in their T.
struct FrontRun {
    std::vector<double> times;  ///< infinite for marks that it never reached
    int steps;
    Water water;  ///< at the end
};

inline FrontRun run_front(const Scene& scene, int spacings_wide) {
    float spacing_m = 0;
    const std::vector<float4> position = fill_block(scene, std::uint32_t(4 * spacings_wide * spacings_wide),
                                                    1, spacing_m);  // two layers, twice as high
    const Fluid fluid = make_fluid(scene, spacing_m);
    Water water(fluid, scene.tank, EquationOfState::linear, position, at_rest(position.size()));
    Summarizer summarize(water.size());
    const float dt_s = time_step_limit(fluid).smallest_s(), a = scene.block_size_m.x;
    const double T_per_step = dt_s * std::sqrt(2 * 9.81 / a);
    std::vector<double> times;
    double before = 0;
    int steps = 0;
    while (times.size() < kMartinMoyce.size() && steps * T_per_step < 10) {
        water.step(dt_s);
        ++steps;
        const double front = (summarize(water).front_m + 0.5 * spacing_m) / a;
        while (times.size() < kMartinMoyce.size() && front >= kMartinMoyce[times.size()].width) {
            const double part = (kMartinMoyce[times.size()].width - before) / (front - before);
            times.push_back((steps - 1 + part) * T_per_step);
        }
        before = front;
    }
    times.resize(kMartinMoyce.size(), INFINITY);
    return {times, steps, std::move(water)};
}

/// Column widths per T between two marks: the slope that no choice of t = 0 changes.
inline double front_speed(const std::vector<double>& times, std::size_t from = 5) {
    const std::size_t to = times.size() - 1;
    return (kMartinMoyce[to].width - kMartinMoyce[from].width) / (times[to] - times[from]);
}

inline std::vector<double> measured_times() {
    std::vector<double> times;
    for (const Passing& mark : kMartinMoyce) times.push_back(mark.time);
    return times;
}
//! [front]

inline void study_front(course::Study& study) {
    course::on_device(study);
    const std::vector<int> widths = study.quick ? std::vector<int>{6, 12} : std::vector<int>{10, 20, 40};
    study.expect(2 * int(widths.size()));
    const double measured = front_speed(measured_times());
    for (const Wall wall : {Wall::slip, Wall::no_slip})
        for (const int spacings : widths) {
            Scene scene = martin_moyce(spacings);
            scene.tank.wall[1] = wall;  // the floor
            FrontRun run = run_front(scene, spacings);
            std::vector<Water> waters;
            waters.push_back(std::move(run.water));
            study.add({wall == Wall::slip ? "a floor that slips" : "a floor that holds", double(spacings),
                       double(waters[0].size()), std::abs(front_speed(run.times) / measured - 1),
                       time_steps(waters, study.quick ? 3 : 5)[0], double(run.steps)});
        }
}

}  // namespace sph
