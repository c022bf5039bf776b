/// @file
/// The answer to --explain: what obstacles add to each step of a model, and what is left out.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "12_obstacles/ghost_water.cuh"

namespace obstacles {

using Launches = std::vector<std::pair<std::string, int>>;

//! [launches]
/// Kernels that obstacles add to one step, with how often each is launched. Tests hold it against what really
/// happens.
inline Launches launches_per_step(const ObstacleSet& obstacles) {
    if (obstacles.empty()) return {};
    Launches kernels;
    int trees = 0;  // each runs in two launches
    for (int k = 0; k < obstacles.size(); ++k)
        trees += obstacles.two_way() + (obstacles.obstacle(k).control == Control::free);
    if (trees > 0) kernels.push_back({"reduce_shared_kernel<Operation>", 2 * trees});
    kernels.push_back(
        {obstacles.two_way() ? "contact_kernel<Clock, true>" : "contact_kernel<Clock, false>", 1});
    return kernels;
}
inline Launches launches_per_step(const ObstacleSet& obstacles, Skin skin, sph::EquationOfState state) {
    Launches kernels = launches_per_step(obstacles);
    if (!obstacles.empty() && skin == Skin::ghost)
        kernels.push_back({state == sph::EquationOfState::linear
                               ? "ghost_kernel<sph::EquationOfState::linear>"
                               : "ghost_kernel<sph::EquationOfState::tait>",
                           1});
    return kernels;
}
//! [launches]

inline std::string in_words(const Launches& kernels) {
    int total = 0;
    std::string names;
    for (const auto& [name, count] : kernels) {
        names += (names.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
        total += count;
    }
    return std::to_string(total) + (total == 1 ? " kernel" : " kernels") + (total > 0 ? ": " + names : "") +
           "\n";
}

/// @param model  launches of one step without obstacles
inline std::string explain(const std::string& scene, const Launches& model, const Launches& added,
                           const ObstacleSet& obstacles, bool water, bool draws) {
    std::string text = scene + ": " + std::to_string(obstacles.size()) +
                       (obstacles.size() == 1 ? " obstacle\n" : " obstacles\n");
    text += "each step of the particles: " + in_words(model);
    text += "each step of the obstacles: " + in_words(added);
    text += "each particle: " + std::to_string(obstacles.bytes_per_particle()) +
            " bytes more of device memory for what it gives to obstacles\n";
    if (!obstacles.two_way())
        text += "left out: impulses and their sums (nothing here moves as particles push it)\n";
    if (!water) text += "left out: ghost water (these particles have no density)\n";
    text += "left out: a grid of distances (spheres and boxes have a formula), rotation\n";
    if (!draws) text += "left out: OpenGL, its context and all its objects, since nothing is drawn\n";
    return text;
}

}  // namespace obstacles
