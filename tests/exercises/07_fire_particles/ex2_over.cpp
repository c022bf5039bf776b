// Exercise 07.2: premultiplied colours on top of each other.
#include "ex2_over.h"

#include "tests/support/course_test.h"

using fire::composite;
using fire::may_swap;
using fire::over;
using fire::SeenSprite;

namespace {

const glm::vec4 kA(0.4f, 0, 0, 0.5f), kB(0, 0, 0.6f, 0.75f), kC(0.1f, 0.3f, 0, 0.4f);

void check_colour(glm::vec4 got, glm::vec4 expected, const char* what, double tolerance = 1e-6) {
    course::check_close(std::vector<glm::vec4>{got}, std::vector<glm::vec4>{expected},
                        course::Tolerance(tolerance), what, "pixel");
}

}  // namespace

TEST_CASE("two sprites, both ways") {
    course::set_hint(1);
    check_colour(over(kA, kB), {0.4f, 0, 0.3f, 0.875f}, "A over B");
    check_colour(over(kB, kA), {0.1f, 0, 0.6f, 0.875f}, "B over A");
    check_colour(over(kA, glm::vec4(0)), kA, "A over nothing");
    check_colour(over(glm::vec4(0), kA), kA, "nothing over A");
    check_colour(over({0.2f, 0.1f, 0, 0}, kA), {0.6f, 0.1f, 0, 0.5f}, "a flame over A");
    check_colour(over({0.2f, 0.1f, 0, 1}, kA), {0.2f, 0.1f, 0, 1}, "a wall over A");
}

TEST_CASE("three sprites: brackets do not matter") {
    course::set_hint(1);
    const glm::vec4 expected(0.4125f, 0.0375f, 0.3f, 0.925f);
    check_colour(over(over(kA, kB), kC), expected, "(A over B) over C");
    check_colour(over(kA, over(kB, kC)), expected, "A over (B over C)");
}

TEST_CASE("sprites in any order of the list") {
    course::set_hint(2);
    const glm::vec4 expected(0.4125f, 0.0375f, 0.3f, 0.925f);
    std::vector<SeenSprite> sprites = {{1, kA}, {2, kB}, {3, kC}};
    check_colour(composite(sprites), expected, "near to far");
    std::swap(sprites[0], sprites[2]);
    check_colour(composite(sprites), expected, "far to near");
    std::swap(sprites[0], sprites[1]);
    check_colour(composite(sprites), expected, "mixed");
    check_colour(composite({}), glm::vec4(0), "no sprite");
    check_colour(composite({{5, kB}}), kB, "one sprite");
    check_colour(composite({{-1, kA}, {-2, kB}}), {0.1f, 0, 0.6f, 0.875f}, "behind the eye, too");
}

TEST_CASE("the same depth: the list decides") {
    course::set_hint(2);
    check_colour(composite({{1, kA}, {1, kB}}), {0.4f, 0, 0.3f, 0.875f}, "A first");
    check_colour(composite({{1, kB}, {1, kA}}), {0.1f, 0, 0.6f, 0.875f}, "B first");
    std::vector<SeenSprite> many(
        40, {2, glm::vec4(0.01f, 0.02f, 0, 0.05f)});  // enough to mix up an unstable sort
    many.insert(many.begin() + 17, {2, kA});
    glm::vec4 expected(0);
    for (auto sprite = many.rbegin(); sprite != many.rend(); ++sprite)
        expected = sprite->colour + (1 - sprite->colour.a) * expected;
    check_colour(composite(many), expected, "41 at one depth", 1e-5);
}

TEST_CASE("twenty thin layers") {
    course::set_hint(1);
    std::vector<SeenSprite> layers;
    for (int k = 0; k < 20; ++k)
        layers.push_back({float((7 * k) % 20), glm::vec4(0.05f, 0.05f, 0.05f, 0.1f)});
    const float alpha = 0.8784233454094307f;  // 1 - 0.9^20
    check_colour(composite(layers), {0.5f * alpha, 0.5f * alpha, 0.5f * alpha, alpha}, "20 layers");
}

TEST_CASE("which two may change places") {
    course::set_hint(3);
    CHECK(may_swap({0.2f, 0.1f, 0, 0}, {0.7f, 0.5f, 0.1f, 0}));           // two flames
    CHECK(may_swap({0.2f, 0.2f, 0.2f, 0.4f}, {0.1f, 0.1f, 0.1f, 0.2f}));  // one smoke, thick and thin
    CHECK(may_swap(kA, kA));
    CHECK(may_swap(kA, glm::vec4(0)));
    CHECK(!may_swap(kA, kB));
    CHECK(!may_swap({0.2f, 0.1f, 0, 0}, kB));  // a flame behind smoke is not one before it
    CHECK(!may_swap(kB, {0.2f, 0.1f, 0, 0}));
    CHECK(!may_swap({0, 0, 0, 0.5f}, {0, 0, 0.1f, 0.5f}));  // blue alone differs
}
