/// @file
/// Words for pictures, as the rectangles that stb_easy_font makes of them.
#pragma once
#include <stb/stb_easy_font.h>

#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace course {

/// Calls fill(low, high) for each rectangle of the words, written from (0, 0) with y downwards. A capital is
/// about 7 units high.
template <class Fill>
void for_each_stroke(std::string words, Fill fill) {
    struct Corner {
        float x, y, z;
        unsigned char rgba[4];
    };
    std::vector<Corner> corners(4 * 70 * words.size());  // a letter is a few rectangles
    const int count = stb_easy_font_print(0, 0, words.data(), nullptr, corners.data(),
                                          int(corners.size() * sizeof(Corner)));
    for (int k = 0; k < 4 * count; k += 4)
        fill(glm::vec2(corners[k].x, corners[k].y), glm::vec2(corners[k + 2].x, corners[k + 2].y));
}

inline float width_of(std::string words) {
    return float(stb_easy_font_width(words.data()));
}

}  // namespace course
