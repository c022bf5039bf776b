// Chapter 10: extreme cases. Each ends in a right answer or in a clear error.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "10_water_sph/run.cuh"
#include "10_water_sph/sph_cpu.h"
#include "10_water_sph/study_water.cuh"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif
#include "tests/support/course_test.h"

namespace {

using sph::at_rest;
using sph::Box;
using sph::EquationOfState;
using sph::Fluid;
using sph::Water;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const Box kUnitBox{{0, 0, 0}, {1, 1, 1}};

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

Water make_water(const std::vector<float4>& position, const Fluid& fluid = {}, const Box& box = kUnitBox) {
    return Water(fluid, box, EquationOfState::linear, position, at_rest(position.size()));
}

/// What the check of the state says after some steps; empty if it finds nothing wrong.
std::string verdict_after(Water& water, int steps, float dt_s) {
    for (int step = 0; step < steps; ++step) water.step(dt_s);
    try {
        sph::check_state(water, sph::Summarizer(water.size())(water), steps, dt_s);
    } catch (const course::Unstable& error) {
        return error.what();
    }
    return "";
}

/// The sentence with which this water is refused; empty if it is not.
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

void check_against_cpu(const std::vector<float4>& position, const Fluid& fluid, const Box& box) {
    const auto density = sph::density_cpu(position, fluid, box);
    const auto exact = sph::acceleration_cpu<EquationOfState::linear>(position, at_rest(position.size()),
                                                                      density, fluid, box);
    const Water water = make_water(position, fluid, box);
    std::vector<float4> expected;
    double largest = 0;
    for (const glm::dvec3& a : exact) {
        expected.push_back(make_float4(float(a.x), float(a.y), float(a.z), 0));
        largest = std::max({largest, std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    }
    // fp32 sums of one sign: a few 1e-7 for 30 terms, growing with the root of their number.
    course::check_close(by_id(water, water.densities()), std::vector<float>(density.begin(), density.end()),
                        {0, 1e-5}, "density");
    // Forces cancel: the error is relative to the largest.
    course::check_close(by_id(water, water.accelerations()), expected, {5e-5 * largest}, "acceleration");
}

}  // namespace

TEST_CASE("no particle, one, two: no error, and the forces of the formula") {
    Water none = make_water({});
    CHECK(verdict_after(none, 3, 1e-3f).empty());
    CHECK(none.size() == 0);

    Fluid fluid;
    const Water one = make_water({make_float4(0.5f, 0.5f, 0.5f, 0)});
    const double self = 315 / (64 * sph::kPi) * fluid.mass_kg / std::pow(double(fluid.support_m), 3);
    CHECK(one.densities().download()[0] == doctest::Approx(self).epsilon(1e-6));
    CHECK(one.accelerations().download()[0].y == fluid.gravity_m_per_s2.y);

    // Two, heavy enough to press on each other, half a support radius apart along x.
    fluid.mass_kg = 1;
    const float r = 0.5f * fluid.support_m;
    const Water two =
        make_water({make_float4(0.5f, 0.5f, 0.5f, 0), make_float4(0.5f + r, 0.5f, 0.5f, 0)}, fluid);
    const double h = fluid.support_m, w0 = 315 / (64 * sph::kPi) / (h * h * h), w = w0 * 0.75 * 0.75 * 0.75;
    const double rho = fluid.mass_kg * (w0 + w), pressure = 100 * (rho - 1000);
    const double push = fluid.mass_kg * 2 * pressure / (rho * rho) * 45 / (sph::kPi * h * h * h * h) * 0.25;
    const auto a = by_id(two, two.accelerations());
    CHECK(a[0].x == doctest::Approx(-push).epsilon(1e-5));  // r is rounded twice: 0.5 + r is not exact
    CHECK(a[1].x == doctest::Approx(push).epsilon(1e-5));
    CHECK(a[0].y == fluid.gravity_m_per_s2.y);
}

TEST_CASE("all particles at one point: they fall together, and the check says how they are pressed") {
    const std::size_t n = 1000;
    const std::vector<float4> position(n, make_float4(0.5f, 0.5f, 0.5f, 0));
    Water water = make_water(position);
    const Fluid& fluid = water.fluid();
    const double self = 315 / (64 * sph::kPi) * fluid.mass_kg / std::pow(double(fluid.support_m), 3);
    for (float rho : water.densities().download()) CHECK(rho == doctest::Approx(n * self).epsilon(1e-5));
    // No direction to push in: gravity is all that is left, and nothing is NaN.
    for (const float4& a : water.accelerations().download()) {
        CHECK(a.x == 0);
        CHECK(a.y == fluid.gravity_m_per_s2.y);
    }
    CHECK(says(verdict_after(water, 1, 1e-4f), "times the rest density"));
}

TEST_CASE("two particles at the same place stay together and do not disturb the others") {
    auto position = random_points(500, 0.3f, 0.7f);
    position[7] = position[6];
    Fluid fluid;
    check_against_cpu(position, fluid, kUnitBox);
    Water water = make_water(position, fluid);
    for (int step = 0; step < 20; ++step) water.step(1e-4f);
    const auto x = by_id(water, water.positions());
    // The same sums in the same order: not only close, the same bits.
    CHECK((x[6].x == x[7].x && x[6].y == x[7].y && x[6].z == x[7].z));
    CHECK(std::isfinite(x[6].x));
}

TEST_CASE("all in one cell: every pair is a pair, and no memory but what N explains") {
    const std::size_t n = 1500;
    Fluid fluid;
    fluid.mass_kg = 1000 * 0.02f * 0.02f * 0.02f / n;  // the rest density, in a fifth of the support radius
    check_against_cpu(random_points(n, 0.51f, 0.53f), fluid, kUnitBox);
}

TEST_CASE("a velocity of 1e6 m/s is named, at the start or after a step") {
    const auto position = random_points(100, 0.2f, 0.8f);
    auto velocity = at_rest(100);
    velocity[42].y = 1e6f;
    Water water(Fluid{}, kUnitBox, EquationOfState::linear, position, velocity);
    const std::string start = verdict_after(water, 0, 1e-3f);
    CHECK(says(start, "particle 42 "));
    CHECK(says(start, "faster than sound"));
    for (int step = 0; step < 5; ++step) water.step(1e-3f);  // it hits the wall, and all is finite again
    for (const float4& x : water.positions().download())
        CHECK((x.x >= 0 && x.x <= 1 && x.y >= 0 && x.y <= 1 && x.z >= 0 && x.z <= 1));
}

TEST_CASE("dt = 0 moves nothing, a tiny dt next to nothing, a huge one is found out") {
    const auto scenes = sph::all_scenes();
    sph::Settings settings;
    settings.scene = sph::find_scene(scenes, "dam_break");
    settings.particles = 1000;
    for (float dt_s : {0.0f, 1e-30f}) {
        sph::Start start = sph::make_start(settings);
        const std::uint64_t before = sph::state_hash(start.water);
        const auto x = by_id(start.water, start.water.positions());
        CHECK(verdict_after(start.water, 10, dt_s).empty());
        if (dt_s == 0) CHECK(sph::state_hash(start.water) == before);
        course::check_close(by_id(start.water, start.water.positions()), x, {0.0}, "position");
    }
    for (float dt_s : {0.1f, 1.0f, 1e3f, 1e10f, 1e30f, 3e38f}) {
        sph::Start start = sph::make_start(settings);
        const std::string verdict = verdict_after(start.water, 10, dt_s);
        CHECK_MESSAGE(says(verdict, "is over the limit 0.00"), dt_s << ": " << verdict);
    }
}

TEST_CASE("stiffness 0 is refused, 1e12 is the same water in another unit of time") {
    Fluid fluid;
    const auto position = random_points(500, 0.3f, 0.6f);
    fluid.sound_speed_m_per_s = 0;
    CHECK(says(refusal([&] { make_water(position, fluid); }), "sound speed must be above 0"));

    // Without gravity and viscosity, c times 2^40 and dt divided by it is the same motion, bit for bit, since
    // a power of two rounds nothing.
    fluid.gravity_m_per_s2 = {0, 0, 0};
    fluid.sound_speed_m_per_s = 1;
    Water soft = make_water(position, fluid);
    fluid.sound_speed_m_per_s = 0x1p40f;  // 1.1e12 m/s
    Water hard = make_water(position, fluid);
    const float dt_s = sph::time_step_limit(fluid).smallest_s();
    for (int step = 0; step < 20; ++step) {
        soft.step(dt_s * 0x1p40f);
        hard.step(dt_s);
    }
    const auto x = by_id(soft, soft.positions());
    course::check_close(by_id(hard, hard.positions()), x, {0.0}, "position");
    CHECK(x[0].x != position[0].x);  // and it is a motion
    // With the step of soft water it explodes, and says so.
    CHECK(says(verdict_after(hard, 10, 1e-3f), "is over the limit"));
}

TEST_CASE("a start that is none is refused, and the sentence names the particle") {
    const auto good = random_points(20, 0.2f, 0.8f);
    for (float bad : {kNan, kInfinity, -kInfinity, 1.001f, -1e-6f, 1e30f})
        for (int axis = 0; axis < 3; ++axis) {
            auto position = good;
            (axis == 0 ? position[13].x : axis == 1 ? position[13].y : position[13].z) = bad;
            const std::string sentence = refusal([&] { make_water(position); });
            CHECK_MESSAGE((says(sentence, "particle 13 ") && says(sentence, "not inside the box")), sentence);
        }
    auto velocity = at_rest(20);
    velocity[5].z = kNan;
    const std::string sentence =
        refusal([&] { Water(Fluid{}, kUnitBox, EquationOfState::linear, good, velocity); });
    CHECK_MESSAGE((says(sentence, "particle 5 ") && says(sentence, "no velocity")), sentence);
    velocity.pop_back();
    CHECK(says(refusal([&] { Water(Fluid{}, kUnitBox, EquationOfState::linear, good, velocity); }),
               "20 positions"));
    // On the wall itself is inside.
    auto edge = good;
    edge[0] = make_float4(0, 1, 0, 0);
    CHECK(refusal([&] { make_water(edge); }).empty());
}

TEST_CASE("a fluid of impossible numbers is refused before anything is made of it") {
    struct Case {
        float Fluid::*member;
        const char* name;
    };
    for (const Case& wrong :
         {Case{&Fluid::support_m, "support radius"}, Case{&Fluid::mass_kg, "mass"},
          Case{&Fluid::rest_density_kg_per_m3, "rest density"},
          Case{&Fluid::sound_speed_m_per_s, "sound speed"}, Case{&Fluid::viscosity_m2_per_s, "viscosity"}})
        for (float value : {-1.0f, kNan, kInfinity}) {
            Fluid fluid;
            fluid.*wrong.member = value;
            const std::string sentence = refusal([&] { make_water({}, fluid); });
            CHECK_MESSAGE(says(sentence, wrong.name), sentence);
        }
    Fluid fluid;
    fluid.gravity_m_per_s2.x = kNan;
    CHECK(says(refusal([&] { make_water({}, fluid); }), "gravity"));
}

TEST_CASE("a box thinner than the support radius, turned inside out, or no box at all is refused") {
    for (float width : {0.099f, 0.0f, -1.0f, kNan})
        for (int axis = 0; axis < 3; ++axis) {
            Box box = kUnitBox;
            (axis == 0 ? box.high_m.x : axis == 1 ? box.high_m.y : box.high_m.z) = width;
            CHECK(says(refusal([&] { make_water({}, Fluid{}, box); }),
                       "less than the support radius of 0.1 m"));
        }
    Box just_wide_enough = kUnitBox;
    just_wide_enough.high_m.y = Fluid{}.support_m;
    // The narrowest box that is allowed has each particle in reach of both walls, and is still right.
    std::vector<float4> position = random_points(200, 0.0f, 0.1f);
    Fluid fluid;
    fluid.mass_kg = 1e-2f;
    check_against_cpu(position, fluid, just_wide_enough);
}

TEST_CASE("far from the origin: as exact as coordinates are there, and refused where they are too coarse") {
    const Fluid fluid;  // support 0.1 m: coordinates may be 1e-4 m apart
    const auto box_at = [](float d) { return Box{{d, d, d}, {d + 1, d + 1, d + 1}}; };
    for (float d : {1e4f, -1e4f, 1e7f, 1e30f}) {
        const std::string sentence = refusal([&] { make_water({}, fluid, box_at(d)); });
        CHECK_MESSAGE(!sentence.empty(), d);
        if (std::abs(d) < 1e5f)
            CHECK_MESSAGE(says(sentence, "fp32 coordinates are 0.000976562 m apart"), sentence);
    }
    // A box at 1e4 m for particles of metres is fine: what counts is the resolution in support radii.
    // Coordinates there are exact multiples of 2^-10 m, so the reference sees the same places, and the
    // differences of places, which are all that the sums use, are exact too.
    Fluid coarse = fluid;
    coarse.support_m = 2;
    coarse.mass_kg = 1000;
    auto position = random_points(300, 0, 8);
    for (float4& x : position) x = make_float4(x.x + 1e4f, x.y + 1e4f, x.z + 1e4f, 0);
    check_against_cpu(position, coarse, {{1e4f, 1e4f, 1e4f}, {10008, 10008, 10008}});
}

TEST_CASE("memory is what N explains, however large the box and however crowded the place") {
#ifndef __CUDASIM__
    course::require_simulator();
#else
    const Box hall{{0, 0, 0}, {100, 100, 100}};  // 1e9 cells of one support radius
    for (std::size_t n : {std::size_t(0), std::size_t(1), std::size_t(2), std::size_t(2000)})
        for (const Box& box : {kUnitBox, hall}) {
            const std::vector<float4> position(n, make_float4(0.5f, 0.5f, 0.5f, 0));
            cudasim::Recording making;
            Water water = make_water(position, Fluid{}, box);
            CHECK(making.bytes() == n * water.bytes_per_particle() + water.cell_bytes());
            CHECK(water.cell_count() <= 4096 + 4 * n);
            // Two numbers a cell, and the scan's sums of chunks, which are fewer than cells.
            CHECK(water.cell_bytes() <= 3 * sizeof(std::uint32_t) * (4096 + 4 * n + 2));
            cudasim::Recording stepping;
            water.step(1e-4f);
            CHECK(stepping.allocations() == 0);
        }
#endif
}
