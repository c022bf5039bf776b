// Exercise 13.2: a ray marched in parts is the ray marched in one.
#include "ex2_march_in_parts.cuh"

#include <random>

#include "13_volume_rendering/known_volumes.h"
#include "tests/support/course_test.h"

namespace {

using volume::Seen;

std::vector<float> numbers(const std::vector<Seen<float>>& seen) {
    std::vector<float> values;
    for (const Seen<float>& s : seen)
        for (const float v : {s.light.x, s.light.y, s.light.z, s.transmittance}) values.push_back(v);
    return values;
}

Seen<float> pane(float r, float g, float b, float transmittance) {
    Seen<float> s;
    s.light = {r, g, b};
    s.transmittance = transmittance;
    return s;
}

}  // namespace

TEST_CASE("two panes of glass, in either order") {
    course::set_hint(1);
    const Seen<float> red = pane(0.5f, 0, 0, 0.5f), blue = pane(0, 0, 1, 0.25f);
    course::check_equal(numbers({volume::behind(red, blue), volume::behind(blue, red)}),
                        {0.5f, 0, 0.5f, 0.125f, 0.125f, 0, 1, 0.125f}, "light or transmittance", "number");
}

TEST_CASE("nothing before or behind a pane changes nothing; behind a wall nothing shows") {
    course::set_hint(1);
    const Seen<float> glass = pane(0.3f, 0.2f, 0.1f, 0.7f), wall = pane(1, 2, 3, 0);
    course::check_equal(
        numbers({volume::behind({}, glass), volume::behind(glass, {}), volume::behind(wall, glass)}),
        numbers({glass, glass, wall}), "light or transmittance", "number");
}

TEST_CASE("of three panes it does not matter which two are put together first") {
    course::set_hint(1);
    course::set_seed(4);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<Seen<float>> left, right;
    for (int k = 0; k < 50; ++k) {
        Seen<float> p[3];
        for (Seen<float>& s : p) s = pane(unit(random), unit(random), unit(random), unit(random));
        left.push_back(volume::behind(volume::behind(p[0], p[1]), p[2]));
        right.push_back(volume::behind(p[0], volume::behind(p[1], p[2])));
    }
    course::check_close(numbers(left), numbers(right), course::Tolerance(1e-6), "light or transmittance",
                        "number");
}

TEST_CASE("a cloud in 1, 2, 7 and 40 parts") {
    course::set_hint(2);
    const volume::GaussianCloud<float> cloud{1.3f, 0.4f, 0, 2, 0.25f};
    const volume::Ray<float> ray{{0.1f, 0.2f, -5}, {0, 0, 1}};
    const volume::Span<float> span{4, 6};
    const Seen<float> whole = volume::march(cloud, ray, span, {0.001f, 0});
    std::vector<Seen<float>> got, expected;
    for (const int parts : {1, 2, 7, 40}) {
        got.push_back(volume::march_in_parts(cloud, ray, span, {0.001f, 0}, parts));
        expected.push_back(whole);
    }
    // 2000 roundings each, and samples at slightly other places: the midpoint rule is off by 1e-7 here.
    course::check_close(numbers(got), numbers(expected), course::Tolerance(5e-5), "light or transmittance",
                        "number");
}

TEST_CASE("a slab in 1, 3 and 33 parts of one step each is exact") {
    course::set_hint(3);
    const volume::Slab<float> slab{2, 3, 1.5f};
    const volume::Ray<float> ray{{0, 0, -1}, {0, 0, 1}};
    const float through = std::exp(-2.0f), light = 1.5f * (1 - through);
    std::vector<Seen<float>> got, expected;
    for (const int parts : {1, 3, 33}) {
        got.push_back(volume::march_in_parts(slab, ray, {1, 2}, {10, 0}, parts));
        expected.push_back(pane(light, light, light, through));
    }
    // 33 roundings of numbers around 1
    course::check_close(numbers(got), numbers(expected), course::Tolerance(3e-6), "light or transmittance",
                        "number");
}
