// Chapter 09: extreme cases. Each ends in a right answer or in a clear error.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "09_water_spring_mass/marbles_cpu.h"
#include "09_water_spring_mass/run.cuh"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif
#include "tests/support/course_test.h"

namespace {

using namespace spring_mass;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const Box kUnitBox{{0, 0, 0}, {1, 1, 1}};

std::vector<float4> at_rest(std::size_t n) {
    return std::vector<float4>(n, make_float4(0, 0, 0, 0));
}

std::vector<float4> random_points(std::size_t n, float low_m, float high_m) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(low_m, high_m);
    std::vector<float4> points(n);
    for (float4& x : points) {
        x.x = place(random);
        x.y = place(random);
        x.z = place(random);
        x.w = 0;
    }
    return points;
}

Marbles make_marbles(const std::vector<float4>& position, const Material& material = {},
                     const Box& box = kUnitBox) {
    return Marbles(material, box, position, at_rest(position.size()));
}

/// What the check of the state says after some steps; empty if it finds nothing wrong.
std::string verdict_after(Marbles& marbles, int steps, float dt_s) {
    Summarizer summarize(marbles.size());
    const double start_J = summarize(marbles).energy_J();
    for (int step = 0; step < steps; ++step) marbles.step(dt_s);
    try {
        check_state(marbles, summarize(marbles), start_J, steps, dt_s);
    } catch (const course::Unstable& error) {
        return error.what();
    }
    return "";
}

/// The sentence with which these marbles are refused; empty if they are not.
template <class Make>
std::string refusal(Make make) {
    try {
        make();
    } catch (const course::BadInput& error) {
        return error.what();
    }
    return "";
}

bool says(const std::string& sentence, const std::string& part) {
    return sentence.find(part) != std::string::npos;
}

/// Accelerations of the kernels against the reference that looks at all pairs.
void check_against_cpu(const std::vector<float4>& position, const Material& material, const Box& box,
                       double relative) {
    MarblesCpu reference{in_double(material),
                         glm::dvec3(as_vec3(box.low_m)),
                         glm::dvec3(as_vec3(box.high_m)),
                         {},
                         std::vector<glm::dvec3>(position.size(), glm::dvec3(0))};
    for (const float4& p : position) reference.position.push_back({p.x, p.y, p.z});
    forces_cpu(reference, reference.velocity);
    std::vector<float4> expected;
    double largest = 0;
    for (const glm::dvec3& force : reference.force_N) {
        const glm::vec3 a(force / double(material.mass_kg));
        expected.push_back(make_float4(a.x, a.y, a.z, 0));
        largest = std::max({largest, std::abs(double(a.x)), std::abs(double(a.y)), std::abs(double(a.z))});
    }
    const Marbles marbles = make_marbles(position, material, box);
    course::check_close(by_id(marbles, marbles.accelerations()), expected, {relative * largest},
                        "acceleration");
}

}  // namespace

TEST_CASE("no marble, one, two: no error, and the forces of the formula") {
    Marbles none = make_marbles({});
    CHECK(verdict_after(none, 3, 1e-3f).empty());
    CHECK(none.size() == 0);
    const Material material;
    const Marbles one = make_marbles({make_float4(0.5f, 0.5f, 0.5f, 0)});
    CHECK(one.accelerations().download()[0].y == material.gravity_m_per_s2.y);
    // Two, pressed into each other by a quarter of a diameter: k d / 4 each.
    const float r = 0.75f * material.diameter_m;
    const Marbles two =
        make_marbles({make_float4(0.5f, 0.5f, 0.5f, 0), make_float4(0.5f + r, 0.5f, 0.5f, 0)});
    const double push = material.stiffness_N_per_m * 0.25 * material.diameter_m / material.mass_kg;
    const auto a = by_id(two, two.accelerations());
    CHECK(a[0].x == doctest::Approx(-push).epsilon(2e-5));  // 0.5 + r is rounded to 6e-8 m
    CHECK(a[1].x == doctest::Approx(push).epsilon(2e-5));
    CHECK(a[0].y == material.gravity_m_per_s2.y);
}

TEST_CASE("two marbles at the very same place push each other apart, and no momentum appears") {
    Material material;
    material.gravity_m_per_s2 = glm::vec3(0);
    material.tangential_damping_per_s = 10;
    Marbles marbles =
        make_marbles({make_float4(0.5f, 0.5f, 0.5f, 0), make_float4(0.5f, 0.5f, 0.5f, 0)}, material);
    const float push = material.stiffness_N_per_m * material.diameter_m / material.mass_kg;
    const auto a = by_id(marbles, marbles.accelerations());
    CHECK(a[0].y == doctest::Approx(-push));
    CHECK(a[1].y == doctest::Approx(push));
    const float dt_s = 0.1f * time_step_limit_s(material);
    CHECK(verdict_after(marbles, 300, dt_s).empty());
    const auto x = by_id(marbles, marbles.positions()), v = by_id(marbles, marbles.velocities());
    CHECK(x[1].y - x[0].y > material.diameter_m);
    CHECK(v[0].y == doctest::Approx(-v[1].y));
    // All of k d^2 / 2 is motion now: 2 x m v^2 / 2. 1 %: (omega dt)^2 / 4 is 0.06 %, and fp32 places.
    CHECK(material.mass_kg * v[0].y * v[0].y ==
          doctest::Approx(0.5f * material.stiffness_N_per_m * material.diameter_m * material.diameter_m)
              .epsilon(0.01));
}

TEST_CASE("all marbles at one point: finite forces, no lost pair, and no energy from nowhere") {
    const std::uint32_t n = 500;
    Material material;
    Marbles marbles = make_marbles(std::vector<float4>(n, make_float4(0.5f, 0.5f, 0.5f, 0)), material);
    const Summary now = Summarizer(n)(marbles);
    CHECK(now.contacts == doctest::Approx(double(n) * (n - 1)));  // longer than any list: all are found
    const double pair_J = 0.5 * material.stiffness_N_per_m * material.diameter_m * material.diameter_m;
    CHECK(now.elastic_J == doctest::Approx(pair_J * n * (n - 1) / 2).epsilon(1e-5));
    // With 500 contacts each the limit of the step is far below that of any packing: omega^2 <= 2 z k / m.
    CHECK(verdict_after(marbles, 1000, 0.02f * time_step_limit_s(material)) == "");
    for (const float4& x : marbles.positions().download()) CHECK(std::isfinite(x.x + x.y + x.z));
}

TEST_CASE("all in one cell: every pair is a pair, and no memory but what N explains") {
    Material material;
    material.gravity_m_per_s2 = glm::vec3(0);
    // Hundreds of pushes that nearly cancel, each of overlaps known to 6e-8 m of 0.015.
    check_against_cpu(random_points(800, 0.51f, 0.518f), material, kUnitBox, 2e-5);
}

TEST_CASE("a velocity of 1e6 m/s: the check says that its contacts can't be seen with this step") {
    const auto position = random_points(100, 0.2f, 0.8f);
    auto velocity = at_rest(100);
    velocity[42].y = 1e6f;
    Marbles marbles(Material{}, kUnitBox, position, velocity);
    const std::string start = verdict_after(marbles, 0, 1e-3f), later = verdict_after(marbles, 3, 1e-3f);
    for (const std::string& verdict : {start, later}) {
        CHECK(says(verdict, "marble 42 "));
        CHECK(says(verdict, "diameters per step"));
    }
    for (const float4& x : marbles.positions().download()) CHECK(std::isfinite(x.x + x.y + x.z));
    // With a step for that speed it is a marble like any other: it hits the wall and comes back.
    Marbles again(Material{}, kUnitBox, position, velocity);
    CHECK(verdict_after(again, 100, 1e-9f).empty());
}

TEST_CASE("dt = 0 moves nothing, a tiny dt next to nothing, a huge one is found out") {
    Settings settings;
    settings.scene = find_scene(all_scenes(), "dam_break");
    settings.particles = 1000;
    for (float dt_s : {0.0f, 1e-30f}) {
        Start start = make_start(settings);
        const auto x = by_id(start.marbles, start.marbles.positions());
        CHECK(verdict_after(start.marbles, 10, dt_s).empty());
        course::check_close(by_id(start.marbles, start.marbles.positions()), x, {0.0}, "position");
    }
    for (float dt_s : {0.1f, 1.0f, 1e3f, 1e10f, 1e30f, 3e38f}) {
        Start start = make_start(settings);
        const std::string verdict = verdict_after(start.marbles, 20, dt_s);
        CHECK_MESSAGE(says(verdict, "is over the limit 0.00"), dt_s << ": " << verdict);
    }
}

TEST_CASE("stiffness 0 is marbles that do not meet; 1e12 is the same in another unit of time") {
    Material material;
    material.gravity_m_per_s2 = glm::vec3(0);
    const auto position = random_points(400, 0.3f, 0.45f);
    material.stiffness_N_per_m = 0;
    for (const float4& a : make_marbles(position, material).accelerations().download())
        CHECK((a.x == 0 && a.y == 0 && a.z == 0));
    // Nothing but springs: k times 2^40 and dt divided by 2^20 is the same motion, bit for bit, since a power
    // of two rounds nothing.
    material.stiffness_N_per_m = 1;
    Marbles soft = make_marbles(position, material);
    material.stiffness_N_per_m = 0x1p40f;  // 1.1e12 N/m
    Marbles hard = make_marbles(position, material);
    const float dt_s = 0.5f * time_step_limit_s(material);
    for (int step = 0; step < 20; ++step) {
        soft.step(dt_s * 0x1p20f);
        hard.step(dt_s);
    }
    const auto x = by_id(soft, soft.positions());
    course::check_close(by_id(hard, hard.positions()), x, {0.0}, "position");
    double moved = 0;
    for (std::size_t i = 0; i < x.size(); ++i) moved += std::abs(x[i].x - position[i].x);
    CHECK(moved > 0.01);  // and it is a motion
    CHECK(says(verdict_after(hard, 10, 1e-3f), "is over the limit"));
}

TEST_CASE("a start that is none is refused, and the sentence names the marble") {
    const auto good = random_points(20, 0.2f, 0.8f);
    for (float bad : {kNan, kInfinity, -kInfinity, 1.001f, -1e-6f, 1e30f})
        for (int axis = 0; axis < 3; ++axis) {
            auto position = good;
            (axis == 0 ? position[13].x : axis == 1 ? position[13].y : position[13].z) = bad;
            const std::string sentence = refusal([&] { make_marbles(position); });
            CHECK_MESSAGE((says(sentence, "marble 13 ") && says(sentence, "not inside the box")), sentence);
        }
    auto velocity = at_rest(20);
    velocity[5].z = kNan;
    const std::string sentence = refusal([&] { Marbles(Material{}, kUnitBox, good, velocity); });
    CHECK_MESSAGE((says(sentence, "marble 5 ") && says(sentence, "no velocity")), sentence);
    velocity.pop_back();
    CHECK(says(refusal([&] { Marbles(Material{}, kUnitBox, good, velocity); }), "20 positions"));
    // On the wall itself is inside, and is pushed away from it.
    auto edge = good;
    edge[0] = make_float4(0, 1, 0, 0);
    CHECK(by_id(make_marbles(edge), make_marbles(edge).accelerations())[0].x > 0);
}

TEST_CASE("a material of impossible numbers is refused before anything is made of it") {
    struct Case {
        float Material::*member;
        const char* name;
    };
    for (const Case& wrong :
         {Case{&Material::diameter_m, "diameter"}, Case{&Material::mass_kg, "mass"},
          Case{&Material::stiffness_N_per_m, "stiffness"},
          Case{&Material::normal_damping_per_s, "normal damping"},
          Case{&Material::tangential_damping_per_s, "tangential damping"},
          Case{&Material::friction, "friction"}, Case{&Material::attraction_N_per_m, "attraction"},
          Case{&Material::drag_per_s, "drag"}})
        for (float value : {-1.0f, kNan, kInfinity}) {
            Material material;
            material.*wrong.member = value;
            const std::string sentence = refusal([&] { make_marbles({}, material); });
            CHECK_MESSAGE(says(sentence, wrong.name), sentence);
        }
    Material material;
    material.diameter_m = 0;
    CHECK(says(refusal([&] { make_marbles({}, material); }), "diameter must be above 0"));
    material = {};
    material.gravity_m_per_s2.x = kNan;
    CHECK(says(refusal([&] { make_marbles({}, material); }), "gravity"));
    for (float skin : {-0.1f, kNan, kInfinity, 11.0f})
        CHECK(says(refusal([&] { Marbles(Material{}, kUnitBox, {}, {}, skin); }), "skin"));
}

TEST_CASE("a box thinner than a marble, turned inside out, or no box at all is refused") {
    for (float width : {0.0149f, 0.0f, -1.0f, kNan, kInfinity})
        for (int axis = 0; axis < 3; ++axis) {
            Box box = kUnitBox;
            (axis == 0 ? box.high_m.x : axis == 1 ? box.high_m.y : box.high_m.z) = width;
            CHECK(!refusal([&] { make_marbles({}, Material{}, box); }).empty());
        }
    // As wide as a marble and a half: each marble is held by both walls, and still right.
    Box narrow = kUnitBox;
    narrow.high_m.y = 0.0225f;
    check_against_cpu(random_points(200, 0.0f, 0.0225f), Material{}, narrow, 2e-5);
}

TEST_CASE("far from the origin: as exact as coordinates are there, and refused where they are too coarse") {
    const Material material;  // 0.015 m: coordinates may be 1.5e-6 m apart
    const auto box_at = [](float d) { return Box{{d, d, d}, {d + 1, d + 1, d + 1}}; };
    for (float d : {1e4f, -1e4f, 1e7f, 1e30f}) {
        const std::string sentence = refusal([&] { make_marbles({}, material, box_at(d)); });
        CHECK_MESSAGE(!sentence.empty(), d);
        if (std::abs(d) < 1e5f)
            CHECK_MESSAGE(says(sentence, "fp32 coordinates are 0.000976562 m apart"), sentence);
    }
    // Marbles of 16 m are welcome there. Coordinates are multiples of 2^-10 m, so the reference sees the same
    // places, and differences are exact.
    Material large = material;
    large.diameter_m = 16;
    auto position = random_points(300, 0, 60);
    for (float4& x : position) x = make_float4(x.x + 1e4f, x.y + 1e4f, x.z + 1e4f, 0);
    check_against_cpu(position, large, {{1e4f, 1e4f, 1e4f}, {10060, 10060, 10060}}, 2e-5);
}

TEST_CASE("memory is what N explains, however large the box and however crowded the place") {
#ifndef __CUDASIM__
    course::require_simulator();
#else
    const Box hall{{0, 0, 0}, {15, 15, 15}};  // 4e8 cells of one marble
    for (std::size_t n : {std::size_t(0), std::size_t(1), std::size_t(33), std::size_t(500)})
        for (const Box& box : {kUnitBox, hall}) {
            const std::vector<float4> position(n, make_float4(0.5f, 0.5f, 0.5f, 0));
            cudasim::Recording making;
            Marbles marbles = make_marbles(position, Material{}, box);
            const std::size_t outdated = sizeof(std::uint32_t);  // the word that tells that the lists are
            CHECK(making.bytes() == n * Marbles::kBytesPerMarble + marbles.cell_bytes() + outdated);
            CHECK(marbles.cell_count() <= 4096 + 4 * n);
            cudasim::Recording stepping;
            marbles.step(1e-5f);
            CHECK(stepping.allocations() == 0);
        }
#endif
}
