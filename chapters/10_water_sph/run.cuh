/// @file
/// One run of this chapter's program without its pictures: settings, start, steps, what they cost, what they
/// leave out.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "10_water_sph/pbf_diagnostics.cuh"
#include "10_water_sph/scene.cuh"

namespace sph {

enum class Drawing { none, points, spheres };

/// Where pressure comes from: an equation of state, or position based fluids.
enum class Pressure { state, pbf };

/// Everything that a run depends on.
struct Settings {
    Scene scene;
    FluidChoice choice;
    Pressure pressure = Pressure::state;
    EquationOfState state = EquationOfState::linear;  ///< not asked with Pressure::pbf
    PbfChoice pbf;                                    ///< not asked with Pressure::state
    std::uint32_t particles = 16384;
    float dt_s = 0;  ///< 0: the largest that time_step_limit or pbf_step_limit_s allows
    std::uint64_t seed = 1;
    Drawing drawing = Drawing::spheres;
};

/// The water at its start, and the step it is to be moved by. AnyWater: Water or PbfWater.
template <class AnyWater>
struct StartOf {
    AnyWater water;
    float spacing_m, dt_s;
};
using Start = StartOf<Water>;
using PbfStart = StartOf<PbfWater>;

inline Start make_start(const Settings& settings) {
    float spacing_m = 0;
    const std::vector<float4> position =
        fill_block(settings.scene, settings.particles, settings.seed, spacing_m);
    const Fluid fluid = make_fluid(settings.scene, spacing_m, settings.choice);
    const float dt_s = settings.dt_s > 0 ? settings.dt_s : time_step_limit(fluid).smallest_s();
    return {Water(fluid, settings.scene.tank, settings.state, position,
                  std::vector<float4>(settings.particles, make_float4(0, 0, 0, 0))),
            spacing_m, dt_s};
}

/// The same with position based fluids. Its step, which is the same during the whole run, is that of water as
/// fast as it runs out of a dam as high as the top of the block, 2 sqrt(g H).
inline PbfStart make_pbf_start(const Settings& settings) {
    float spacing_m = 0;
    const std::vector<float4> position =
        fill_block(settings.scene, settings.particles, settings.seed, spacing_m);
    const Fluid fluid = make_fluid(settings.scene, spacing_m, settings.choice);
    const float top_m =
        settings.scene.block_low_m.y + settings.scene.block_size_m.y - settings.scene.tank.low_m.y;
    const float dt_s = settings.dt_s > 0
                           ? settings.dt_s
                           : pbf_step_limit_s(fluid, settings.pbf.tolerance, 2 * std::sqrt(9.81f * top_m));
    return {PbfWater(fluid, settings.scene.tank, settings.pbf, position,
                     std::vector<float4>(settings.particles, make_float4(0, 0, 0, 0))),
            spacing_m, dt_s};
}

//! [launches]
/// Kernels of one step in their order, with how often each is launched. Tests hold it against what really
/// happens.
inline std::vector<std::pair<std::string, int>> launches_per_step(const Settings& settings,
                                                                  const Water& water) {
    const int levels = grid::ExclusiveScan::levels(water.cell_count() + 2);  // with the limbo and the end
    return {{"kick_drift_kernel", 1},
            {"count_kernel", 1},
            {"chunk_sums_kernel", levels},
            {"scan_chunks_kernel", levels},
            {"scatter_kernel", 1},
            {"sort_cells_kernel", 1},
            {"grid::gather_kernel", 3},
            {"grid::gather_columns_kernel", settings.choice.viscosity > 0 ? 2 : 1},
            {settings.state == EquationOfState::linear ? "density_kernel<EquationOfState::linear>"
                                                       : "density_kernel<EquationOfState::tait>",
             1},
            {settings.choice.viscosity > 0 ? "force_kernel<true>" : "force_kernel<false>", 1},
            {"kick_kernel", 1}};
}
//! [launches]

/// The same with position based fluids, for a step of so many corrections.
inline std::vector<std::pair<std::string, int>> pbf_launches_per_step(const Settings& settings,
                                                                      const PbfWater& water,
                                                                      int corrections) {
    const int levels = grid::ExclusiveScan::levels(water.cell_count() + 2);
    return {{"count_kernel", 1},
            {"chunk_sums_kernel", levels},
            {"scan_chunks_kernel", levels},
            {"scatter_kernel", 1},
            {"sort_cells_kernel", 1},
            {"grid::gather_columns_kernel", settings.choice.viscosity > 0 ? 2 : 1},
            {"grid::gather_kernel", 3},
            {settings.choice.viscosity > 0 ? "predict_kernel<true>" : "predict_kernel<false>", 1},
            {"constraint_kernel", corrections + 1},
            {"shift_kernel", corrections},
            {"reduce_shared_kernel", 2 * std::max(1, corrections)}};
}

/// What --explain says of the picture, whatever the water.
inline std::string explain_drawing(const Settings& settings) {
    std::string text = "left out: colour array (colour follows from speed, in the shader)\n";
    if (settings.drawing == Drawing::none)
        text += "left out: OpenGL, its context and all its objects, since nothing is drawn\n";
    if (settings.drawing == Drawing::points) text += "left out: surface buffer, shadow map, lighting\n";
    return text;
}

/// What --explain says of a step and of memory.
template <class AnyWater>
std::string explain_cost(const Settings& settings, const AnyWater& water,
                         const std::vector<std::pair<std::string, int>>& launches) {
    int total = 0;
    std::string passes;
    for (const auto& [name, count] : launches) {
        passes += (passes.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
        total += count;
    }
    std::string text = "each step: " + std::to_string(total) + " kernels: " + passes + "\n";
    text += "each particle: " + std::to_string(water.bytes_per_particle()) +
            " bytes of device memory; cells and the ends of columns: " + std::to_string(water.cell_bytes()) +
            " bytes in all\n";
    if (settings.drawing != Drawing::none)
        text += "each particle drawn: " + std::to_string(2 * sizeof(float4)) +
                " bytes in 2 OpenGL buffers, copied on the device for each picture\n";
    return text;
}

/// The answer to --explain.
inline std::string explain(const Settings& settings, const Start& start) {
    std::string text = explain_cost(settings, start.water, launches_per_step(settings, start.water));
    if (settings.choice.viscosity == 0)
        text +=
            "left out: the viscosity term (compiled out of force_kernel), and the columns of velocities\n";
    text += settings.state == EquationOfState::linear ? "left out: Tait's equation of state\n"
                                                      : "left out: the linear equation of state\n";
    text +=
        "left out: a pass for the bounds of the particles (the tank does not move, so neither does the "
        "grid)\n";
    return text + explain_drawing(settings);
}

/// The answer to --explain with --pressure pbf.
inline std::string explain(const Settings& settings, const PbfStart& start) {
    std::string text =
        explain_cost(settings, start.water, pbf_launches_per_step(settings, start.water, 1)) +
        "each further correction: 4 kernels: shift_kernel, constraint_kernel, reduce_shared_kernel x 2; at "
        "most " +
        std::to_string(settings.pbf.max_corrections) + " corrections a step, whose sums take " +
        std::to_string(start.water.summary_bytes()) + " bytes in all\n";
    if (settings.choice.viscosity == 0)
        text +=
            "left out: the viscosity term (compiled out of predict_kernel), and the columns of velocities\n";
    text += "left out: equations of state, and with them density_kernel, force_kernel and sound\n";
    text +=
        "left out: a pass for the bounds of the particles (the tank does not move, so neither does the "
        "grid)\n";
    return text + explain_drawing(settings);
}

using spring_mass::state_hash;

}  // namespace sph
