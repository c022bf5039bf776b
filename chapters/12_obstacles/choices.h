/// @file
/// What the program can be asked for, beyond the options that all programs have.
#pragma once
#include <string>
#include <vector>

#include "12_obstacles/scene.cuh"
#include "common/errors.h"

namespace obstacles {

constexpr int kStills = 9;          // pictures of a run: the start, the end, and seven evenly between
constexpr int kStepsPerCheck = 10;  // as in chapter 10
constexpr const char* kFireScene = "flame_around_ball";
constexpr const char* kMarbleScene = "marbles_on_sphere";

/// Each has the value of the scene, or of chapter 10.
struct Choices {
    std::string draw = "spheres", skin = "ghost";
    float speed = 1, size = 1, restitution = -1, friction = -1;
    bool without = false;
    int frames = 0;

    bool draws() const { return draw == "spheres"; }
};

inline void check(const Choices& choices) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.draw == "spheres" || choices.draw == "none",
         "--draw must be spheres or none, not '" + choices.draw + "'");
    want(choices.skin == "ghost" || choices.skin == "bare",
         "--skin must be ghost or bare, not '" + choices.skin + "'");
    want(choices.frames >= 0, "--frames must be 0 or more");
}

/// The scene's obstacles, as the user wants them.
inline void adjust(std::vector<Obstacle>& obstacles, const Choices& choices) {
    if (choices.without) obstacles.clear();
    for (Obstacle& o : obstacles) {
        o.solid.half_size_m *= choices.size;
        if (o.control == Control::free) o.mass_kg *= double(choices.size) * choices.size * choices.size;
        if (!(choices.restitution < 0)) o.surface.restitution = choices.restitution;
        if (!(choices.friction < 0)) o.surface.friction = choices.friction;
    }
}

}  // namespace obstacles
