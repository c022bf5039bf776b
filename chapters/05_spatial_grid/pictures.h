/// @file
/// The chapter's figure: what one search looks at.
#pragma once
#include <cstdio>
#include <glm/vector_relational.hpp>

#include "04_parallel_patterns/canvas.h"
#include "05_spatial_grid/neighbours.cuh"

namespace grid {

using namespace patterns::drawing;

/// One particle's search, on the host.
struct Search {
    std::vector<float4> position;
    CellGrid cells;
    float radius_m = 0;
    std::uint32_t centre = 0;                           ///< the particle that asks
    std::vector<std::uint32_t> candidates, neighbours;  ///< without the particle itself
    double share = 0;                                   ///< neighbours / candidates, over all particles
};

/// A slice half a radius thick through the particle that asks: cells, candidates, neighbours.
inline void draw_slice(Canvas& canvas, const Search& s, float side) {
    const glm::vec3 x = xyz(s.position[s.centre]);
    const glm::ivec3 own = cell_of(s.cells, x);
    constexpr int kReach = 3;  // cells shown on each side of its own
    const float cell = side / (2 * kReach + 1);
    const auto to_pixel = [&](glm::vec2 in_cells) {  // y upwards, its own cell in the middle
        const glm::vec2 u = (in_cells - glm::vec2(own) + float(kReach)) * cell;
        return glm::vec2(u.x, side - u.y);
    };
    const auto in_cells = [&](glm::vec3 m) {
        return glm::vec2((m - s.cells.origin_m) * s.cells.cells_per_m);
    };

    const glm::vec2 low = to_pixel(glm::max(own - 1, 0)), high = to_pixel(glm::min(own + 2, s.cells.size));
    canvas.rectangle({low.x, high.y}, {high.x, low.y}, kCream);
    const glm::ivec2 first = glm::max(glm::ivec2(own) - kReach, 0),
                     last = glm::min(glm::ivec2(own) + kReach + 1, glm::ivec2(s.cells.size));
    for (int k = first.x; k <= last.x; ++k)
        canvas.line(to_pixel({k, first.y}), to_pixel({k, last.y}), side / 480, kPale);
    for (int k = first.y; k <= last.y; ++k)
        canvas.line(to_pixel({first.x, k}), to_pixel({last.x, k}), side / 480, kPale);
    canvas.ring(to_pixel(in_cells(x)), s.radius_m * s.cells.cells_per_m * cell, side / 240, kBlue);

    const auto dot = [&](std::uint32_t i, float radius, Colour colour) {
        const glm::vec3 d = xyz(s.position[i]) - x;
        const glm::vec2 at = to_pixel(in_cells(xyz(s.position[i])));
        if (std::abs(d.z) < 0.25f * s.radius_m &&
            glm::all(glm::lessThan(glm::abs(at - side / 2), glm::vec2(side / 2))))
            canvas.disc(at, radius * side, colour);
    };
    for (std::uint32_t i = 0; i < s.position.size(); ++i) dot(i, 0.005f, kGrey);
    for (std::uint32_t i : s.candidates) dot(i, 0.008f, kOrange);
    for (std::uint32_t i : s.neighbours) dot(i, 0.008f, kBlue);
    dot(s.centre, 0.011f, kBlack);
}

/// The slice, and beside it how many particles each stage of the search leaves.
inline course::Image draw_search(const Search& s, int width, int height) {
    Canvas canvas(width, height);
    const float unit = std::min(width / 1280.0f, height / 720.0f), side = 720 * unit;
    draw_slice(canvas, s, side);

    const float left = side + 40 * unit, bar = float(width) - left - 40 * unit;
    const auto write = [&](float y, const std::string& words, float scale = 2) {
        canvas.text({left, y * unit}, words, kBlack, scale * unit);
    };
    const auto draw_bar = [&](float y, std::size_t count, const std::string& what, Colour colour) {
        write(y, std::to_string(count) + " " + what);
        const float share = float(count) / float(s.position.size());
        canvas.rectangle({left, (y + 24) * unit}, {left + bar, (y + 46) * unit}, kPale);
        canvas.rectangle({left, (y + 24) * unit}, {left + std::max(2 * unit, share * bar), (y + 46) * unit},
                         colour);
    };
    write(40, "Who is near the black one?", 3);
    draw_bar(120, s.position.size(), "particles: brute force", kGrey);
    draw_bar(210, s.candidates.size(), "candidates: in the cells around", kOrange);
    draw_bar(300, s.neighbours.size(), "neighbours: within the radius", kBlue);
    char words[80];
    std::snprintf(words, sizeof words, "All particles: %.1f %% of the", 100 * s.share);
    write(410, words);
    write(436, "candidates are neighbours.");
    write(490, "The slice is half a radius thick.");
    write(516, "Most candidates lie above or");
    write(542, "below it, and so do most of");
    write(568, "those that are too far.");
    return canvas.image();
}

}  // namespace grid
