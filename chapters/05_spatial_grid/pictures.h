/// @file
/// The chapter's two figures: what one search looks at, and what all searches cost.
#pragma once
#include <cstdio>
#include <glm/vector_relational.hpp>

#include "05_spatial_grid/canvas.h"
#include "05_spatial_grid/measure.cuh"

namespace grid {

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

/// A line of the plot: one method's time, all of it or the build alone.
struct Line {
    const char* name;
    Colour colour;
    Times Measurement::*times;
    bool with_query;
};
constexpr Line kLines[] = {{"brute force", kVermilion, &Measurement::brute_force, true},
                           {"sorted grid", kOrange, &Measurement::sorted_grid, true},
                           {"counting sort", kSkyBlue, &Measurement::counting_sort, true},
                           {"reordered", kBlue, &Measurement::reordered, true},
                           {"sorted: build", kOrange, &Measurement::sorted_grid, false},
                           {"counting: build", kSkyBlue, &Measurement::counting_sort, false},
                           {"reordered: build", kBlue, &Measurement::reordered, false}};

/// Common logarithm of the line's milliseconds.
inline float log_time(const Line& line, const Measurement& m) {
    const Times& t = m.*line.times;
    return std::log10(
        std::max(1e-4f, t.build_ms + (line.with_query ? t.query_ms : 0)));  // no clock sees less
}

/// Heights of the lines' names: where the lines end, but far enough apart to be read. Each name goes down as
/// far as the names above it push it; then the lowest goes back into the picture and pushes the others up.
inline std::vector<float> spread_labels(std::vector<float> y, float gap, float bottom) {
    std::vector<std::size_t> by_height(y.size());
    std::iota(by_height.begin(), by_height.end(), 0u);
    std::stable_sort(by_height.begin(), by_height.end(),
                     [&](std::size_t a, std::size_t b) { return y[a] < y[b]; });
    for (std::size_t k = 1; k < y.size(); ++k)
        y[by_height[k]] = std::max(y[by_height[k]], y[by_height[k - 1]] + gap);
    for (std::size_t k = y.size(); k-- > 0; bottom = y[by_height[k]] - gap)
        y[by_height[k]] = std::min(y[by_height[k]], bottom);
    return y;
}

/// Milliseconds against the number of particles, both axes logarithmic.
inline course::Image draw_times(const std::vector<Measurement>& rows, const std::string& device, int width,
                                int height) {
    Canvas canvas(width, height);
    const float unit = std::min(width / 1280.0f, height / 720.0f), letter = 2 * unit;
    float low = 9, high = -9;  // decades
    for (const Measurement& m : rows)
        for (const Line& line : kLines) {
            low = std::min(low, std::floor(log_time(line, m)));
            high = std::max(high, std::ceil(log_time(line, m)));
        }
    const float first = std::log2(float(rows.front().n));
    const float last = std::max(first + 1, std::log2(float(rows.back().n)));
    const glm::vec2 corner(110 * unit, float(height) - 80 * unit),
        opposite(float(width) - 270 * unit, 90 * unit);
    const auto to_pixel = [&](float log2_n, float log10_ms) {
        return corner + (opposite - corner) *
                            glm::vec2((log2_n - first) / (last - first), (log10_ms - low) / (high - low));
    };

    canvas.text({corner.x, 24 * unit}, "Milliseconds for all neighbours of all particles", kBlack, 3 * unit);
    canvas.text({corner.x, 58 * unit}, "30 neighbours each; " + device, kBlack, letter);
    canvas.text({corner.x, float(height) - 34 * unit},
                "particles (brute force beyond 32768: a part was asked, the time scaled)", kBlack, letter);
    for (float decade = low; decade <= high; ++decade) {
        canvas.line(to_pixel(first, decade), to_pixel(last, decade), 1.5f * unit, kPale);
        char label[32];
        std::snprintf(label, sizeof label, "%.*f", std::max(0, -int(decade)), std::pow(10.0, decade));
        const glm::vec2 size(Canvas::text_width(label, letter) + 14 * unit, 7 * unit);
        canvas.text(to_pixel(first, decade) - size, label, kBlack, letter);
    }
    for (float k = first; k <= last; ++k) {
        canvas.line(to_pixel(k, low), to_pixel(k, high), 1.5f * unit, kPale);
        const std::string label = std::to_string(1u << int(k));
        canvas.text(to_pixel(k, low) + glm::vec2(-Canvas::text_width(label, letter) / 2, 14 * unit), label,
                    kBlack, letter);
    }

    std::vector<float> label_y;
    for (const Line& line : kLines) {
        const float thickness = line.with_query ? 3 * unit : 1.5f * unit;
        glm::vec2 before{};
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const glm::vec2 at = to_pixel(std::log2(float(rows[k].n)), log_time(line, rows[k]));
            if (k > 0) canvas.line(before, at, thickness, line.colour);
            canvas.disc(at, 2 * thickness, line.colour);
            before = at;
        }
        label_y.push_back(before.y);
    }
    label_y = spread_labels(label_y, 24 * unit, corner.y);
    for (std::size_t k = 0; k < label_y.size(); ++k) {
        const float x = to_pixel(last, low).x + 24 * unit;
        canvas.disc({x, label_y[k]}, kLines[k].with_query ? 6 * unit : 3 * unit, kLines[k].colour);
        canvas.text({x + 16 * unit, label_y[k] - 7 * unit}, kLines[k].name, kBlack, letter);
    }
    return canvas.image();
}

}  // namespace grid
