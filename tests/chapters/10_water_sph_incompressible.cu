// Chapter 10: position based fluids against answers that are not ours: free fall, hydrostatics, momentum, the
// density that was asked for; and extreme cases.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "10_water_sph/pbf_cpu.h"
#include "10_water_sph/study_pbf.cuh"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"

namespace {

using sph::at_rest;
using sph::Box;
using sph::by_id;
using sph::Fluid;
using sph::PbfChoice;
using sph::PbfWater;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const Box kUnitBox{{0, 0, 0}, {1, 1, 1}};

/// A column of water in a shaft that it fills from wall to wall, at rest.
struct Column {
    explicit Column(const PbfChoice& choice, std::uint32_t particles = 7 * 7 * 14)  // 0.4 m high
        : water(make(choice, particles, spacing_m)) {}
    static PbfWater make(const PbfChoice& choice, std::uint32_t particles, float& spacing_m) {
        const sph::Scene shaft = sph::still_column();
        const auto points = sph::fill_block(shaft, particles, 1, spacing_m);
        return PbfWater(sph::make_fluid(shaft, spacing_m), shaft.tank, choice, points,
                        at_rest(points.size()));
    }
    float spacing_m = 0;
    PbfWater water;
};

glm::dvec3 momentum(const std::vector<float4>& velocity) {
    glm::dvec3 sum(0);
    for (const float4& v : velocity) sum += glm::dvec3(v.x, v.y, v.z);
    return sum;
}

/// What the check of the state says after some steps; empty if it finds nothing wrong.
std::string verdict_after(PbfWater& water, int steps, float dt_s) {
    for (int step = 0; step < steps; ++step) water.step(dt_s);
    try {
        sph::check_state(water, sph::Summarizer(water.size())(water), steps, dt_s);
    } catch (const course::Unstable& error) {
        return error.what();
    }
    return "";
}

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

}  // namespace

TEST_CASE("position based fluids: a step agrees with the CPU reference") {
    course::set_seed(4);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    const Box box{{-0.1f, 0, 0.2f}, {0.2f, 0.2f, 0.4f}};
    std::vector<float4> position, velocity;  // a lattice between all six walls, shaken through
    const auto place = [&](float low, int k) {
        return low + 0.025f * (k + 0.5f + 0.6f * (unit(random) - 0.5f));
    };
    for (int i = 0; i < 12 * 8 * 8; ++i) {
        const float x = place(-0.1f, i % 12), y = place(0, i / 12 % 8), z = place(0.2f, i / 96);
        position.push_back(make_float4(x, y, z, 0));
        velocity.push_back(make_float4(unit(random), unit(random) - 2, -unit(random), 0));
    }
    const std::size_t n = position.size();
    position[7] = position[6];
    for (const float viscosity : {0.0f, 0.01f}) {
        Fluid fluid;
        fluid.support_m = 0.05f;
        fluid.mass_kg = 1000 * 0.3f * 0.2f * 0.2f / n;
        fluid.viscosity_m2_per_s = viscosity;
        PbfChoice choice;
        choice.max_corrections = 2;
        choice.tolerance = 0;  // never reached here: exactly two
        // Two corrections before the first step as well, which give nobody velocity.
        PbfWater water(fluid, box, choice, position, velocity);
        sph::PbfState<double> state{
            sph::points_of(position), sph::points_of(velocity), std::vector<double>(n, 0.0), {}};
        for (int k = 0; k < 2; ++k) {
            const auto change = sph::constraint_cpu<double>(state, 1, water.least_norm(), fluid, box);
            sph::move_cpu<double>(state, sph::shift_cpu(state.position, change, fluid, box), 0, box);
        }
        state.multiplier.assign(n, 0.0);
        const float dt = 1e-4f;  // short: nobody comes from beyond the cells that are searched
        for (int step = 0; step < 2; ++step) {
            water.step(dt);
            // Two numbers that are fp32 in the kernels, the part kept and dt, are what they are there.
            sph::pbf_step_cpu<double>(state, dt, step == 0 ? 0.5 * dt : dt, step == 0 ? 0.0 : choice.kept, 2,
                                      water.least_norm(), fluid, box);
        }
        std::vector<float> density(state.density.begin(), state.density.end());
        std::vector<float4> expected;
        double largest = 0;
        for (const auto& x : state.position) expected.push_back(make_float4(x.x, x.y, x.z, 0));
        for (const auto& v : state.velocity) largest = std::max(largest, sph::distance(v));
        // Six corrections in a row, each with sums of 30 terms of fp32 and coordinates exact to 3e-8: some
        // 1e-7 m.
        course::check_close(by_id(water, water.positions()), expected, {1e-6}, "position (m)");
        course::check_close(by_id(water, water.densities()), density, {0, 1e-4}, "density");
        // Velocity is displacement / dt: the positions' 1e-6 m over 1e-4 s, against the fastest of hundreds.
        expected.clear();
        for (const auto& v : state.velocity) expected.push_back(make_float4(v.x, v.y, v.z, 0));
        MESSAGE("fastest: " << largest << " m/s");
        course::check_close(by_id(water, water.velocities()), expected, {1e-6 / dt}, "velocity");
    }
}

TEST_CASE("position based fluids: free fall is exact, at any step") {
    const auto fall = [](float dt_s, int steps) {
        const Fluid fluid;
        const float4 start = make_float4(5, 9, 5, 0);
        PbfWater water(fluid, {{0, 0, 0}, {10, 10, 10}}, {}, {start}, {make_float4(1, 2, 0, 0)});
        for (int step = 0; step < steps; ++step) water.step(dt_s);
        const float4 x = water.positions().download()[0];
        const double t = double(dt_s) * steps;
        // 300 additions to coordinates of up to 10 m, each rounded by up to 5e-7 m.
        CHECK(std::abs(x.x - (5 + t)) < 1.5e-4);
        CHECK(std::abs(x.y - (9 + 2 * t - 0.5 * 9.81 * t * t)) < 1.5e-4);
    };
    fall(0.1f, 3);
    fall(0.001f, 300);
}

TEST_CASE("position based fluids: momentum stays, whatever the corrections do") {
    course::set_seed(8);
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<float4> position, velocity;
    for (int i = 0; i < 1000; ++i) {
        const float4 x = make_float4(0.02f * (i % 10), 0.02f * (i / 10 % 10), 0.02f * (i / 100), 0);
        position.push_back(x);  // blown together along x, and drifting
        velocity.push_back(make_float4(0.3f - 20 * (x.x - 0.09f) + 0.5f * unit(random), 0.5f * unit(random),
                                       0.5f * unit(random), 0));
    }
    Fluid fluid;
    fluid.support_m = 0.04f;
    fluid.mass_kg = 0.008f;
    fluid.gravity_m_per_s2 = {0, 0, 0};
    fluid.viscosity_m2_per_s = 0.01f;
    PbfChoice choice;
    choice.tolerance = 1e-4f;
    PbfWater water(fluid, {{-4, -4, -4}, {4, 4, 4}}, choice, position, velocity);
    const glm::dvec3 before = momentum(velocity);
    int corrections = 0;
    for (int step = 0; step < 40; ++step) {
        water.step(2e-3f);
        corrections += water.report().corrections;
    }
    CHECK(corrections > 80);  // there was something to do
    const auto after = water.velocities().download();
    double moved = 0;
    for (const float4& u : after) moved += std::abs(u.x) + std::abs(u.y) + std::abs(u.z);
    const glm::dvec3 change = momentum(after) - before;
    // As with equations of state: each correction rounds every velocity by up to 6e-8 of it, at random.
    for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(change[axis]) < 3e-6 * moved);
}

TEST_CASE("position based fluids: the density that was asked for is the density that is there") {
    sph::Settings settings = sph::dam_break_settings(false);
    for (const float tolerance : {0.01f, 0.002f}) {
        settings.pbf.tolerance = tolerance;
        settings.pbf.max_corrections = 200;
        sph::PbfStart start = sph::make_pbf_start(settings);
        int corrections = 0;
        for (int step = 1; step <= 60; ++step) {
            start.water.step(start.dt_s);
            corrections += start.water.report().corrections;
            CHECK(start.water.report().mean_compression <= tolerance);
            if (step % 20 != 0) continue;
            // Not by its own account: equations of state look at the same places, with a grid made for them.
            const sph::Water fresh(start.water.fluid(), start.water.box(), sph::EquationOfState::linear,
                                   by_id(start.water, start.water.positions()), at_rest(settings.particles));
            double mean = 0;
            float highest = 0;
            for (float rho : fresh.densities().download()) {
                mean += std::max(rho / 1000 - 1, 0.0f) / settings.particles;
                highest = std::max(highest, rho / 1000 - 1);
            }
            // A hundredth of the tolerance: those who came from beyond the searched cells.
            CHECK(mean <= 1.01 * tolerance);
            CHECK(std::abs(highest - start.water.report().highest_compression) < 0.01);
        }
        MESSAGE("tolerance " << tolerance << ": " << corrections / 60.0 << " corrections a step");
        CHECK(corrections >= 60);
    }
}

TEST_CASE("position based fluids: a still tank stays still, and its pressure is rho g d") {
    PbfChoice choice;
    choice.tolerance = 0.001f;
    choice.max_corrections = 200;
    Column column(choice);
    PbfWater& water = column.water;
    const float dt = 3e-3f;
    const int steps = int(1.0 / dt), first_averaged = steps * 6 / 10;
    std::vector<double> pressure(10, 0.0), depth(10, 0.0), samples(10, 0.0);  // layers of 4 cm
    double speed = 0;
    for (int step = 0; step < steps; ++step) {
        water.step(dt);
        if (step < first_averaged || step % 10) continue;
        const auto p = water.pressures();
        const auto x = water.positions().download(), v = water.velocities().download();
        for (std::size_t i = 0; i < p.size(); ++i) {
            const int layer = std::clamp(int(x[i].y / 0.04f), 0, 9);
            pressure[layer] += p[i];
            depth[layer] += 0.4 - x[i].y;
            ++samples[layer];
            speed += (v[i].x * v[i].x + v[i].y * v[i].y + v[i].z * v[i].z) /
                     ((steps - first_averaged) / 10.0 * p.size());
        }
    }
    double sum_pd = 0, sum_dd = 0;
    for (int layer = 0; layer < 10; ++layer) {
        if (samples[layer] == 0) continue;
        const double d = depth[layer] / samples[layer], p = pressure[layer] / samples[layer];
        MESSAGE("depth " << d << " m: p / (rho0 g d) " << p / (9810 * d));
        sum_pd += p * d;
        sum_dd += d * d;
    }
    MESSAGE("slope " << sum_pd / sum_dd / 9810 << ", rms speed " << std::sqrt(speed));
    // The sums of the gradient see 0.956 of it on a lattice, as with equations of state (the test "a still
    // column carries its weight"): 5 % for that, and 5 % for layers of 1.4 spacings.
    CHECK(std::abs(sum_pd / sum_dd / 9810 - 1) < 0.1);
    // Gravity gives 0.03 m/s in a step, and pressure takes it away in the same step.
    CHECK(std::sqrt(speed) < 0.03);
}

TEST_CASE("position based fluids: twelve times the step of sound holds, and no more is gained by luck") {
    sph::Settings settings = sph::dam_break_settings(false);
    const Fluid fluid = sph::make_pbf_start(settings).water.fluid();
    // An equation of state that let this water give way by a thousandth would allow this step; Unstable is
    // what it says to four times it (the test "a time step over the limit").
    const float sound_s = 0.4f * fluid.support_m / (6 * fluid.sound_speed_m_per_s);
    settings.dt_s = 12 * sound_s;
    settings.pbf.tolerance = 1e-3f;
    settings.pbf.max_corrections = 200;
    CHECK(sph::pbf_is_stable(settings, 0.4));
    // Ten times that, far beyond the advective limit, must not pass for water that runs.
    settings.dt_s = 120 * sound_s;
    settings.pbf.max_corrections = 10;
    CHECK(!sph::pbf_is_stable(settings, 0.8));
}

TEST_CASE("position based fluids: no particle, one, two") {
    PbfWater none({}, kUnitBox, {}, {}, {});
    none.step(1e-3f);
    CHECK(none.size() == 0);

    Fluid fluid;
    fluid.gravity_m_per_s2 = {0, 0, 0};
    PbfWater one(fluid, kUnitBox, {}, {make_float4(0.5f, 0.5f, 0.5f, 0)}, at_rest(1));
    one.step(1e-3f);
    CHECK(one.positions().download()[0].x == 0.5f);  // nobody pushes

    // Two, too heavy for so little distance, go apart along the line between them, each as far as the other.
    fluid.mass_kg = 1;
    const float r = 0.5f * fluid.support_m;
    PbfWater two(fluid, kUnitBox, {},
                 {make_float4(0.5f, 0.5f, 0.5f, 0), make_float4(0.5f + r, 0.5f, 0.5f, 0)}, at_rest(2));
    const auto x = by_id(two, two.positions());
    CHECK(x[1].x - x[0].x > r);
    // Up to 50 corrections, each rounding two coordinates by up to 3e-8.
    CHECK(std::abs(x[0].x + x[1].x - (1 + r)) < 3e-6);
    CHECK(x[0].y == 0.5f);
    // Already before the first step, and without speed.
    for (const float4& v : two.velocities().download()) CHECK((v.x == 0 && v.y == 0 && v.z == 0));
}

TEST_CASE("position based fluids: extreme cases end in a right answer or in a sentence") {
    const float4 middle = make_float4(0.5f, 0.5f, 0.5f, 0);
    // All at one point: no direction to go apart. They fall together, and the check tells.
    PbfWater point({}, kUnitBox, {}, std::vector<float4>(500, middle), at_rest(500));
    CHECK(says(verdict_after(point, 2, 1e-3f), "times the rest density"));
    for (const float4& x : point.positions().download()) CHECK((x.x == 0.5f && x.y < 0.5f && x.z == 0.5f));

    // 1e6 m/s: the wall stops it, or the check tells.
    std::vector<float4> fast = at_rest(2);
    fast[1] = make_float4(1e6f, 0, 0, 0);
    PbfWater shot({}, kUnitBox, {}, {middle, make_float4(0.2f, 0.2f, 0.2f, 0)}, fast);
    CHECK(says(verdict_after(shot, 1, 2e-7f), "moves at (1e+06"));
    shot.step(1e-3f);
    for (const float4& x : shot.positions().download()) CHECK((x.x >= 0 && x.x <= 1));

    // A step of no time moves nothing; one of 1e-30 s next to nothing; 3e38 s ends at the floor.
    PbfWater still({}, kUnitBox, {}, {middle}, at_rest(1));
    still.step(0);
    CHECK(still.positions().download()[0].y == 0.5f);
    still.step(1e-30f);
    CHECK(still.positions().download()[0].y == 0.5f);
    still.step(3e38f);
    CHECK(still.positions().download()[0].y == 0);

    Fluid honey;
    honey.viscosity_m2_per_s = 1e12f;
    PbfWater sticky(honey, kUnitBox, {}, {middle, make_float4(0.52f, 0.5f, 0.5f, 0)},
                    {make_float4(1, 0, 0, 0), make_float4(0, 0, 0, 0)});
    for (int step = 0; step < 3; ++step) sticky.step(1e-3f);  // thrown to and fro, and never out
    for (const float4& x : sticky.positions().download()) CHECK((x.x >= 0 && x.x <= 1));

    // Refused by name.
    const auto made = [&](const std::vector<float4>& x, const Box& box, const PbfChoice& choice) {
        return refusal([&] { PbfWater({}, box, choice, x, at_rest(x.size())); });
    };
    CHECK(says(made({make_float4(2, 0.5f, 0.5f, 0)}, kUnitBox, {}), "not inside the box"));
    CHECK(says(made({make_float4(kNan, 0.5f, 0.5f, 0)}, kUnitBox, {}), "not inside the box"));
    CHECK(says(made({middle}, {{0, 0, 0}, {1, 0.05f, 1}}, {}), "less than the support radius"));
    CHECK(says(made({}, {{1e4f, 0, 0}, {1e4f + 1, 1, 1}}, {}), "from the origin"));
    CHECK(says(made({middle}, kUnitBox, {kNan}), "tolerance"));
    CHECK(says(made({middle}, kUnitBox, {-1}), "tolerance"));
    CHECK(says(made({middle}, kUnitBox, {0.01f, -1}), "corrections"));
    CHECK(says(made({middle}, kUnitBox, {0.01f, 50, kInfinity}), "kept"));
    Box sticky_floor = kUnitBox, ring = kUnitBox;
    sticky_floor.wall[1] = sph::Wall::no_slip;
    ring.wall[0] = sph::Wall::periodic;
    CHECK(says(made({middle}, sticky_floor, {}), "glides"));
    CHECK(says(made({middle}, ring, {}), "glides"));
    CHECK(made({middle}, kUnitBox, {}).empty());

    // All in one cell, with the mass of the space they have: as many corrections as are allowed, no crash.
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(0.51f, 0.53f);
    std::vector<float4> crowd;
    for (int i = 0; i < 500; ++i) {
        const float x = place(random), y = place(random);
        crowd.push_back(make_float4(x, y, place(random), 0));
    }
    Fluid light;
    light.mass_kg = 1000 * 0.02f * 0.02f * 0.02f / 500;
    PbfWater cell(light, kUnitBox, {}, crowd, at_rest(500));
    CHECK(verdict_after(cell, 3, 1e-3f).empty());
}

TEST_CASE("position based fluids: what --explain says is what happens; the equations of state pay nothing") {
#ifndef __CUDASIM__
    course::require_simulator();
#else
    for (const float viscosity : {1.0f, 0.0f}) {
        sph::Settings settings = sph::dam_break_settings(false);
        settings.choice.viscosity = viscosity;
        settings.pressure = sph::Pressure::pbf;
        settings.drawing = sph::Drawing::none;
        cudasim::Recording making;
        sph::PbfStart start = sph::make_pbf_start(settings);
        CHECK(start.water.is_viscous() == (viscosity > 0));
        CHECK(making.bytes() == settings.particles * PbfWater::bytes_per_particle(viscosity > 0) +
                                    start.water.cell_bytes() + start.water.summary_bytes());
        // A summary of each of 16 * 256 particles, and the one of all.
        CHECK(start.water.summary_bytes() ==
              (settings.particles / 4096 + (settings.particles % 4096 != 0) + 1) * sizeof(sph::PbfSummary));
        cudasim::Recording recording;
        start.water.step(start.dt_s);
        CHECK(recording.allocations() == 0);
        std::size_t expected = 0;
        for (const auto& [kernel, count] :
             sph::pbf_launches_per_step(settings, start.water, start.water.report().corrections)) {
            CHECK_MESSAGE(recording.count(kernel) == std::size_t(count), kernel);
            CHECK_MESSAGE(says(sph::explain(settings, start), kernel), kernel);
            expected += count;
        }
        CHECK(recording.launches().size() == expected);
        CHECK(recording.count("density_kernel") + recording.count("force_kernel") == 0);

        sph::Start plain = sph::make_start(settings);
        cudasim::Recording plain_step;
        plain.water.step(plain.dt_s);
        for (const char* kernel :
             {"predict_kernel", "constraint_kernel", "shift_kernel", "reduce_shared_kernel"})
            CHECK_MESSAGE(plain_step.count(kernel) == 0, kernel);
    }
#endif
}

TEST_CASE(
    "position based fluids: the program gives the same bits with any number of threads, and says no "
    "clearly") {
    const std::string out = "--out '" + std::string(COURSE_BIN_DIR) + "/../test_output/10_pbf_" +
                            std::to_string(getpid()) + "' --draw none ";
    const auto run = [&](const std::string& arguments, const std::string& environment = "") {
        return course::run_program("ch10_water_sph", out + arguments, environment);
    };
    const auto hash = [&](const std::string& environment) {
        const std::string text = run("--pressure pbf --particles 1000 --steps 40", environment).output;
        const std::size_t at = text.find("State hash");
        return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
    };
    const std::string first = hash("CUDASIM_THREADS=1");
    REQUIRE(!first.empty());
    CHECK(hash("CUDASIM_THREADS=3") == first);
    for (const char* arguments :
         {"--pressure none", "--pressure pbf --tolerance 0", "--pressure pbf --tolerance nan"}) {
        const course::ProgramRun refused = run(arguments);
        CHECK_MESSAGE(refused.exit_code == 2, arguments << ": " << refused.output);
        CHECK_MESSAGE(refused.output.rfind("error: ", 0) == 0, arguments << ": " << refused.output);
    }
    const course::ProgramRun unstable = run("--pressure pbf --particles 1000 --steps 100 --dt 0.2");
    CHECK(unstable.exit_code == 3);
    // Water thrown about by such a step ends by its speed or by its density; which comes first is up to
    // rounding.
    CHECK_MESSAGE(says(unstable.output, "error: step "), unstable.output);
    CHECK_MESSAGE(
        (says(unstable.output, "support radius") || says(unstable.output, "times the rest density")),
        unstable.output);
}
