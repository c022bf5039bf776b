/// @file
/// The chapter's two figures: how a reduction and a scan go through 16 numbers, and what every version asks
/// of memory.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "04_parallel_patterns/canvas.h"
#include "04_parallel_patterns/versions.cuh"

namespace patterns {

using namespace drawing;

/// 16 numbers after each step, in rows from top to bottom; columns are places in memory.
class StepsDrawing {
  public:
    StepsDrawing(Canvas& canvas, glm::vec2 corner, float width, float unit)
        : canvas_(canvas), corner_(corner), column_(width / 16), unit_(unit) {}

    glm::vec2 place(int step, int column) const {
        return corner_ + glm::vec2((float(column) + 0.5f) * column_, float(step) * 88 * unit_);
    }
    void addition(int step, int from, int to, Colour colour) {
        canvas_.line(place(step, from), place(step + 1, to), 2 * unit_, colour);
    }
    void number(int step, int column, std::uint32_t value, Colour colour) {
        canvas_.disc(place(step, column), 15 * unit_, colour);
        const std::string text = std::to_string(value);
        const float scale = 2 * unit_;
        canvas_.text(place(step, column) - glm::vec2(Canvas::text_width(text, scale) / 2, 7 * unit_), text,
                     colour.r + colour.g + colour.b > 450 ? kBlack : kPaper, scale);
    }

  private:
    Canvas& canvas_;
    glm::vec2 corner_;
    float column_, unit_;
};

inline void draw_reduction(StepsDrawing drawing, std::vector<std::uint32_t> values) {
    int step = 0;
    for (int half = 8; half > 0; half /= 2, ++step)
        for (int t = 0; t < half; ++t) {
            drawing.addition(step, t, t, kSkyBlue);
            drawing.addition(step, t + half, t, kOrange);
        }
    step = 0;
    for (int left = 16; left > 0; left /= 2, ++step) {
        for (int t = 0; t < left; ++t) drawing.number(step, t, values[t], left == 1 ? kVermilion : kBlue);
        for (int t = left; t < 16; ++t) drawing.number(step, t, values[t], kPale);
        for (int t = 0; t < left / 2; ++t) values[t] += values[t + left / 2];
    }
}

inline void draw_scan(StepsDrawing drawing, std::vector<std::uint32_t> values) {
    int step = 0;
    for (int reach = 1; reach < 16; reach *= 2, ++step)
        for (int t = 0; t < 16; ++t) {
            drawing.addition(step, t, t, kSkyBlue);
            if (t >= reach) drawing.addition(step, t - reach, t, kOrange);
        }
    step = 0;
    for (int reach = 1; reach <= 16; reach *= 2, ++step) {
        for (int t = 0; t < 16; ++t) drawing.number(step, t, values[t], t < reach ? kVermilion : kBlue);
        for (int t = 15; t >= reach; --t) values[t] += values[t - reach];
    }
}

/// The tree of a reduction and the doubling of a scan, on the same 16 numbers.
inline course::Image draw_steps(std::uint64_t seed, int width, int height) {
    Canvas canvas(width, height);
    const float unit = std::min(width / 1280.0f, height / 720.0f), panel = 600 * unit;
    std::vector<std::uint32_t> values = random_input(16, seed).bins;
    for (std::uint32_t& value : values) value %= 8;  // short enough for the discs
    const auto write = [&](float x, float y, const char* words, float scale) {
        canvas.text({x * unit, y * unit}, words, kBlack, scale * unit);
    };
    write(30, 30, "Reduction", 4);
    write(30, 84, "Half of the threads add what the other half has:", 2);
    write(30, 108, "15 additions in 4 steps, with a barrier between them.", 2);
    draw_reduction({canvas, {20 * unit, 180 * unit}, panel, unit}, values);
    write(670, 30, "Scan", 4);
    write(670, 84, "Each adds what stands 1, 2, 4, 8 places before it:", 2);
    write(670, 108, "49 additions in 4 steps. Red ones are finished.", 2);
    draw_scan({canvas, {660 * unit, 180 * unit}, panel, unit}, values);
    write(30, 590, "Columns are threads, each row is a step later. Blue lines carry a thread's own number,",
          2);
    write(30, 614, "orange ones another thread's: those go through shared memory, or through a shuffle.", 2);
    write(30, 650, "One after the other it takes 15 additions for either, and 15 steps.", 2);
    return canvas.image();
}

/// Accesses to global memory for each element, of every version of ours.
inline course::Image draw_traffic(const std::vector<Version>& versions, const Input& input, int width,
                                  int height) {
    constexpr float kMost = 10;  // accesses per element that fit into the picture
    Canvas canvas(width, height);
    const float unit = std::min(width / 1280.0f, height / 720.0f), letter = 2 * unit, n = float(input.n());
    const float left = 330 * unit, right = 1090 * unit, bar = 16 * unit;
    const auto x_of = [&](float accesses) {
        return left + (right - left) * std::min(accesses, kMost) / kMost;
    };

    canvas.text({30 * unit, 22 * unit}, "Accesses to global memory, for each element", kBlack, 3 * unit);
    float key = 330 * unit;
    for (const auto& [name, colour] :
         {std::pair{"loads", kSkyBlue}, {"stores", kBlue}, {"atomics", kVermilion}}) {
        canvas.rectangle({key, 60 * unit}, {key + 22 * unit, 76 * unit}, colour);
        canvas.text({key + 30 * unit, 61 * unit}, name, kBlack, letter);
        key += 130 * unit;
    }
    for (int k = 0; k <= int(kMost); k += 2) {
        canvas.line({x_of(float(k)), 92 * unit}, {x_of(float(k)), 690 * unit}, unit, kPale);
        const std::string text = std::to_string(k);
        canvas.text({x_of(float(k)) - Canvas::text_width(text, letter) / 2, 696 * unit}, text, kBlack,
                    letter);
    }
    float y = 84 * unit;
    std::string pattern;
    for (const Version& version : versions) {
        if (version.is_library()) continue;
        if (version.pattern != pattern) {
            y += 14 * unit;
            canvas.text({30 * unit, y + 2 * unit}, version.pattern, kBlack, letter);
            pattern = version.pattern;
        }
        const Cost cost = version.cost(input);
        const float loads = float(cost.loads) / n, stores = float(cost.stores) / n,
                    atomics = float(cost.atomics) / n;
        const float total = loads + stores + atomics;
        canvas.text({190 * unit, y + 2 * unit}, version.name, kBlack, letter);
        canvas.rectangle({x_of(0), y}, {x_of(loads), y + bar}, kSkyBlue);
        canvas.rectangle({x_of(loads), y}, {x_of(loads + stores), y + bar}, kBlue);
        canvas.rectangle({x_of(loads + stores), y}, {x_of(total), y + bar}, kVermilion);
        if (total > kMost)  // torn off
            for (int k = 0; k < 3; ++k)
                canvas.line({right - (60 - 10 * k) * unit, y + bar + 2 * unit},
                            {right - (48 - 10 * k) * unit, y - 2 * unit}, 3 * unit, kPaper);
        char text[32];
        std::snprintf(text, sizeof text, "%.3g", total);
        canvas.text({x_of(total) + 10 * unit, y + 2 * unit}, text, kBlack, letter);
        y += 27 * unit;
    }
    return canvas.image();
}

}  // namespace patterns
