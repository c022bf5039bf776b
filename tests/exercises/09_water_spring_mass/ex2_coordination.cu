// Exercise 09.2: contacts of each marble, against a count over all pairs and against packings that are known.
#include "ex2_coordination.cuh"

#include <random>

#include "tests/support/course_test.h"

namespace {

using namespace spring_mass;

Material unit_marbles() {
    Material material;
    material.diameter_m = 1;
    material.mass_kg = 1;
    material.stiffness_N_per_m = 10;
    return material;
}

Marbles make(const std::vector<float4>& position) {
    return Marbles(unit_marbles(), {{-1, -1, -1}, {20, 20, 20}}, position,
                   std::vector<float4>(position.size(), make_float4(0, 0, 0, 0)));
}

/// All pairs, in double.
Coordination by_all_pairs(const std::vector<float4>& x) {
    Coordination result;
    result.contacts.assign(x.size(), 0);
    result.deepest_m.assign(x.size(), 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < x.size(); ++j) {
            const double r = glm::length(glm::dvec3(grid::xyz(x[i])) - glm::dvec3(grid::xyz(x[j])));
            if (i == j || !(r < 1)) continue;
            ++result.contacts[i];
            result.deepest_m[i] = std::max(result.deepest_m[i], float(1 - r));
        }
        result.alone += result.contacts[i] == 0;
    }
    return result;
}

std::vector<float4> cloud(int n, float edge, unsigned seed) {
    course::set_seed(seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> place(0, int(edge * 1024));  // exact floats: no distance in doubt
    std::vector<float4> points;
    for (int i = 0; i < n; ++i) {
        const float x = float(place(random)) / 1024, y = float(place(random)) / 1024,
                    z = float(place(random)) / 1024;
        points.push_back(make_float4(x, y, z, 0));
    }
    return points;
}

void compare(const std::vector<float4>& points) {
    const Coordination got = coordination(make(points)), expected = by_all_pairs(points);
    course::check_equal(got.contacts, expected.contacts, "contacts", "marble");
    course::check_close(got.deepest_m, expected.deepest_m, {1e-6}, "deepest overlap (m)",
                        "marble");  // fp32 of 1 m
    CHECK(got.alone == expected.alone);
}

}  // namespace

TEST_CASE("a loose cloud: some touch, some do not") {
    course::set_hint(1);
    compare(cloud(300, 9, 21));
}

TEST_CASE("a crowd whose lists are too short") {
    course::set_hint(1);
    compare(cloud(200, 1.5f, 22));
}

TEST_CASE("a cube of marbles pressed together: three to six contacts") {
    course::set_hint(2);
    std::vector<float4> points;
    for (int k = 0; k < 64; ++k)  // from the last to the first, so that numbers and places differ
        points.push_back(make_float4(0.9375f * ((63 - k) % 4), 0.9375f * ((63 - k) / 4 % 4),
                                     0.9375f * ((63 - k) / 16), 0));
    const Coordination got = coordination(make(points));
    std::vector<std::uint32_t> expected;
    for (const float4& p : points) {
        const auto inner = [](float x) { return x > 0.5f && x < 2.5f; };
        expected.push_back(3u + inner(p.x) + inner(p.y) + inner(p.z));
    }
    course::check_equal(got.contacts, expected, "contacts", "marble");
    course::check_close(got.deepest_m, std::vector<float>(64, 0.0625f), {1e-6}, "deepest overlap (m)",
                        "marble");
    CHECK(got.alone == 0);
}

TEST_CASE("marbles that have moved since their list was made, and none at all") {
    course::set_hint(3);
    auto points = cloud(150, 6, 23);
    Marbles marbles = make(points);
    for (int step = 0; step < 12; ++step) marbles.step(0.02f);
    const auto x = marbles.positions().download();
    const auto ids = marbles.ids().download();
    for (std::size_t k = 0; k < ids.size(); ++k) points[ids[k]] = x[k];
    const Coordination got = coordination(marbles), expected = by_all_pairs(points);
    course::check_equal(got.contacts, expected.contacts, "contacts", "marble");
    CHECK(got.alone == expected.alone);
    CHECK(coordination(make({})).contacts.empty());
}
