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
    (void)front, (void)back;
    return glm::vec4(course::kTodo);
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
    if (!sprites.empty()) seen = glm::vec4(course::kTodo);
    return seen;
}

// Does the picture stay the same when these two change places? To 1e-6 in each component.
inline bool may_swap(glm::vec4 a, glm::vec4 b) {
    // TODO(7.2): compute both, and compare. About 2 lines.
    return a.r + b.r == float(course::kTodo);
}

}  // namespace fire
