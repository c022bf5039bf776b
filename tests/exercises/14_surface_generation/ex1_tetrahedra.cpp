// Exercise 14.1: marching tetrahedra, against plane cuts of one tetrahedron and against a ball.
#include "ex1_tetrahedra.h"

#include <cmath>
#include <map>
#include <random>

#include "tests/support/course_test.h"

namespace {

using namespace surface;
using Corners = std::array<TetCorner, 4>;

/// A tetrahedron of the exercise's orientation, with a linear field on it.
Corners linear_tetrahedron(const std::array<glm::dvec3, 4>& place, glm::dvec3 slope, double offset) {
    Corners corner;
    for (int k = 0; k < 4; ++k) corner[k] = {place[k], glm::dot(slope, place[k]) + offset};
    return corner;
}
int inside_of(const Corners& corner) {
    int inside = 0;
    for (const TetCorner& c : corner) inside += c.value > 0;
    return inside;
}

/// A tetrahedron by random numbers, turned over if need be.
std::array<glm::dvec3, 4> random_tetrahedron(std::mt19937& random) {
    std::uniform_real_distribution<double> at(-1, 1);
    for (;;) {
        std::array<glm::dvec3, 4> p;
        for (glm::dvec3& x : p) {
            const double a = at(random), b = at(random), c = at(random);
            x = {a, b, c};
        }
        const double volume = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
        if (std::fabs(volume) < 0.05) continue;  // too flat to tell sides apart
        if (volume < 0) std::swap(p[2], p[3]);
        return p;
    }
}

/// The six tetrahedra of a unit cube, each with the diagonal from corner 0 to corner 7.
std::vector<std::array<int, 4>> six_tetrahedra() {
    std::vector<std::array<int, 4>> all;
    for (const auto& [first, second] : {std::pair{1, 3}, {2, 6}, {4, 5}})  // positive orientation
        all.push_back({0, first, second, 7});
    for (const auto& [first, second] : {std::pair{1, 5}, {2, 3}, {4, 6}})
        all.push_back({0, second, first, 7});
    return all;
}

/// All triangles of the ball 0.8^2 - |x - c|^2 on n^3 cubes over [-1, 1]^3.
std::vector<TetTriangle> ball(int n) {
    const double h = 2.0 / n;
    const glm::dvec3 centre(0.011, -0.023, 0.037);
    std::vector<TetTriangle> all;
    for (int cube = 0; cube < n * n * n; ++cube)
        for (const std::array<int, 4>& tet : six_tetrahedra()) {
            Corners corner;
            for (int k = 0; k < 4; ++k) {
                const glm::dvec3 node(cube % n + (tet[k] & 1), cube / n % n + (tet[k] >> 1 & 1),
                                      cube / n / n + (tet[k] >> 2));
                const glm::dvec3 d = h * node - 1.0 - centre;
                corner[k] = {h * node - 1.0, 0.64 - glm::dot(d, d)};
            }
            for (const TetTriangle& t : tetrahedron_triangles(corner)) all.push_back(t);
        }
    return all;
}

}  // namespace

TEST_CASE("how many triangles: 0, 1, 2, 1 or 0") {
    course::set_seed(1);
    course::set_hint(1);
    std::mt19937 random(1);
    std::vector<int> got, expected;
    for (int inside = 0; inside < 16; ++inside) {
        const std::array<glm::dvec3, 4> place = random_tetrahedron(random);
        Corners corner;
        for (int k = 0; k < 4; ++k) corner[k] = {place[k], inside >> k & 1 ? 1.0 : -2.0};
        got.push_back(int(tetrahedron_triangles(corner).size()));
        const int count = inside_of(corner);
        expected.push_back(count == 2 ? 2 : count == 1 || count == 3 ? 1 : 0);
    }
    course::check_equal(got, expected, "number of triangles", "case");
}

TEST_CASE("vertices lie where the field is 0") {
    course::set_seed(2);
    course::set_hint(1);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> at(-1, 1);
    std::vector<double> got;
    for (int k = 0; k < 500; ++k) {
        const double a = at(random), b = at(random), c = at(random), offset = 0.3 * at(random);
        const glm::dvec3 slope(a, b, c);
        for (const TetTriangle& t :
             tetrahedron_triangles(linear_tetrahedron(random_tetrahedron(random), slope, offset)))
            for (const glm::dvec3& x : t) got.push_back(glm::dot(slope, x) + offset);
    }
    CHECK(got.size() > 500);
    // A few roundings of 1e-16.
    course::check_close(got, std::vector<double>(got.size(), 0.0), 1e-14, "field at the vertex", "vertex");
}

TEST_CASE("one corner inside: the triangle faces away from it") {
    course::set_seed(3);
    course::set_hint(2);
    std::mt19937 random(3);
    std::vector<double> got;
    for (int k = 0; k < 40; ++k) {
        const std::array<glm::dvec3, 4> place = random_tetrahedron(random);
        Corners corner;
        for (int c = 0; c < 4; ++c) corner[c] = {place[c], c == k % 4 ? 1.0 : -1.0 - 0.1 * k};
        for (const TetTriangle& t : tetrahedron_triangles(corner))
            got.push_back(glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), t[0] - place[k % 4]) > 0);
    }
    course::check_equal(got, std::vector<double>(40, 1.0), "faces outwards", "tetrahedron");
}

TEST_CASE("a plane cut has the right area, and faces down the slope") {
    course::set_seed(4);
    course::set_hint(3);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> at(-1, 1);
    std::vector<double> got, expected;
    for (int k = 0; k < 600; ++k) {
        const double a = at(random), b = at(random), c = at(random), offset = 0.3 * at(random);
        const glm::dvec3 slope = glm::normalize(glm::dvec3(a, b, c));
        const Corners corner = linear_tetrahedron(random_tetrahedron(random), slope, offset);
        double facing = 0;  // area, counted negative where it faces up the slope
        for (const TetTriangle& t : tetrahedron_triangles(corner))
            facing -= 0.5 * glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), slope);
        got.push_back(facing);
        // How the volume above the plane shrinks as the plane rises, by a formula that knows no triangles:
        // the area of the section is 3 V sum_i max(s_i, 0)^2 / prod_{j != i} (s_i - s_j), s = height.
        const glm::dvec3 e1 = corner[1].place_m - corner[0].place_m,
                         e2 = corner[2].place_m - corner[0].place_m,
                         e3 = corner[3].place_m - corner[0].place_m;
        const double volume = glm::dot(glm::cross(e1, e2), e3) / 6;
        double area = 0;
        for (int i = 0; i < 4; ++i) {
            if (!(corner[i].value > 0)) continue;
            double term = 3 * volume * corner[i].value * corner[i].value;
            for (int j = 0; j < 4; ++j)
                if (j != i) term /= corner[i].value - corner[j].value;
            area += term;
        }
        expected.push_back(area);
    }
    // The formula subtracts large terms where two corners are nearly level: ten digits of sixteen stay.
    course::check_close(got, expected, {1e-6, 1e-6}, "area that faces down the slope", "tetrahedron");
}

TEST_CASE("a ball is closed, and as large as it should be") {
    course::set_hint(3);
    // Each side of a triangle is met once in each direction. Vertices are found by their place: neighbours
    // may round differently in the last digits.
    std::map<std::array<long, 6>, int> sides;
    double volume = 0, area = 0;
    for (const TetTriangle& t : ball(12)) {
        if (!(glm::dot(t[0], t[0]) < 10)) {  // not on the ball at all
            CHECK_MESSAGE(false, "a vertex lies outside of the box");
            return;
        }
        for (int k = 0; k < 3; ++k) {
            const auto number = [](double x) { return std::lround(x * 1e9); };
            const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3];
            ++sides[{number(a.x), number(a.y), number(a.z), number(b.x), number(b.y), number(b.z)}];
            --sides[{number(b.x), number(b.y), number(b.z), number(a.x), number(a.y), number(a.z)}];
        }
        volume += glm::dot(t[0], glm::cross(t[1], t[2])) / 6;
        area += 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
    }
    int open = 0;
    for (const auto& [side, balance] : sides) open += balance != 0;
    CHECK(open == 0);
    const double pi = 3.14159265358979323846;
    // Chords cut corners: the relative error is near (h/r)^2 = 0.043 times a factor below 1.
    CHECK(volume == doctest::Approx(4 * pi / 3 * 0.512).epsilon(0.04));
    CHECK(area == doctest::Approx(4 * pi * 0.64).epsilon(0.04));
}
