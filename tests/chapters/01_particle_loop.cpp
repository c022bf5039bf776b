// Chapter 01: the loop against formulas, the two layouts against each other, and what happens at the edges.
#include "01_particle_loop/particle_loop.h"

#include <unistd.h>

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
#include "01_particle_loop/studies.h"
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

TEST_CASE("extremes: one droplet, and two, fly as droplets do") {
    const Fountain fountain = make_scene("crown");
    const std::uint32_t life = life_steps(fountain);
    for (const std::uint32_t n : {1u, 2u}) {
        const std::vector<Particle> particles = run(fountain, n, life + 100);
        CHECK(born_after(fountain, n, life) == n);
        for (std::uint32_t i = 0; i < n; ++i) {
            // Droplet i starts in the step s with s n / L <= i < (s + 1) n / L.
            const std::uint32_t born_in = (i + 1) * life / n - 1;
            Particle alone;
            emit(fountain, random_start(fountain.seed, i, 0), alone.position_m, alone.velocity_m_per_s);
            for (std::uint32_t s = born_in + 1; s < life + 100; ++s)
                move(fountain, alone.position_m, alone.velocity_m_per_s);
            CHECK(std::memcmp(&alone, &particles[i], sizeof alone) == 0);
        }
    }
}

TEST_CASE("extremes: droplets at one point stay together, and are drawn as one bright spot") {
    const Fountain fountain = make_scene("crown");
    Particle alone{{0.5f, 1, 0.25f}, {1, 2, 3}};
    std::vector<Particle> particles(1000, alone);
    for (int s = 0; s < 300; ++s) {
        move_all(particles, 1000, fountain);
        move(fountain, alone.position_m, alone.velocity_m_per_s);
    }
    CHECK_NOTHROW(watch(particles, 1000, fountain, 299));
    for (const Particle& p : particles) CHECK(std::memcmp(&p, &alone, sizeof p) == 0);
    CHECK(picture(particles, 1000, 64, 48).rgb != picture(particles, 0, 64, 48).rgb);
}

TEST_CASE("extremes: a time step of 0, and one too small to be felt, change nothing") {
    Fountain fountain = make_scene("crown");
    for (const float dt_s : {0.0f, 1e-30f}) {
        fountain.dt_s = dt_s;
        const Particle start{{0.5f, 1, -2}, {1, 2, 3}};
        Particle p = start;
        for (int s = 0; s < 100; ++s) move(fountain, p.position_m, p.velocity_m_per_s);
        CHECK(std::memcmp(&p, &start, sizeof p) == 0);
        // So long a life that nobody is ever born in what can be counted; and no number overflows on the way.
        CHECK(life_steps(fountain) == 0xffffffffu);
        CHECK(born_after(fountain, 1000, 1000000) == 0);
        CHECK(plan_step(fountain, 4294967295u, 4294967294u).last == 4294967295u);
        CHECK_THROWS_AS(check(fountain), course::BadInput);
    }
    fountain.dt_s = kNaN;
    CHECK(life_steps(fountain) == 1);
}

TEST_CASE("extremes: what can't go well is stopped, with its likely cause") {
    struct Case {
        std::string what, cause;
        Fountain fountain = make_scene("crown");
        Particle droplet{{0, 1, 0}, {1, 0, 0}};
    };
    Case fast{"1e6 m/s", "or that fast"}, huge_step{"dt 1e6 s", "is longer than a life of 1.85 s"},
        thick_air{"drag 1e12", "is over the limit 2 / drag = 2e-12 s"},
        trampoline{"restitution 2", "a restitution of 2 adds energy in each bounce"},
        no_number{"restitution nan", "a number that is none"},
        no_gravity{"gravity nan", "a number that is none"},
        no_velocity{"velocity nan", "a number that is none"}, far{"born 10 km away", "started out there"};
    fast.droplet.velocity_m_per_s.x = 1e6f;
    huge_step.fountain.dt_s = 1e6f;
    huge_step.fountain.drag_per_s = 0;
    thick_air.fountain.drag_per_s = 1e12f;
    trampoline.fountain.restitution = 2;
    trampoline.fountain.drag_per_s = 0;  // with drag, a fall ends below g / k = 28 m/s: no bounce gets far
    no_number.fountain.restitution = kNaN;
    no_gravity.fountain.gravity_m_per_s2 = kNaN;
    no_velocity.droplet.velocity_m_per_s.z = kNaN;
    far.droplet.position_m.x = 1e4f;
    for (const Case& c : {fast, huge_step, thick_air, trampoline, no_number, no_gravity, no_velocity, far}) {
        CAPTURE(c.what);
        std::vector<Particle> particles(3, c.droplet);
        std::string last_words;
        for (int s = 0; s < 20000 && last_words.empty(); ++s) try {
                move_all(particles, 3, c.fountain);
                watch(particles, 3, c.fountain, s);
            } catch (const course::Unstable& error) {
                last_words = error.what();
            }
        CHECK_MESSAGE(last_words.find("droplet 0 is at (") != std::string::npos, last_words);
        CHECK_MESSAGE(last_words.find(c.cause) != std::string::npos, last_words);
    }
}

TEST_CASE("extremes: a fountain with a number that is none, or one out of reach, is refused") {
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
        Fountain f[8];
        for (Fountain& fountain : f) {
            fountain = make_scene("crown");
            CHECK_NOTHROW(check(fountain));
        }
        f[0].dt_s = f[1].gravity_m_per_s2 = f[2].drag_per_s = f[3].restitution = f[4].floor_grip = bad;
        f[5].lifetime_s = f[6].spread_m_per_s = bad;
        f[7].jet_m_per_s[14].z = bad;
        for (const Fountain& fountain : f) CHECK_THROWS_AS(check(fountain), course::BadInput);
        Fountain nozzle = make_scene("crown");
        nozzle.nozzle_m.x = bad;
        CHECK_THROWS_AS(check(nozzle), course::BadInput);
    }
    Fountain far = make_scene("crown"), no_life = far, jets = far;
    far.nozzle_m.x = 1e4f;
    no_life.lifetime_s = no_life.dt_s = 0;
    jets.jet_count = 17;
    for (const Fountain& fountain : {far, no_life, jets}) CHECK_THROWS_AS(check(fountain), course::BadInput);
}

TEST_CASE("extremes: far from the origin a float has no room for a small step") {
    // At 1e4 m floats are 9.8e-4 m apart: 0.4 m/s * 1 ms is less than half of that, and is rounded away.
    Fountain fountain = make_scene("crown");
    fountain.gravity_m_per_s2 = fountain.drag_per_s = 0;
    fountain.dt_s = 1e-3f;
    Particle far{{1e4f, 1, 0}, {0.4f, 0, 0}}, near{{0, 1, 0}, {0.4f, 0, 0}};
    for (int s = 0; s < 1000; ++s) {
        move(fountain, far.position_m, far.velocity_m_per_s);
        move(fountain, near.position_m, near.velocity_m_per_s);
    }
    CHECK(far.position_m.x == 1e4f);
    // 1000 sums below 0.5 m, each rounded by up to 1.5e-8 m.
    CHECK_FALSE(!(std::abs(near.position_m.x - 0.4) <= 1.5e-5));
}

TEST_CASE("extremes: restitution 0 lands, restitution 1 goes on bouncing as high as it fell") {
    Fountain fountain = make_scene("crown");
    fountain.drag_per_s = 0;
    fountain.restitution = 0;
    Particle wet{{0, 2, 0}, {0, 0, 0}};
    for (int s = 0; s < 1000; ++s) move(fountain, wet.position_m, wet.velocity_m_per_s);
    CHECK((wet.position_m.y == 0.0f && wet.velocity_m_per_s.y == 0.0f));

    fountain.restitution = 1;
    Particle ball{{0, 2, 0}, {0, 0, 0}};
    float peak_m = 0;
    for (int s = 0; s < 2500; ++s) {
        move(fountain, ball.position_m, ball.velocity_m_per_s);
        if (s > 2100) peak_m = std::max(peak_m, ball.position_m.y);  // more than one of the 1.28 s bounces
    }
    // A bounce comes up to one step late and is right on average; each of 8 can be off by g dt v = 0.25 J/kg,
    // and 9.81 J/kg are a metre.
    CHECK_FALSE(!(std::abs(peak_m - 2) <= 8 * 0.25 / 9.81));
}

TEST_CASE("extremes: the largest random number picks the last jet, not the one behind it") {
    Fountain fountain;
    for (int jets = 1; jets <= kMaxJets; ++jets) {
        fountain.jet_count = jets;
        fountain.jet_m_per_s[jets - 1] = {float(jets), 0, 0};
        Uniforms most{};
        most.u[0] = to_unit_interval(0xffffffffu);
        for (int k = 1; k < 7; ++k) most.u[k] = 0.5f;  // no deviation
        Particle p;
        emit(fountain, most, p.position_m, p.velocity_m_per_s);
        CHECK(p.velocity_m_per_s == glm::vec3(float(jets), 0, 0));
    }
}

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
    for (const glm::vec3 how_fast : {glm::vec3(0, kNaN, 0), glm::vec3(0, 0, -kInfinity)}) {
        std::vector<Particle> particles(10);
        particles[6].velocity_m_per_s = how_fast;  // the position is still a number
        CHECK_THROWS_AS(watch(particles, 10, fountain, 3), course::Unstable);
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
        {"--dt 1e6", "the time step must be"},
        {"--dt 1e-9", "the time step must be"},
        {"--dt 1e-30", "the time step must be"},
        {"--drag nan", "drag must be"},
        {"--drag inf", "drag must be"},
        {"--drag 1e12", "drag must be from 0 to 1000000 per second, not 1e+12"},
        {"--restitution 1.5", "restitution must be from 0 to 1, not 1.5"},
        {"--restitution 2", "restitution must be"},
        {"--restitution nan", "restitution must be"},
        {"--width 0", "--width must be"},
        {"--width -640", "--width must be"},
        {"--width 15", "--width must be"},
        {"--height 16385", "--height must be"},
        {"--height 99999999999", "--height"},
        {"--study weather", "weather"},
        {"--stability weather", "weather"},
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

TEST_CASE("more droplets than the machine can hold: exit code 2, before anything is computed") {
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (memory > 2147483647.0 * sizeof(Particle)) course::skip("this machine can hold them");
    const course::TemporaryFolder folder;
    const course::ProgramRun run = course::run_program(
        "ch01_particle_loop", "--particles 2147483647 --steps 1 --out " + folder.path().string());
    CHECK(run.exit_code == 2);
    CHECK_MESSAGE(run.output.find("GiB of memory") != std::string::npos, run.output);
}

TEST_CASE("one droplet, no step, the last of the scales, narrow pictures, and --explain") {
    const course::TemporaryFolder folder;
    const std::string out = " --out " + (folder.path() / "new").string();
    CHECK(course::run_program("ch01_particle_loop", "--explain" + out).exit_code == 0);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "new"));  // explaining makes nothing
    for (const char* arguments :
         {"--particles 1 --steps 3 --width 64 --height 64",
          "--particles 2 --steps 500 --width 16 --height 16",
          "--particles 10 --steps 0 --width 64 --height 64", "--particles 10 --width 4096 --height 16",
          "--particles 10 --width 16 --height 4096",
          "--particles 10 --drag 0 --restitution 0 --width 64 --height 64",
          "--particles 10 --restitution 1 --width 64 --height 64",
          "--particles 10 --dt 1.85 --steps 5 --width 64 --height 64"}) {
        const course::ProgramRun run = course::run_program("ch01_particle_loop", arguments + out);
        CHECK_MESSAGE(run.exit_code == 0, run.output);
        CHECK(std::filesystem::exists(folder.path() / "new" / "fountain.png"));
    }
}

TEST_CASE("the same seed gives the same picture, another seed another") {
    const course::TemporaryFolder folder;
    const auto picture_of = [&](const std::string& seed, const std::string& name) {
        const std::filesystem::path out = folder.path() / name;
        course::run_program(
            "ch01_particle_loop",
            "--particles 500 --steps 100 --width 64 --height 64 --seed " + seed + " --out " + out.string());
        std::ifstream file(out / "fountain.png", std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const std::string first = picture_of("7", "a");
    CHECK(first.size() > 100);
    CHECK(first == picture_of("7", "b"));
    CHECK(first != picture_of("8", "c"));
}

// ---------------------------------------------------------------------------------------------- the studies

TEST_CASE("study time_step: first order, until rounding takes over; ever later in double") {
    course::Study study({"time_step", "?", "m", "dt_s"}, "01_particle_loop", true);
    study_time_step(study);
    const auto error_m = [&](const std::string& method, int steps) {
        for (const course::StudyRow& row : study.rows())
            if (row.method == method && row.steps == steps) return row.error;
        return double(kNaN);
    };
    // Halving dt twice quarters the error; the next term is of relative size k dt < 0.011, and at 512 steps
    // of 1e-6 m rounding may reach 512 * 1e-6 of 0.012 m.
    CHECK_FALSE(!(std::abs(error_m("near the ground, double", 32) / error_m("near the ground, double", 128) -
                           4) <= 0.05));
    CHECK_FALSE(!(
        std::abs(error_m("near the ground, double", 8192) / error_m("near the ground, double", 32768) - 4) <=
        1e-3));
    CHECK_FALSE(!(
        std::abs(error_m("near the ground, float", 32) / error_m("near the ground, float", 128) - 4) <= 0.2));
    CHECK_FALSE(
        !(error_m("near the ground, float", 524288) > 10 * error_m("near the ground, double", 524288)));
    CHECK_FALSE(!(error_m("10 km up, float", 524288) > 10 * error_m("near the ground, float", 524288)));
}

TEST_CASE("move_in_double is move, but for rounding") {
    const Fountain fountain = make_scene("crown");
    Particle p{{0.5f, 2, 0.25f}, {1, 2, 3}};
    glm::dvec3 x(p.position_m), v(p.velocity_m_per_s);
    for (int s = 0; s < 100; ++s) {
        move(fountain, p.position_m, p.velocity_m_per_s);
        move_in_double(fountain, x, v);
    }
    // 100 roundings of a velocity below 4 m/s (1.2e-7) over 0.4 s, and of a position below 4 m (1.2e-7).
    CHECK_FALSE(!(glm::distance(glm::dvec3(p.position_m), x) <= 100 * 3e-7));
}

TEST_CASE("study layout: both layouts give the same droplets and the same counts") {
    course::Study study({"layout", "?", "droplets", "n"}, "01_particle_loop", true);
    add_layouts(study, 1000);
    CHECK(study.rows().size() == 4);
    for (const course::StudyRow& row : study.rows()) CHECK(row.error == 0);
}

TEST_CASE("stability map drag: the limit is 2 / k, to one part in a hundred") {
    for (const float drag : {0.35f, 35.0f, 3500.0f, 35000.0f}) {
        CHECK(drag_is_stable(drag, 0.99f * 2 / drag));
        CHECK_FALSE(drag_is_stable(drag, 1.01f * 2 / drag));
        CHECK_FALSE(drag_is_stable(drag, 1e6f));  // to infinity, and on to NaN
    }
}

TEST_CASE("the program lists its studies, and writes a stability map as CSV and for the report") {
    const course::TemporaryFolder folder;
    const std::string list = course::run_program("ch01_particle_loop", "--list-studies").output;
    for (const char* name : {"study time_step:", "study layout:", "stability drag:"})
        CHECK_MESSAGE(list.find(name) != std::string::npos, list);
    const course::ProgramRun run =
        course::run_program("ch01_particle_loop", "--stability drag --quick --out " + folder.path().string());
    CHECK(run.exit_code == 0);
    CHECK(std::filesystem::exists(folder.path() / "stability_drag.json"));
    std::ifstream file(folder.path() / "stability_drag.csv");
    std::string header;
    std::getline(file, header);
    CHECK(header == "stability,method,dt,stiffness,stable,measured_limit,theory_limit");
}
