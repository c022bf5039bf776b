// Chapter 01: the loop against formulas, the two layouts against each other, and what happens at the edges.
#include "01_particle_loop/particle_loop.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>

#include "01_particle_loop/checks.h"
#include "01_particle_loop/scenes.h"
#include "01_particle_loop/splat.h"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"

using namespace particle_loop;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A droplet in free flight: gravity and drag, no emission, the floor far below.
Particle fly(Fountain fountain, Particle p, int steps, double seconds) {
    fountain.dt_s = float(seconds / steps);
    for (int s = 0; s < steps; ++s) move(fountain, p.position_m, p.velocity_m_per_s);
    return p;
}

struct Point {
    double x, y;
};

/// Where linear drag k and gravity g bring a droplet in t seconds: the solution of x'' = -k x', y'' = -g - k
/// y'.
Point exact_flight(const Particle& start, double k, double g, double t) {
    const double reach_s = -std::expm1(-k * t) / k;
    return {start.position_m.x + start.velocity_m_per_s.x * reach_s,
            start.position_m.y + (start.velocity_m_per_s.y + g / k) * reach_s - g / k * t};
}

double distance(const Particle& p, const Point& exact) {
    return std::hypot(p.position_m.x - exact.x, p.position_m.y - exact.y);
}

std::vector<Particle> run(const Fountain& fountain, std::uint32_t n, std::uint32_t steps) {
    std::vector<Particle> particles(n);
    for (std::uint32_t s = 0; s < steps; ++s) step(particles, fountain, s);
    return particles;
}

}  // namespace

// ------------------------------------------------------------------------------------------------ physics

TEST_CASE("without drag, the error in height is g dt t / 2") {
    // Semi-implicit Euler gives y = y0 + v t - g t^2 / 2 - g dt t / 2: the sum of an arithmetic series.
    Fountain fountain = make_scene("crown");
    fountain.drag_per_s = 0;
    const Particle start{{0, 20, 0}, {3, 8, 0}};
    for (const int steps : {50, 100, 400}) {
        const double dt = 1.0 / steps, g = fountain.gravity_m_per_s2;
        const Particle end = fly(fountain, start, steps, 1.0);
        const double error_m = (20.0 + 8.0 - 0.5 * g) - end.position_m.y;
        // Each of at most 400 steps rounds a height below 32 m by at most 1e-6 m.
        CHECK_FALSE(!(std::abs(error_m - 0.5 * g * dt) <= 4e-4));
        CHECK_FALSE(!(std::abs(end.position_m.x - 3.0) <= 4e-4));
    }
}

TEST_CASE("with drag, the loop tends to the exact flight with the first power of dt") {
    for (const float drag : {0.35f, 2.0f}) {
        Fountain fountain = make_scene("crown");
        fountain.drag_per_s = drag;
        const Particle start{{0, 20, 0}, {3, 8, 0}};
        const Point exact = exact_flight(start, drag, fountain.gravity_m_per_s2, 1.0);
        const double coarse = distance(fly(fountain, start, 50, 1.0), exact);
        const double fine = distance(fly(fountain, start, 100, 1.0), exact);
        // Order 1 halves the error; the next term is of relative size k dt <= 0.04.
        CHECK_FALSE(!(std::abs(coarse / fine - 2.0) <= 0.04));
        CHECK_FALSE(!(fine <= 0.1));  // 9.81 * 0.01 * 1 s: dt times the speed that gravity adds
    }
}

TEST_CASE("in flight without drag, v^2 / 2 + g y - g dt v / 2 stays what it was") {
    // The energy itself falls by g^2 dt t / 2; this neighbour of it is what the method conserves.
    Fountain fountain = make_scene("crown");
    fountain.drag_per_s = 0;
    const double g = fountain.gravity_m_per_s2, dt = fountain.dt_s;
    const auto kept = [&](const Particle& p) {
        const double v = p.velocity_m_per_s.y;
        return 0.5 * v * v + g * p.position_m.y - 0.5 * g * dt * v;
    };
    Particle p{{0, 1, 0}, {0, 8, 0}};
    const double before = kept(p);
    for (int s = 0; s < 400; ++s) move(fountain, p.position_m, p.velocity_m_per_s);
    // 400 steps round v <= 8 by 2.4e-7 and y <= 5 by 2.4e-7: 400 (8 * 2.4e-7 + 9.81 * 2.4e-7) = 1.7e-3 at
    // worst.
    CHECK_FALSE(!(std::abs(kept(p) - before) <= 1.7e-3));
}

TEST_CASE("a bounce rises to restitution^2 of the height of the fall, and keeps its grip") {
    Fountain fountain = make_scene("crown");
    fountain.drag_per_s = 0;
    fountain.dt_s = 1e-3f;
    Particle p{{0, 2, 0}, {5, 0, 0}};
    float peak_m = 0;
    bool bounced = false;
    for (int s = 0; s < 1000; ++s) {
        move(fountain, p.position_m, p.velocity_m_per_s);
        bounced = bounced || p.velocity_m_per_s.y > 0;
        if (bounced) peak_m = std::max(peak_m, p.position_m.y);
    }
    // The moment of impact is known to one step: 6.3 m/s * 1 ms, and as much again by the speed gained in it.
    CHECK_FALSE(!(std::abs(peak_m - 0.4 * 0.4 * 2.0) <= 0.0126));
    CHECK_FALSE(!(std::abs(p.velocity_m_per_s.x - 0.6f * 5.0f) <= 1e-6f));  // one multiplication
}

TEST_CASE("what went through the floor comes back, shortened by the restitution") {
    Fountain fountain = make_scene("crown");
    fountain.gravity_m_per_s2 = fountain.drag_per_s = 0;
    fountain.dt_s = 0.5f;
    fountain.restitution = 0.25f;
    Particle p{{0, 1, 0}, {0, -4, 0}};
    move(fountain, p.position_m, p.velocity_m_per_s);  // to y = -1, all numbers exact in binary
    CHECK(p.position_m.y == 0.25f);
    CHECK(p.velocity_m_per_s.y == 1.0f);
}

TEST_CASE("a droplet left alone comes to rest on the floor") {
    Fountain fountain = make_scene("crown");
    Particle p{{0, 2, 0}, {3, 0, 1}};
    for (int s = 0; s < 5000; ++s) {
        move(fountain, p.position_m, p.velocity_m_per_s);
        CHECK(p.position_m.y >= 0.0f);
    }
    // What is left is the speed and the way that gravity gives in one or two steps: g dt, g dt^2.
    const float g_dt = fountain.gravity_m_per_s2 * fountain.dt_s;
    CHECK_FALSE(!(glm::length(p.velocity_m_per_s) <= 2 * g_dt));
    CHECK_FALSE(!(p.position_m.y <= 2 * g_dt * fountain.dt_s));
}

TEST_CASE("drag alone: stable below 2 / k, growing above") {
    Fountain fountain = make_scene("crown");
    fountain.gravity_m_per_s2 = 0;
    fountain.drag_per_s = 50;
    const auto speed_after = [&](float dt_s) {
        fountain.dt_s = dt_s;
        Particle p{{0, 1e6f, 0}, {1, 0, 0}};
        for (int s = 0; s < 200; ++s) move(fountain, p.position_m, p.velocity_m_per_s);
        return std::abs(p.velocity_m_per_s.x);
    };
    CHECK(speed_after(0.99f * 2 / 50) < 0.1f);   // 0.98^200 = 0.018
    CHECK(speed_after(1.01f * 2 / 50) > 10.0f);  // 1.02^200 = 52
}

// --------------------------------------------------------------------------------- emission and its numbers

TEST_CASE("Philox gives the published numbers") {
    // Random123's known-answer file (kat_vectors): philox4x32, 10 rounds, counter 0, key 0.
    const std::uint32_t words[] = {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
    const Uniforms start = random_start(0, 0, 0);
    for (int k = 0; k < 4; ++k) CHECK(start.u[k] == float((words[k] >> 8) / 16777216.0));
}

TEST_CASE("a start depends on seed, id and generation, and on nothing else") {
    const auto same = [](const Uniforms& a, const Uniforms& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    const Uniforms start = random_start(7, 8, 9);
    random_start(1, 2, 3);
    CHECK(same(start, random_start(7, 8, 9)));
    CHECK_FALSE(same(start, random_start(8, 8, 9)));
    CHECK_FALSE(same(start, random_start(7ull + (1ull << 32), 8, 9)));  // all 64 bits of the seed count
    CHECK_FALSE(same(start, random_start(7, 9, 9)));
    CHECK_FALSE(same(start, random_start(7, 8, 10)));
}

TEST_CASE("random numbers are at least 0 and below 1, their mean and spread are those of even ones") {
    CHECK(to_unit_interval(0) == 0.0f);
    CHECK(to_unit_interval(0xffffffffu) < 1.0f);
    for (int which = 0; which < 8; ++which) {
        double sum = 0, squares = 0;
        const int n = 20000;
        for (int i = 0; i < n; ++i) {
            const double u = random_start(3, i, 0).u[which];
            sum += u;
            squares += u * u;
        }
        // Five standard deviations of a mean of 20000: 5 * 0.289 / sqrt(n); of a square: 5 * 0.298 / sqrt(n).
        CHECK_FALSE(!(std::abs(sum / n - 0.5) <= 0.0103));
        CHECK_FALSE(!(std::abs(squares / n - 1.0 / 3) <= 0.0106));
    }
}

TEST_CASE("the eight numbers of a start know nothing of each other") {
    const int n = 20000;
    for (int a = 0; a < 8; ++a)
        for (int b = 0; b < a; ++b) {
            double sum = 0;
            for (int i = 0; i < n; ++i) {
                const Uniforms start = random_start(4, i, 1);
                sum += (start.u[a] - 0.5) * (start.u[b] - 0.5);
            }
            CHECK_FALSE(!(std::abs(sum / n) <= 0.00295));  // five standard deviations: 5 / 12 / sqrt(n)
        }
}

TEST_CASE("droplets leave through their jets, all jets alike") {
    const Fountain fountain = make_scene("crown");
    std::vector<int> of_jet(fountain.jet_count);
    const int n = 15000;
    for (int i = 0; i < n; ++i) {
        Particle p;
        const float age_s = emit(fountain, random_start(5, i, 2), p.position_m, p.velocity_m_per_s);
        CHECK((age_s >= 0.0f && age_s < fountain.dt_s));
        int near = 0;
        for (int jet = 0; jet < fountain.jet_count; ++jet) {
            const glm::vec3 off = glm::abs(p.velocity_m_per_s - fountain.jet_m_per_s[jet]);
            if (std::max({off.x, off.y, off.z}) > fountain.spread_m_per_s * 1.001f) continue;
            ++of_jet[jet];
            ++near;
        }
        CHECK(near >= 1);
        const glm::vec3 flown = p.position_m - (fountain.nozzle_m + age_s * p.velocity_m_per_s);
        CHECK_FALSE(!(glm::length(flown) <= 1e-6f));  // two roundings below 1 m
    }
    // 15 jets, 1000 droplets each, five standard deviations of 31; the first three are one and the same jet.
    for (int jet = 3; jet < fountain.jet_count; ++jet) CHECK(std::abs(of_jet[jet] - 1000) < 155);
    CHECK(std::abs(of_jet[0] - 3000) < 5 * 50);
}

// ---------------------------------------------------------------------------------------- who starts when

TEST_CASE("in a round, every droplet starts once, in slices without gaps") {
    Fountain fountain;
    fountain.dt_s = 0.01f;
    fountain.lifetime_s = 1.0f;
    REQUIRE(life_steps(fountain) == 100);
    for (const std::uint32_t n : {0u, 1u, 7u, 99u, 100u, 101u, 1000u, 12345u, 4294967295u}) {
        std::uint32_t expected_first = 0;
        for (std::uint32_t s = 300; s < 400; ++s) {
            const StepPlan plan = plan_step(fountain, n, s);
            CHECK(plan.first == expected_first);
            CHECK(plan.last >= plan.first);
            CHECK(plan.last - plan.first <= n / 100 + 1);
            CHECK(plan.generation == 3);
            CHECK(plan.moving == n);
            expected_first = plan.last;
        }
        CHECK(expected_first == n);
    }
}

TEST_CASE("in the first round, those not yet born wait") {
    Fountain fountain;
    fountain.dt_s = 0.01f;
    fountain.lifetime_s = 1.0f;
    const std::vector<Particle> particles = run(fountain = make_scene("crown"), 5000, 100);
    const std::uint32_t born = born_after(fountain, 5000, 100);
    CHECK(born == plan_step(fountain, 5000, 99).last);
    CHECK((born > 1000 && born < 1200));  // 100 of 462 steps
    for (std::uint32_t i = 0; i < 5000; ++i) {
        CHECK((particles[i].position_m != glm::vec3(0.0f)) == (i < born));
        CHECK(plan_step(fountain, 5000, 100).waits(i) == (i >= plan_step(fountain, 5000, 100).last));
    }
    CHECK(born_after(fountain, 5000, 0) == 0);
    CHECK(born_after(fountain, 5000, 100000) == 5000);
}

// ------------------------------------------------------------------------------------------------- layouts

TEST_CASE("both layouts give the same bits") {
    // Exact: the same arithmetic on the same numbers in the same order, eight at a time or one at a time.
    for (const char* scene : {"crown", "spray"})
        for (const std::uint32_t n : {0u, 1u, 15u, 16u, 17u, 1000u, 3001u}) {
            const Fountain fountain = make_scene(scene);
            std::vector<Particle> aos(n);
            ParticleArrays soa(n);
            for (std::uint32_t s = 0; s < 600; ++s) {  // into the second generation
                step(aos, fountain, s);
                step(soa, fountain, s);
            }
            std::uint32_t different = 0;
            for (std::uint32_t i = 0; i < n; ++i) {
                const Particle p = soa.load(i);
                different += std::memcmp(&p, &aos[i], sizeof p) != 0;
            }
            CHECK(different == 0);
            for (const float height_m : {-1.0f, 0.5f, 2.0f, 100.0f})
                CHECK(count_above(aos, n, height_m) == count_above(soa, n, height_m));
            CHECK(count_above(aos, n, -1.0f) == n);
            CHECK(count_above(aos, n, 100.0f) == 0);
        }
}

TEST_CASE("the fountain is a fountain: inside its envelope, up and down, all of it") {
    const Fountain fountain = make_scene("crown");
    const std::vector<Particle> particles = run(fountain, 20000, 900);
    double rising = 0;
    for (const Particle& p : particles) {
        CHECK(
            (p.position_m.y >= 0.0f && p.position_m.y < 3.7f));  // 8.35 m/s upwards reach 3.55 m without drag
        CHECK(std::hypot(p.position_m.x, p.position_m.z) < 6.0);
        rising += p.velocity_m_per_s.y > 0;
    }
    CHECK((rising > 6000 && rising < 14000));
}

// ------------------------------------------------------------------------------------------- the picture

TEST_CASE("a spot gives the same light wherever it lies between the pixels") {
    const auto light_of = [](float x_m, float radius_m) {
        Canvas canvas(64, 64, {{0, 0, 8}, {0, 0, 0}, 4.0f, 0.0f});
        canvas.spot({x_m, 0.013f, 0}, radius_m, glm::vec3(1.0f));
        double sum = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) sum += canvas.at(x, y).x;
        return sum;
    };
    const double pixel_m = 4.0 / 64;
    const double wanted =
        2 * 3.14159265 * std::pow(0.02 / pixel_m, 2);  // integral of the Gaussian, in pixels
    for (const double shift : {0.0, 0.2, 0.5, 0.9})
        // Cutting the spot at 2.5 sigma loses exp(-2.5^2 / 2) = 4.4 % and pixel sampling a little more.
        CHECK_FALSE(!(std::abs(light_of(float(shift * pixel_m), 0.02f) / wanted - 1) <= 0.12));
}

TEST_CASE("droplets that can't be seen leave no light") {
    Canvas canvas(32, 32, Camera{});
    const Camera camera;
    for (const glm::vec3 where : {glm::vec3(0, 2.4f, 20), glm::vec3(kNaN), glm::vec3(kInfinity, 0, 0),
                                  glm::vec3(1e30f, 0, 0), glm::vec3(0, -1e9f, 0)})
        canvas.spot(where, 0.01f, glm::vec3(1.0f));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) CHECK(canvas.at(x, y) == glm::vec3(0.0f));
}

TEST_CASE("a picture is bright at the jets, dark in the sky, and the same each time") {
    const Fountain fountain = make_scene("crown");
    const std::vector<Particle> particles = run(fountain, 3000, 500);
    const course::Image image = picture(particles, 3000, 320, 180);
    const auto brightness = [&](int x, int y) {
        const std::uint8_t* p = image.pixel(x, y);
        return int(p[0]) + p[1] + p[2];
    };
    CHECK(brightness(160, 125) > 600);  // above the nozzle
    CHECK(brightness(20, 10) < 120);    // upper left corner
    CHECK(picture(particles, 3000, 320, 180).rgb == image.rgb);
    CHECK(picture(particles, 0, 320, 180).rgb != image.rgb);
}

// ------------------------------------------------------------------------------------------------ the edges

TEST_CASE("lost droplets are named") {
    Fountain fountain = make_scene("crown");
    for (const glm::vec3 where :
         {glm::vec3(kNaN, 0, 0), glm::vec3(0, kInfinity, 0), glm::vec3(0, 0, -2e3f)}) {
        std::vector<Particle> particles(10);
        particles[6].position_m = where;
        CHECK_NOTHROW(watch(particles, 6, fountain, 3));
        try {
            watch(particles, 10, fountain, 3);
            FAIL("not noticed");
        } catch (const course::Unstable& error) {
            CHECK(std::string(error.what()).find("step 3: droplet 6") == 0);
        }
    }
}

TEST_CASE("bad input ends with exit code 2 and a sentence that names the value") {
    const struct {
        const char *arguments, *sentence;
    } cases[] = {
        {"--particles 0", "--particles must be"},
        {"--particles -5", "not -5"},
        {"--dt -0.1", "--dt must be"},
        {"--dt nan", "--dt must be"},
        {"--dt 1e30", "the time step must be"},
        {"--dt 1e-9", "the time step must be"},
        {"--drag nan", "drag must be"},
        {"--restitution 1.5", "restitution must be from 0 to 1, not 1.5"},
        {"--scene volcano", "there is no scene 'volcano'"},
        {"--window", "--window"},
        {"--out /proc/nothing", "/proc/nothing"},
        {"--frobnicate", "frobnicate"},
    };
    const course::TemporaryFolder folder;
    const std::string out = " --out " + folder.path().string();
    for (const auto& c : cases) {
        // An option given twice is an error of its own: the folder only where the case names none.
        const bool names_out = std::string(c.arguments).find("--out") == 0;
        const course::ProgramRun run =
            course::run_program("ch01_particle_loop", c.arguments + (names_out ? "" : out));
        CHECK_MESSAGE(run.exit_code == 2, c.arguments);
        CHECK_MESSAGE(run.output.find(c.sentence) != std::string::npos, run.output);
    }
}

TEST_CASE("an unstable run ends with exit code 3, says why, and leaves its result") {
    const course::TemporaryFolder folder;
    const course::ProgramRun run = course::run_program(
        "ch01_particle_loop", "--particles 100 --drag 50 --dt 0.1 --out " + folder.path().string());
    CHECK(run.exit_code == 3);
    CHECK(run.output.find("is over the limit 2 / drag = 0.04 s") != std::string::npos);
    CHECK(std::filesystem::exists(folder.path() / "result.json"));
    CHECK(std::filesystem::exists(folder.path() / "start.png"));  // what there was until then
}

TEST_CASE("one droplet, no step, and --explain") {
    const course::TemporaryFolder folder;
    const std::string out = " --out " + (folder.path() / "new").string();
    CHECK(course::run_program("ch01_particle_loop", "--explain" + out).exit_code == 0);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "new"));  // explaining makes nothing
    for (const char* arguments : {"--particles 1 --steps 3", "--particles 10 --steps 0"}) {
        const course::ProgramRun run = course::run_program(
            "ch01_particle_loop", std::string(arguments) + " --width 64 --height 64 --no-measure" + out);
        CHECK_MESSAGE(run.exit_code == 0, run.output);
        CHECK(std::filesystem::exists(folder.path() / "new" / "fountain.png"));
    }
}

TEST_CASE("the same seed gives the same picture, another seed another") {
    const course::TemporaryFolder folder;
    const auto picture_of = [&](const std::string& seed, const std::string& name) {
        const std::filesystem::path out = folder.path() / name;
        course::run_program("ch01_particle_loop",
                            "--particles 500 --steps 100 --width 64 --height 64 --no-measure --seed " + seed +
                                " --out " + out.string());
        std::ifstream file(out / "fountain.png", std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string first = picture_of("7", "a");
    CHECK(first.size() > 100);
    CHECK(first == picture_of("7", "b"));
    CHECK(first != picture_of("8", "c"));
}
