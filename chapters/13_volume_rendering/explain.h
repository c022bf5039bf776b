/// @file
/// What one picture takes and what it leaves out: the answer to --explain, which tests hold against the
/// truth.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "13_volume_rendering/volume_scene.cuh"

namespace volume {

//! [launches]
/// Kernels of one picture in their order, with how often each is launched.
inline std::vector<std::pair<std::string, int>> launches_per_picture(const VolumeLook& look) {
    std::vector<std::pair<std::string, int>> launches{{"splat_kernel", 1}, {"field_kernel", 1}};
    const auto add = [&](bool needed, const char* kernel, int count = 1) {
        if (needed) launches.push_back({kernel, count});
    };
    add(look.block_edge > 0, "block_kernel");
    add(true, "power_kernel");
    add(look.light_edge > 0, "fluence_kernel");
    add(look.solid, "stage_kernel", look.samples);
    add(true, "march_kernel", look.samples);
    add(composites(look), "composite_kernel", look.samples);
    add(look.film.glare > 0, "shrink_kernel");
    add(look.film.glare > 0, "blur_kernel", 6);
    add(true, "film_kernel");
    return launches;
}
//! [launches]

inline std::string explain(const VolumeScene& scene) {
    const VolumeLook& look = scene.look;
    const grid::CellGrid cells = grid_over(look.low_m, look.high_m, look.cell_m);
    std::string passes;
    int total = 0;
    for (const auto& [name, count] : launches_per_picture(look)) {
        passes += (passes.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
        total += count;
    }
    std::string text = scene.stirred ? "each time step: that of chapter 08's vortex fire\n"
                                     : "each time step: 1 kernel, flame_step_kernel\n";
    text += "each picture: " + std::to_string(total) + " kernels: " + passes + "\n";
    text +=
        "each particle: " + std::to_string(fire::kFlameBytes) + " bytes, chapter 07's; nothing is added\n";
    text += "each cell: " + std::to_string(Splatter::kBytesPerCell) + " bytes; " +
            std::to_string(cells.size.x) + " x " + std::to_string(cells.size.y) + " x " +
            std::to_string(cells.size.z) + " cells of " + std::to_string(look.cell_m) +
            " m: " + std::to_string(cells.cell_count() * Splatter::kBytesPerCell) + " bytes\n";
    text += "each pixel: " + std::to_string(look.samples) + (look.samples > 1 ? " rays" : " ray") +
            "; 16 bytes of light and transmittance, 4 of sRGB" + (composites(look) ? ", 16 of the sum" : "") +
            (look.solid ? ", 20 of what is solid" : "") + "\n";
    text += "left out: OpenGL. No context, no buffer, no shader: the program is not even linked with it\n";
    text += "left out: sorting. Sums of integers need no order, and a march has one by itself\n";
    if (look.block_edge == 0) text += "left out: empty-space skipping (compiled out of march_kernel)\n";
    if (look.detail.reach_m == 0)
        text += "left out: detail finer than the cells (compiled out of march_kernel)\n";
    if (look.light_edge == 0) text += "left out: the fire's light on its smoke, and its grid\n";
    if (look.light_edge > 0 && !look.shadows) text += "left out: shadows of smoke on smoke\n";
    if (!look.solid) text += "left out: logs, ground and sky, with two arrays and a kernel\n";
    if (look.film.glare == 0) text += "left out: the lens's glare, with two arrays and seven kernels\n";
    return text;
}

}  // namespace volume
