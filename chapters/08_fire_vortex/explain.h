/// @file
/// What a vortex fire computes in a step, and what it leaves out: the answer to --explain.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "08_fire_vortex/vortex_scene.cuh"

namespace vortex {

//! [launches]
/// Kernels of one step in their order, with how often each is launched. Tests hold it against what really
/// happens.
/// @param cells of the grid, along each axis
inline std::vector<std::pair<std::string, int>> launches_per_step(const VortexScene& scene,
                                                                  glm::ivec3 cells) {
    const VortexModel& m = scene.model;
    const int grids = m.stepping == Stepping::midpoint ? 2 : 1;  // the velocity grid is made so often
    std::vector<std::pair<std::string, int>> kernels{{"bounds_walk_kernel", 2}};
    if (m.far_field.far != Far::direct) {
        const std::uint32_t count = std::uint32_t(cells.x) * cells.y * cells.z;
        const int levels = grid::ExclusiveScan::levels(count + 2);  // with the limbo and the end
        kernels.insert(kernels.end(), {{"count_kernel", grids},
                                       {"chunk_sums_kernel", grids * levels},
                                       {"scan_chunks_kernel", grids * levels},
                                       {"scatter_kernel", grids},
                                       {"sort_cells_kernel", grids},
                                       {"grid::gather_kernel", 2 * grids}});
    }
    if (m.far_field.far == Far::cells || m.far_field.far == Far::pyramid) {
        Pyramid pyramid{nullptr, nullptr};
        pyramid.shape(cells, m.far_field.far == Far::cells ? 1 : kMaxLevels);
        kernels.push_back({"monopoles_kernel", grids});
        if (pyramid.levels > 1) kernels.push_back({"coarsen_kernel", grids * (pyramid.levels - 1)});
    }
    kernels.push_back({m.far_field.far == Far::direct    ? "field_direct_kernel"
                       : m.far_field.far == Far::dropped ? "field_neighbours_kernel"
                                                         : "field_pyramid_kernel",
                       grids});
    kernels.push_back({"advance_vortons_kernel", grids});
    kernels.push_back({"rebirth_kernel", 1});
    kernels.push_back({"vortex_flame_kernel", 1});
    return kernels;
}
//! [launches]

/// Bytes of device memory that do not depend on how large the fire gets.
inline std::size_t vorton_bytes(const VortexModel& m) {
    std::size_t each = VortexFire::kVortonBytes;
    if (m.stepping == Stepping::midpoint) each += 2 * sizeof(float4);
    return each * m.vortons;
}

inline std::string explain(const VortexScene& scene, glm::ivec3 cells, std::size_t grid_bytes) {
    const VortexModel& m = scene.model;
    int total = 0;
    std::string passes;
    for (const auto& [name, count] : launches_per_step(scene, cells)) {
        passes += (passes.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
        total += count;
    }
    std::string text = "each step (grid of " + std::to_string(cells.x) + " x " + std::to_string(cells.y) +
                       " x " + std::to_string(cells.z) + " cells): " + std::to_string(total) +
                       " kernels: " + passes + "\n";
    text += "each particle: " + std::to_string(fire::kFlameBytes) + " bytes of state, " +
            std::to_string(sizeof(float)) + " more for its brightness while a picture is drawn\n";
    text += std::to_string(m.vortons) + " vortons: " + std::to_string(vorton_bytes(m)) +
            " bytes; velocity grid: " + std::to_string(grid_bytes) + " bytes for up to " +
            std::to_string(m.max_cells) + " cells\n";
    if (m.ball.radius_m == 0) text += "left out: the ball (compiled out of the kernels that move things)\n";
    if (!m.physics.stretching) text += "left out: stretching (compiled out of advance_vortons_kernel)\n";
    if (m.far_field.far == Far::dropped)
        text += "left out: all that is farther away than the neighbour cells\n";
    if (m.far_field.far == Far::direct) text += "left out: sorting, since nobody asks who is near\n";
    if (m.stepping == Stepping::euler) text += "left out: the second grid of the midpoint method\n";
    text +=
        "left out: curl noise (the vortons do that), a colour array (colour follows from age, in the "
        "shader)\n";
    return text;
}

}  // namespace vortex
