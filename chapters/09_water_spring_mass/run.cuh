/// @file
/// One run of this chapter's program without its pictures: settings, start, steps, what they cost, what they
/// leave out.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "09_water_spring_mass/diagnostics.cuh"
#include "09_water_spring_mass/scene.cuh"

namespace spring_mass {

enum class Drawing { none, points, spheres };

/// Everything that a run depends on.
struct Settings {
    Scene scene;
    std::uint32_t particles = 16384;
    float dt_s = 0;  ///< 0: kStepInLimits of the limit
    std::uint64_t seed = 1;
    float skin = kDefaultSkin;  ///< of the neighbour list, in diameters
    Drawing drawing = Drawing::spheres;
};

/// The program's own step: half the largest stable one of the densest packing.
constexpr float kStepInLimits = 0.5f;

/// The marbles at their start, and the step they are to be moved by.
struct Start {
    Marbles marbles;
    float spacing_m, dt_s;
};

inline Start make_start(const Settings& settings) {
    float spacing_m = 0;
    const std::vector<float4> position = fill_block(settings.scene.block_low_m, settings.scene.block_size_m,
                                                    settings.particles, settings.seed, kJitter, spacing_m);
    const Material material = make_material(settings.scene, spacing_m);
    const float dt_s = settings.dt_s > 0 ? settings.dt_s : kStepInLimits * time_step_limit_s(material);
    return {Marbles(material, settings.scene.tank, position,
                    std::vector<float4>(settings.particles, make_float4(0, 0, 0, 0)), settings.skin),
            spacing_m, dt_s};
}

/// Which limit the time step breaks, as a sentence; empty if it breaks none.
inline std::string broken_limit(const Material& material, float dt_s) {
    const float limit_s = time_step_limit_s(material);
    if (!(dt_s > limit_s)) return "";
    char text[160];
    std::snprintf(text, sizeof text,
                  "dt %g s is over the limit %g s of this stiffness in the densest packing", dt_s, limit_s);
    return text;
}

using Launches = std::vector<std::pair<std::string, int>>;

//! [launches]
/// Kernels of every step in their order, with how often each is launched. Tests hold it against what really
/// happens.
inline Launches launches_per_step(const Marbles& marbles) {
    const auto yes_or_no = [](bool term) { return std::string(term ? "true" : "false"); };
    return {{"kick_drift_kernel<" + yes_or_no(marbles.has_drag()) + ">", 1},
            {"contact_kernel<" + yes_or_no(marbles.has_shear()) + ", " + yes_or_no(marbles.has_attraction()) +
                 ", " + yes_or_no(marbles.has_drag()) + ">",
             1}};
}

/// Kernels that come in between when a marble has moved by half a skin.
inline Launches launches_per_list(const Marbles& marbles) {
    const int levels = grid::ExclusiveScan::levels(marbles.cell_count() + 2);  // with the limbo and the end
    return {{"count_kernel", 1},   {"chunk_sums_kernel", levels}, {"scan_chunks_kernel", levels},
            {"scatter_kernel", 1}, {"sort_cells_kernel", 1},      {"grid::gather_kernel", 3},
            {"list_kernel", 1}};
}
//! [launches]

inline std::string as_text(const Launches& launches) {
    int total = 0;
    std::string names;
    for (const auto& [name, count] : launches) {
        names += (names.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
        total += count;
    }
    return std::to_string(total) + " kernels: " + names + "\n";
}

/// The answer to --explain.
inline std::string explain(const Settings& settings, const Start& start) {
    const Marbles& marbles = start.marbles;
    std::string text = "each step: " + as_text(launches_per_step(marbles));
    text += "each new neighbour list: " + as_text(launches_per_list(marbles));
    text += "each marble: " + std::to_string(Marbles::kBytesPerMarble) +
            " bytes of device memory; cells: " + std::to_string(marbles.cell_bytes()) + " bytes in all\n";
    if (settings.drawing != Drawing::none)
        text += "each marble drawn: " + std::to_string(2 * sizeof(float4)) +
                " bytes in 2 OpenGL buffers, copied on the device for each picture\n";
    if (!marbles.has_shear()) text += "left out: shear (compiled out of contact_kernel)\n";
    if (!marbles.has_attraction()) text += "left out: attraction (compiled out of contact_kernel)\n";
    if (!marbles.has_drag()) text += "left out: drag (compiled out of both kernels)\n";
    text += "left out: density and pressure (a marble pushes only what touches it)\n";
    text += "left out: rotation of the marbles\n";
    text +=
        "left out: a pass for the bounds of the marbles (the tank does not move, so neither does the grid)\n";
    text += "left out: colour array (colour follows from speed, in the shader)\n";
    if (settings.drawing == Drawing::none)
        text += "left out: OpenGL, its context and all its objects, since nothing is drawn\n";
    if (settings.drawing == Drawing::points) text += "left out: surface buffer, shadow map, lighting\n";
    return text;
}

//! [state_hash]
/// 64-bit FNV-1a hash of all positions and velocities, by particle number. Equal states have equal hashes;
/// one different bit anywhere gives another.
inline std::uint64_t state_hash(const Marbles& marbles) {
    const std::vector<float4> x = by_id(marbles, marbles.positions()),
                              v = by_id(marbles, marbles.velocities());
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](float4 value) {
        unsigned char bytes[sizeof value];
        __builtin_memcpy(bytes, &value, sizeof value);
        for (unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    };
    for (std::uint32_t i = 0; i < marbles.size(); ++i) {
        add(x[i]);
        add(v[i]);
    }
    return hash;
}
//! [state_hash]

}  // namespace spring_mass
