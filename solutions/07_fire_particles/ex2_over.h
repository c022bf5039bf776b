// Exercise 07.2: what covers what.
//
// A sprite's colour is premultiplied: red, green and blue are what it adds to the picture, alpha is the part
// of what lies behind it that it covers. Flames add and cover nothing; smoke does both. You put sprites on
// top of each other.
#pragma once
#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "common/todo.h"

namespace fire {

// What is seen of `front` over `back`: both premultiplied, alpha in w, and so is the result.
inline glm::vec4 over(glm::vec4 front, glm::vec4 back) {
    // TODO(7.2): the front's own light, and what it leaves of the back. Alpha follows the same rule.
    // About 1 line.
    // <solution>
    return front + (1 - front.a) * back;
    // <stub>
    //| (void)front, (void)back;
    //| return glm::vec4(course::kTodo);
    // </solution>
}

// A sprite as one pixel sees it.
struct SeenSprite {
    float depth_m;
    glm::vec4 colour;  // premultiplied
};

// What the pixel shows if the sprites, in any order, hang before nothing. Of two at the same depth, the one
// that comes first in the list is in front.
inline glm::vec4 composite(std::vector<SeenSprite> sprites) {
    glm::vec4 seen(0);
    // TODO(7.2): order them, then lay one over the other. About 4 lines.
    // <solution>
    std::stable_sort(sprites.begin(), sprites.end(),
                     [](const SeenSprite& a, const SeenSprite& b) { return a.depth_m < b.depth_m; });
    for (const SeenSprite& sprite : sprites) seen = over(seen, sprite.colour);
    // <stub>
    //| if (!sprites.empty()) seen = glm::vec4(course::kTodo);
    // </solution>
    return seen;
}

// Does the picture stay the same when these two change places? To 1e-6 in each component.
inline bool may_swap(glm::vec4 a, glm::vec4 b) {
    // TODO(7.2): compute both, and compare. About 2 lines.
    // <solution>
    const glm::vec4 difference = glm::abs(over(a, b) - over(b, a));
    return std::max({difference.r, difference.g, difference.b, difference.a}) <= 1e-6f;
    // <stub>
    //| return a.r + b.r == float(course::kTodo);
    // </solution>
}

}  // namespace fire
