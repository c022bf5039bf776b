// Chapter 07: is a life what its numbers say, is the step exact, is the light right, and is nothing done in
// vain?
#include <algorithm>
#include <cmath>
#include <functional>

#include "07_fire_particles/measure.cuh"
#include "07_fire_particles/studies.cuh"
#include "tests/chapters/06_gl_interop_support.h"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

using namespace fire;
using gl_test::context_or_skip;

namespace {

/// A fire in plain device memory.
struct DeviceFire {
    Fire fire;
    bool curl;
    course::DeviceBuffer<float4> position, velocity;
    course::DeviceBuffer<std::uint32_t> generation;

    explicit DeviceFire(const Fire& f, bool with_curl = false)
        : fire(f),
          curl(with_curl),
          position(particle_count(f)),
          velocity(particle_count(f)),
          generation(particle_count(f)) {
        launch_flame_clear(arrays(), fire);
    }
    FlameArrays arrays() { return {position.data(), velocity.data(), generation.data()}; }
    void step(int step, float dt_s) {
        launch_flame_step(arrays(), fire, curl, float(step * double(dt_s)), dt_s);
    }
    void run(int steps, float dt_s) {
        for (int k = 0; k < steps; ++k) step(k, dt_s);
    }
};

/// One kind, born at a point, with no spread of anything.
Fire plain_fire(std::uint32_t n) {
    Fire fire;
    fire.kind_count = 1;
    fire.kind[0].count = n;
    fire.kind[0].emitter.shape = Emitter::point;
    fire.kind[0].life_spread = 0;
    return fire;
}

std::uint32_t count_alive(const DeviceFire& fire) {
    const auto x = fire.position.download(), v = fire.velocity.download();
    std::uint32_t alive = 0;
    for (std::size_t i = 0; i < x.size(); ++i) alive += x[i].w >= 0 && x[i].w < v[i].w;
    return alive;
}

double births(const DeviceFire& fire) {  // from the second on: the first has generation 0
    double sum = 0;
    for (const std::uint32_t g : fire.generation.download()) sum += g;
    return sum;
}

}  // namespace

// ------------------------------------------------------------------------------------------------- colour

TEST_CASE("black body: chromaticity, luminance and linear sRGB agree with CIE 1931") {
    struct Row {
        double kelvin, x, y, luminance;  // of 1500 K
        glm::dvec3 rgb;
    };
    const std::vector<Row> rows = {{1000,
                                    0.6527506979746973,
                                    0.3444616552903306,
                                    0.0003471398833761029,
                                    {4.599448611408053, 0.039599666659118515, -0.08997950621643053}},
                                   {1200,
                                    0.6250448269271695,
                                    0.36745416461219876,
                                    0.018001459418848613,
                                    {3.9647438645250137, 0.2281236677807011, -0.08775024357506883}},
                                   {1500,
                                    0.5857179435809132,
                                    0.3931213093147996,
                                    1.0,
                                    {3.264032968788743, 0.4341222060832058, -0.06417873077525293}},
                                   {1900,
                                    0.5377772779743569,
                                    0.41120221989832967,
                                    31.22880836888954,
                                    {2.6389266428866334, 0.6135443179906097, -6.028294394977429e-05}},
                                   {2500,
                                    0.4769945408685043,
                                    0.4136753598028064,
                                    726.5575240984866,
                                    {2.0675587160742133, 0.7693670223913818, 0.13953011656592051}},
                                   {6500,
                                    0.313525880366709,
                                    0.3236283046370667,
                                    396951.3603010512,
                                    {1.0432173155049282, 0.9835933580493116, 1.034985579697201}}};
    const double at_1500 = blackbody_xyz(1500).y;
    for (const Row& row : rows) {
        CAPTURE(row.kelvin);
        const glm::dvec3 xyz = blackbody_xyz(row.kelvin);
        // The reference sums every 1 nm; every 5 nm is right to 1e-4, and twice that is a fair price for
        // every 10.
        CHECK(std::abs(chromaticity(xyz).x - row.x) <= 2e-4);
        CHECK(std::abs(chromaticity(xyz).y - row.y) <= 2e-4);
        CHECK(std::abs(xyz.y / at_1500 / row.luminance - 1) <= 1e-3);
        // The matrix alone, from the table's own chromaticity. The table took another of the published
        // matrices: they differ in the fourth digit, by the white that they were made for.
        const glm::dvec3 rgb = chromaticity_to_linear_srgb({row.x, row.y});
        for (int c = 0; c < 3; ++c) CHECK(std::abs(rgb[c] - row.rgb[c]) <= 1e-3);
    }
    // Ours makes the standard's white, D65, exactly white.
    const glm::dvec3 white = chromaticity_to_linear_srgb({0.3127, 0.3290});
    for (int c = 0; c < 3; ++c) CHECK(std::abs(white[c] - 1) <= 1e-6);
}

TEST_CASE("black body: the ramp has luminance 1, no negative light, and grows with temperature") {
    const auto ramp = blackbody_ramp_table(64);
    for (std::size_t k = 0; k < ramp.size(); ++k) {
        CHECK(std::min({ramp[k].r, ramp[k].g, ramp[k].b}) >= 0);
        CHECK(std::abs(luminance(glm::dvec3(ramp[k])) - 1) <= 1e-6);
        if (k > 0) {
            CHECK(ramp[k].a > ramp[k - 1].a);                              // brighter
            CHECK(ramp[k].r / ramp[k].g < ramp[k - 1].r / ramp[k - 1].g);  // and less red
        }
    }
    CHECK(std::abs(blackbody_ramp(kReferenceTemperature_K).a) <= 1e-6f);
}

// ------------------------------------------------------------------------------------------------- random

TEST_CASE("Philox: known answers") {
    using R = r123::Philox4x32;
    const R philox;
    const auto check = [&](R::ctr_type counter, R::key_type key, R::ctr_type expected) {
        const R::ctr_type got = philox(counter, key);
        for (int k = 0; k < 4; ++k) CHECK(got.v[k] == expected.v[k]);
    };
    check({{0, 0, 0, 0}}, {{0, 0}}, {{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}});
    const std::uint32_t f = 0xffffffff;
    check({{f, f, f, f}}, {{f, f}}, {{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}});
    check({{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, {{0xa4093822, 0x299f31d0}},
          {{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}});
}

TEST_CASE("random lives: even in 256 bins, and the numbers of chapter 01") {
    constexpr std::uint32_t kLives = 1u << 18;
    std::vector<std::vector<double>> bins(8, std::vector<double>(256));
    for (std::uint32_t id = 0; id < kLives; ++id) {
        const Uniforms r = random_life(12345, id, 3);
        for (int k = 0; k < 8; ++k) bins[k][int(256 * r.u[k])] += 1;
        if (id % 1000 == 0) {
            const Uniforms same = particle_loop::random_start(12345, id, 3);
            for (int k = 0; k < 8; ++k) CHECK(r.u[k] == same.u[k]);
        }
    }
    for (int k = 0; k < 8; ++k) {
        double chi2 = 0;
        for (const double n : bins[k]) chi2 += (n - kLives / 256.0) * (n - kLives / 256.0) / (kLives / 256.0);
        CAPTURE(k);
        // 255 degrees of freedom: 0.1 % and 99.9 % quantiles
        CHECK(chi2 >= 190.867);
        CHECK(chi2 <= 330.520);
    }
}

TEST_CASE("Philox: the first 2^20 words have the chi-square and the sum that they must have") {
    double chi2 = 0;
    std::vector<double> bins(256);
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < 1u << 20; ++i) {
        const std::uint32_t word = r123::Philox4x32()({{i, 0, 0, 0}}, {{12345, 0}}).v[0];
        sum += word;
        bins[word >> 24] += 1;
    }
    for (const double n : bins) chi2 += (n - 4096) * (n - 4096) / 4096;
    CHECK(sum == 2249985227571462u);
    CHECK(chi2 == 259.26318359375);  // integers over 4096: exact
}

// ------------------------------------------------------------------------------------------------- motion

TEST_CASE("drag step: constant and cooling buoyancy in a wind, against the solution") {
    struct Row {
        double t, x, z, vx, vz;
    };
    const std::vector<Row> constant_b = {
        {0.1, 0.01873075307798186, 0.12341344134747732, 0.3625384938440363, 1.4531731173050453},
        {0.5, 0.36787944117144233, 0.9598493014643029, 1.2642411176571153, 2.5803013970713944},
        {1.0, 1.1353352832366126, 2.419169104045766, 1.7293294335267746, 3.161661791908468},
        {3.0, 5.002478752176667, 9.253098440220834, 1.9950424956466672, 3.493803119558334}};
    const std::vector<Row> tc_1 = {
        {0.1, 0.01873075307798186, 0.12248506274869267, 0.3625384938440363, 1.4260053662868573},
        {0.5, 0.36787944117144233, 0.8724845049456659, 1.2642411176571153, 2.115847031832868},
        {1.0, 1.1353352832366126, 1.914895381872031, 1.7293294335267746, 1.9629325892272842},
        {3.0, 5.002478752176667, 4.458094158278649, 1.9950424956466672, 0.7850892732355187}};
    // Up is y here and z in the table. However many steps: each is exact.
    const auto check = [](const std::vector<Row>& rows, double cooling_s, auto real, int steps,
                          double tolerance) {
        using Real = decltype(real);
        for (const Row& row : rows) {
            CAPTURE(row.t);
            CAPTURE(steps);
            glm::vec<3, Real> x(0), v(0, 1, 0);
            const double dt = row.t / steps;
            for (int k = 0; k < steps; ++k) {
                Forces<Real> f{{2, 0.5, 0}, Real(6), Real(0.5), Real(cooling_s)};
                if (cooling_s > 0) f.buoyancy_m_per_s2 *= std::exp(-Real(k * dt / cooling_s));
                drag_step(f, Real(dt), x, v);
            }
            CHECK(std::abs(x.x - row.x) <= tolerance);
            CHECK(std::abs(x.y - row.z) <= tolerance);
            CHECK(std::abs(v.x - row.vx) <= tolerance);
            CHECK(std::abs(v.y - row.vz) <= tolerance);
            CHECK(x.z == 0);
        }
    };
    for (const int steps : {1, 2, 7, 100}) {
        check(constant_b, 0, 0.0, steps, 1e-12);  // fp64: rounding of numbers up to 10, a hundred times
        check(tc_1, 1, 0.0, steps, 1e-11);        // and the series of small steps, good to 3e-11 of dt^2
        check(constant_b, 0, 0.0f, steps, 2e-5);  // fp32: half an ulp of 9 is 5e-7, 100 times at worst
        check(tc_1, 1, 0.0f, steps, 2e-5);
    }
}

TEST_CASE("drag step: cooling as fast as drag, or nearly: against many small steps of RK4") {
    for (const double drag_s : {0.01, 0.1, 0.5})
        for (const double ratio : {1.0, 1.0 + 1e-9, 1.001, 1.03, 1.05, 0.97, 3.0, 100.0})
            for (const double dt : {1e-4, 0.02, 0.3}) {
                CAPTURE(drag_s);
                CAPTURE(ratio);
                CAPTURE(dt);
                const double cool_s = drag_s * ratio;
                glm::dvec3 x(0), v(0, 0.3, 0);
                drag_step<double>({{0, 0.2, 0}, 6.0, drag_s, cool_s}, dt, x, v);
                double y = 0, u = 0.3;
                const int parts = 2000;
                const double h = dt / parts;
                const auto rate = [&](double t, double speed) {
                    return (0.2 - speed) / drag_s + 6 * std::exp(-t / cool_s);
                };
                for (int k = 0; k < parts; ++k) {
                    const double t = k * h;
                    const double k1 = rate(t, u), k2 = rate(t + h / 2, u + h / 2 * k1),
                                 k3 = rate(t + h / 2, u + h / 2 * k2), k4 = rate(t + h, u + h * k3);
                    y += h * u + h * h / 6 * (k1 + k2 + k3);
                    u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
                }
                // RK4 with 2000 parts is right to 1e-9 at dt / drag = 30
                CHECK(std::abs(x.y - y) <= 1e-9);
                CHECK(std::abs(v.y - u) <= 1e-8);
            }
}

TEST_CASE("drag step: a drag ten thousand times stiffer than the step stays on the wind") {
    glm::vec3 x(0), v(100, -100, 0);
    for (int k = 0; k < 600; ++k) drag_step<float>({{2, 0, 0}, 6, 1e-6f, 1}, 1.0f / 60, x, v);
    CHECK(std::abs(v.x - 2) <= 1e-6f);
    CHECK(std::abs(v.y) <= 1e-5f);                  // b tau
    CHECK(std::abs(x.x - 20) <= 1e-3f);             // 600 additions of 1/30
    for (const float dt : {0.0f, 1e-30f, 1e15f}) {  // nothing, nearly nothing, 30 million years
        glm::vec3 y(1, 2, 3), w(4, 5, 6);
        drag_step<float>({{0, 0, 0}, 6, 0.1f, 0.5f}, dt, y, w);
        CHECK(std::isfinite(y.x + y.y + y.z + w.x + w.y + w.z));
        if (dt < 1) CHECK(y == glm::vec3(1, 2, 3));
    }
}

TEST_CASE("a particle of the kernel flies as the solution says") {
    Fire fire = plain_fire(300);
    ParticleKind& kind = fire.kind[0];
    kind.velocity_m_per_s = {0, 1, 0};
    kind.life_s = 4;
    kind.drag_time_s = 0.5f;
    kind.buoyancy_m_per_s2 = 6;
    kind.cooling_time_s = 1;
    fire.wind.steady_m_per_s = {2, 0.5f, 0};
    DeviceFire device(fire);
    device.run(700, 0.01f);  // into the second life of all
    const auto x = device.position.download(), v = device.velocity.download();
    std::vector<glm::vec3> got, expected;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(x[i].w >= 0 && x[i].w < v[i].w)) continue;
        glm::dvec3 y(0), u(0, 1, 0);
        drag_step<double>({{2, 0.5, 0}, 6, 0.5, 1}, x[i].w, y,
                          u);  // one step of its whole age: shown exact above
        got.push_back({x[i].x, x[i].y, x[i].z});
        expected.push_back(glm::vec3(y));
    }
    CHECK(got.size() > 290);
    // Up to 400 fp32 additions to a place of up to 7 m, 2.4e-7 each; and the age itself is known to 2e-7 s.
    course::check_close(got, expected, course::Tolerance(1e-4), "position");
}

TEST_CASE("air that changes along the way: half the step, a quarter of the error") {
    Fire fire = plain_fire(64);
    ParticleKind& kind = fire.kind[0];
    kind.life_s = 4;
    kind.emitter = {Emitter::ring, {0.1f, 0, 0}, {0, 1, 0}, 0.3f};
    kind.drag_time_s = 0.2f;
    kind.buoyancy_m_per_s2 = 3;
    fire.wind.updraft_m_per_s = 2;
    fire.wind.updraft_height_m = 0.5f;
    fire.wind.steady_m_per_s = {0.4f, 0, 0};
    fire.wind.gust = 0.5f;
    const auto after_2_s = [&](int steps) {
        DeviceFire device(fire);
        device.run(steps, 2.0f / steps);
        return device.position.download();
    };
    const auto exact = after_2_s(4096), coarse = after_2_s(64), fine = after_2_s(128);
    double coarse_m = 0, fine_m = 0;
    int compared = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (!(exact[i].w > 0.1f && coarse[i].w > 0)) continue;
        const auto apart = [&](float4 x) {
            return glm::distance(glm::vec3(x.x, x.y, x.z), glm::vec3(exact[i].x, exact[i].y, exact[i].z));
        };
        coarse_m += apart(coarse[i]), fine_m += apart(fine[i]), ++compared;
    }
    CHECK(compared > 20);
    CHECK(coarse_m / fine_m > 3.2);  // order 2 gives 4, order 1 gives 2
    CHECK(coarse_m / compared < 0.01);
}

TEST_CASE("air: neither plume nor curl noise has sources") {
    Wind wind;
    wind.steady_m_per_s = {1.6f, 0, 0.1f};
    wind.gust = 0.3f;
    wind.updraft_m_per_s = 2.4f;
    wind.updraft_height_m = 0.7f;
    wind.axis_m = {0.1f, 0, -0.2f};
    const CurlNoise noise = make_curl_noise(0.9f, 0.5f, 1.6f, 0.25f, 5);
    constexpr float kH = 1e-3f;
    double mean_square = 0;
    for (int k = 0; k < 500; ++k) {
        const Uniforms r = random_life(3, k, 0);
        const glm::vec3 x(r.u[0] - 0.5f, 0.02f + 2 * r.u[1], r.u[2] - 0.5f);
        const float t = 10 * r.u[3];
        double plume = 0, curl = 0;
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 h(0);
            h[axis] = kH;
            plume += (wind_at(wind, x + h, t)[axis] - wind_at(wind, x - h, t)[axis]) / (2 * kH);
            curl += (curl_noise(noise, x + h, t)[axis] - curl_noise(noise, x - h, t)[axis]) / (2 * kH);
        }
        // Differences of fp32 speeds of about 2 m/s over 2 mm: 2.4e-7 / 2e-3 = 1e-4 each; a wave's own third
        // derivative adds (k h)^2 / 6 = 4e-4 of slopes up to 50 / s. A source would be of the slopes' size.
        CHECK(std::abs(plume) <= 2e-3);
        CHECK(std::abs(curl) <= 5e-2);
        const glm::vec3 high = curl_noise(noise, x + glm::vec3(0, 5, 0), t);
        mean_square += glm::dot(high, high) / 500;
    }
    // 16 waves, 500 places: the mean square of 0.81 is met to about 10 %
    CHECK(std::abs(mean_square / 0.81 - 1) <= 0.15);
    CHECK(curl_noise(noise, {0.3f, 0, 0}, 1) == glm::vec3(0));
    CHECK(curl_noise(noise, {0.3f, -1, 0}, 1) == glm::vec3(0));
}

// ---------------------------------------------------------------------------------------- birth and death

TEST_CASE("emitters: evenly filled, and nothing outside") {
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, -1)), centre(3, -1, 2);
    constexpr int kPoints = 20000;
    for (const auto shape : {Emitter::point, Emitter::disc, Emitter::ring, Emitter::line}) {
        CAPTURE(int(shape));
        const Emitter emitter{shape, centre, axis, 0.5f};
        glm::dvec3 mean(0);
        double square = 0, along = 0;
        for (int k = 0; k < kPoints; ++k) {
            const Uniforms r = random_life(1, k, 0);
            float edge = -1;
            const glm::dvec3 x(birthplace(emitter, r.u[0], r.u[1], edge) - centre);
            mean += x / double(kPoints);
            square += glm::dot(x, x) / kPoints;
            along += std::abs(glm::dot(x, glm::dvec3(axis))) / kPoints;
            CHECK(edge >= 0);
            CHECK(edge <= 1);
            CHECK(glm::length(x) <= 0.500001);
        }
        // mean of r^2: disc R^2/2, ring R^2, line R^2/3. Four standard errors of 20000 points are below 3 %.
        const double expected = shape == Emitter::point  ? 0
                                : shape == Emitter::disc ? 0.125
                                : shape == Emitter::ring ? 0.25
                                                         : 0.25 / 3;
        CHECK(std::abs(square - expected) <= 0.03 * expected);
        CHECK(glm::length(mean) <= 4 * 0.5 / std::sqrt(double(kPoints)));
        if (shape == Emitter::line)
            CHECK(std::abs(along - 0.25) <= 0.01);
        else
            CHECK(along <= 1e-6);
    }
}

TEST_CASE("emitters: roots lie inside, and each gets its share") {
    Emitter emitter{Emitter::disc, {0, 0, 0}, {0, 1, 0}, 0.5f};
    emitter.roots = 7;
    emitter.root_m = 0.01f;
    std::vector<int> share(7);
    for (int k = 0; k < 7000; ++k) {
        const Uniforms r = random_life(1, k, 0);
        float edge;
        const glm::vec3 x = birthplace(emitter, r.u[0], r.u[1], edge);
        CHECK(glm::length(x) <= 0.5f);
        const float away = glm::length(x) / 0.5f;
        ++share[std::clamp(int(away * away * 7), 0, 6)];
    }
    for (const int n : share) CHECK(std::abs(n - 1000) <= 150);  // 1000 +- 5 standard deviations of 29
}

TEST_CASE("births: n particles of mean life T are born n / T times a second, whatever the time step") {
    Fire fire = plain_fire(4000);
    fire.kind[0].life_s = 0.5f;
    fire.kind[0].life_spread = 0.4f;
    fire.kind[0].decay_spread = 0.3f;
    double mean_life = 0;
    for (int id = 0; id < 4000; ++id)
        for (int g = 0; g < 20; ++g) mean_life += birth(fire.kind[0], random_life(1, id, g)).life_s / 80000;
    for (const float dt_s : {1.0f / 30, 1.0f / 240}) {
        CAPTURE(dt_s);
        DeviceFire device(fire);
        const int first = int(3 / dt_s), second = int(6 / dt_s);
        device.run(first, dt_s);
        const double before = births(device);
        double alive = 0;
        for (int k = first; k < second; ++k) {
            device.step(k, dt_s);
            alive += count_alive(device) / double(second - first);
        }
        const double rate = (births(device) - before) / ((second - first) * double(dt_s));
        // A renewal process is much more regular than Poisson's: sqrt(4000 * 3 s / T) * spread 0.3 of 24000
        CHECK(std::abs(rate * mean_life / 4000 - 1) <= 0.01);
        // Each misses the one step between its death and the next birth.
        CHECK(std::abs(alive / (4000 * (1 - dt_s / mean_life)) - 1) <= 0.01);
    }
}

TEST_CASE("steady count: rate times life, within Poisson's interval") {
    // Mean rest 198 s, life 2 s: 1000 births a second from 200,000 particles; 2000 alive, as good as Poisson.
    Fire fire = plain_fire(200000);
    fire.kind[0].life_s = 2;
    fire.kind[0].life_spread = 0.5f;  // 1 to 3 s
    fire.kind[0].rest_s = 198;
    fire.seed = 5;
    DeviceFire device(fire);
    constexpr float kDt_s = 1.0f / 20;
    device.run(int(4 / kDt_s), kDt_s);  // longer than the longest life
    const std::uint32_t alive = count_alive(device);
    MESSAGE("alive: " << alive);
    CHECK(alive >= 1854);  // 99.9 % of all runs
    CHECK(alive <= 2149);
    // Ages in the steady state: mean E[T^2] / (2 E[T]) = 1.0833 s; four standard errors of 2000 ages are
    // 0.06.
    double age = 0;
    const auto x = device.position.download(), v = device.velocity.download();
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i].w >= 0 && x[i].w < v[i].w) age += x[i].w / alive;
    CHECK(std::abs(age - 1.0833) <= 0.06);
}

TEST_CASE("fate: seed, id and generation alone decide") {
    const auto fate = [](std::uint32_t n, std::uint64_t seed) {
        FireScene scene = make_scene("torch", 1000, seed);
        scene.fire.kind_count = 1;
        scene.fire.kind[0].count = n;
        DeviceFire device(scene.fire, scene.curl);
        device.run(150, scene.dt_s);
        auto x = device.position.download();
        x.resize(300);
        return x;
    };
    const auto few = fate(300, 1), many = fate(5000, 1), other = fate(300, 2);
    course::check_equal(few, many, "position and age");  // others do not matter
    int same = 0;
    for (int i = 0; i < 300; ++i) same += few[i].x == other[i].x;
    CHECK(same < 3);
    // Any of its lives can be told without running the fire.
    FireScene scene = make_scene("torch", 1000, 1);
    scene.fire.kind_count = 1;
    DeviceFire device(scene.fire, scene.curl);
    device.run(300, scene.dt_s);
    const auto v = device.velocity.download(), x = device.position.download();
    const auto g = device.generation.download();
    for (std::size_t i = 0; i < v.size(); ++i)
        if (x[i].w >= 0)
            CHECK(v[i].w == birth(scene.fire.kind[0], random_life(1, std::uint32_t(i), g[i])).life_s);
}

TEST_CASE("kernel and plain loop agree, with and without noise, for any number of particles") {
    for (const std::uint32_t n : {1u, 255u, 256u, 257u, 1000u})
        for (const bool curl : {false, true}) {
            CAPTURE(n);
            CAPTURE(curl);
            FireScene scene = make_scene("campfire", std::max(n, 4u), 3);
            const std::uint32_t count = particle_count(scene.fire);
            DeviceFire device(scene.fire, curl);
            std::vector<FlameParticle> host;
            for (std::uint32_t i = 0; i < count; ++i) host.push_back(unborn(scene.fire, i));
            for (int k = 0; k < 120; ++k) {
                device.step(k, scene.dt_s);
                const float time_s = float(k * double(scene.dt_s));
                for (std::uint32_t i = 0; i < count; ++i) {
                    if (curl)
                        advance<true>(scene.fire, i, time_s, scene.dt_s, host[i]);
                    else
                        advance<false>(scene.fire, i, time_s, scene.dt_s, host[i]);
                }
            }
            const auto x = device.position.download();
            std::vector<glm::vec4> got, expected;
            for (std::uint32_t i = 0; i < count; ++i) {
                got.push_back({x[i].x, x[i].y, x[i].z, x[i].w});
                expected.push_back(glm::vec4(host[i].position_m, host[i].age_s));
            }
            // A GPU rounds sines and exponentials differently: 120 steps of 1e-7, in air whose slopes are
            // below 20 / s
            course::check_close(got, expected, course::Tolerance(1e-3), "position and age");
        }
}

TEST_CASE("no particle is ever out of this world") {
    for (const std::string& name : scene_names()) {
        CAPTURE(name);
        FireScene scene = make_scene(name, 2000, 9);
        DeviceFire device(scene.fire, scene.curl);
        device.run(scene.warm_up_steps, scene.dt_s);
        for (const float4 x : device.position.download()) {
            CHECK(std::isfinite(x.x + x.y + x.z + x.w));
            CHECK(std::abs(x.x) + std::abs(x.y) + std::abs(x.z) < 20);
        }
        CHECK(count_alive(device) > 0.5 * particle_count(scene.fire));
    }
}

// ----------------------------------------------------------------------------------------------- leaves out

#ifdef __CUDASIM__
TEST_CASE("one kernel a step, no grid, no sort, 36 bytes a particle") {
    for (const std::string& name : scene_names()) {
        CAPTURE(name);
        const FireScene scene = make_scene(name, 1000, 1);
        const std::uint32_t n = particle_count(scene.fire);
        const cudasim::Recording recording;
        DeviceFire device(scene.fire, scene.curl);
        CHECK(recording.bytes() == needs(scene, false).device_bytes * n);
        CHECK(needs(scene, false).device_bytes == 36);
        const std::size_t before = recording.launches().size(), allocations = recording.allocations();
        device.run(10, scene.dt_s);
        CHECK(recording.launches().size() - before == std::size_t(10 * needs(scene, false).kernels_per_step));
        CHECK(recording.count("flame_step_kernel") == 10);
        CHECK(recording.allocations() == allocations);
        CHECK(needs(scene, true).curl_waves == (name == "candle" ? 0 : kWaves));
    }
}

TEST_CASE("a picture sorts smoke and nothing else") {
    const auto context = context_or_skip();
    for (const std::string& name : scene_names()) {
        CAPTURE(name);
        const FireScene scene = make_scene(name, 1000, 1);
        const cudasim::Recording state;
        SharedFire fire(scene);
        CHECK(state.bytes() == needs(scene, true).device_bytes * fire.size());  // the rest is OpenGL's
        CHECK(needs(scene, true).device_bytes == 4);
        CHECK(needs(scene, true).gl_bytes == 32);
        FireView view(scene, 64, 36), unsorted(scene, 64, 36, SmokeOrder::unsorted);
        fire.step();
        const cudasim::Recording recording;
        view.draw(fire, camera_of(scene));
        CHECK(recording.count("depth_kernel") == std::size_t(needs(scene, true).sorts_per_picture));
        CHECK(needs(scene, true).sorts_per_picture == (name == "candle" ? 0 : 1));
        if (needs(scene, true).sorts_per_picture == 0) CHECK(recording.launches().empty());
        const std::size_t before = recording.launches().size();
        unsorted.draw(fire, camera_of(scene));
        CHECK(recording.launches().size() == before);
    }
}
#endif

TEST_CASE("numbers alone need no OpenGL, and all objects go with their owners") {
    const course::ProgramRun run = [&] {
        const course::TemporaryFolder out;
        return course::run_program(
            "ch07_fire_particles",
            "--draw none --scene candle --particles 500 --out '" + out.path().string() + "'",
            "LIBGL_DRIVERS_PATH=/nowhere EGL_PLATFORM=none");
    }();
    CHECK(run.exit_code == 0);
    const auto context = context_or_skip();
    const int live = course::gl_count().live;
    {
        const FireScene scene = make_scene("campfire", 500, 1);
        SharedFire fire(scene);
        FireView view(scene, 64, 36);
        fire.step();
        view.draw(fire, camera_of(scene));
        CHECK(course::gl_count().live > live);
    }
    CHECK(course::gl_count().live == live);
}

// ------------------------------------------------------------------------------------------------- sprites

namespace {

Stage dark() {
    Stage stage;
    stage.ground = false;
    stage.sky_low = stage.sky_high = glm::vec3(0);
    stage.glare = 0;
    return stage;
}
SpriteLook plain_look() {
    SpriteLook look;
    look.radius_start_m = look.radius_end_m = 0.2f;
    look.fade_in = look.fade_out = 1e-6f;
    look.wisps = 0;
    look.temperature_start_K = 0;  // its own colour
    look.light = 1;
    look.colour = {1, 0.5f, 0.25f};
    return look;
}
course::Camera front() {
    course::Camera camera;
    camera.eye_m = {0, 0, 3};
    camera.field_of_view_rad = 0.5f;
    return camera;
}
struct Sprite {
    glm::vec3 position_m, velocity_m_per_s{0};
    float age_s = 0.5f, life_s = 1;
};
std::vector<glm::vec4> light_of(FireRenderer& renderer, const std::vector<Sprite>& sprites,
                                const SpriteLook& look, const std::vector<FireLight>& lights = {}) {
    std::vector<glm::vec4> x, v;
    for (const Sprite& s : sprites) {
        x.push_back(glm::vec4(s.position_m, s.age_s));
        v.push_back(glm::vec4(s.velocity_m_per_s, s.life_s));
    }
    const course::GlBuffer position = gl_test::buffer_of(x), velocity = gl_test::buffer_of(v);
    renderer.begin(front(), lights);
    renderer.draw({&position, &velocity, 0, x.size()}, look);
    return renderer.light();
}
double total(const std::vector<glm::vec4>& light) {
    double sum = 0;
    for (const glm::vec4& texel : light) sum += texel.r;
    return sum;
}

}  // namespace

TEST_CASE("sprites: soft, as large as told, of the colour told") {
    const auto context = context_or_skip();
    FireRenderer renderer(200, 200, dark());
    const auto light = light_of(renderer, {{glm::vec3(0)}}, plain_look());
    const float pixels_per_m = 200 / (2 * 3 * std::tan(0.25f));
    double worst = 0;
    for (int j = 0; j < 200; ++j)
        for (int i = 0; i < 200; ++i) {
            const glm::vec2 place = (glm::vec2(i, j) + 0.5f - 100.0f) / (pixels_per_m * 0.2f);
            const float inside = std::max(0.0f, 1 - glm::dot(place, place));
            const glm::vec4 expected(inside * inside * glm::vec3(1, 0.5f, 0.25f), 0);
            worst = std::max(worst, double(glm::length(light[j * 200 + i] - expected)));
        }
    // fp32 interpolation across a sprite of 26 pixels
    CHECK(worst <= 1e-4);
}

TEST_CASE("sprites: light adds up in any order, and longer sprites give no more of it") {
    const auto context = context_or_skip();
    FireRenderer renderer(160, 120, dark());
    std::vector<Sprite> sprites;
    for (int k = 0; k < 500; ++k) {
        const Uniforms r = random_life(7, k, 0);
        sprites.push_back({{r.u[0] - 0.5f, r.u[1] - 0.5f, r.u[2] - 0.5f}, {0, r.u[3], 0}, r.u[4], 1});
    }
    SpriteLook look = plain_look();
    look.light = 0.05f;
    look.stretch_s = 0.1f;
    const auto forward = light_of(renderer, sprites, look);
    std::reverse(sprites.begin(), sprites.end());
    const auto backward = light_of(renderer, sprites, look);
    CHECK(relative_error(backward, forward) <= 1e-5);  // fp32 sums of some 50 numbers, in another order

    const double round = total(light_of(renderer, {{glm::vec3(0)}}, plain_look()));
    look = plain_look();
    look.stretch_s = 0.2f;
    const double sideways = total(light_of(renderer, {{glm::vec3(0), {2, 0, 0}}}, look));
    const double upwards = total(light_of(renderer, {{glm::vec3(0), {0, 2, 0}}}, look));
    const double towards = total(light_of(renderer, {{glm::vec3(0), {0, 0, 2}}}, look));
    // Some 400 pixels sampled at their middles: 1 %
    CHECK(std::abs(sideways / round - 1) <= 0.01);
    CHECK(std::abs(upwards / round - 1) <= 0.01);
    CHECK(std::abs(towards / round - 1) <= 0.01);
    look.stretch_s = 0;
    for (const Sprite gone :
         {Sprite{glm::vec3(0), glm::vec3(0), -0.1f, 1}, Sprite{glm::vec3(0), glm::vec3(0), 1, 1},
          Sprite{glm::vec3(0, 0, 4)}, Sprite{glm::vec3(NAN, 0, 0)}})
        CHECK(total(light_of(renderer, {gone}, look)) == 0);
}

TEST_CASE("sprites: hidden behind what is solid, and faded where they touch it") {
    const auto context = context_or_skip();
    Stage stage = dark();
    stage.rods = {{{-1, 0, 0}, {1, 0, 0}, 0.1f, Rod::wood, 0}};
    FireRenderer renderer(100, 100, stage);
    SpriteLook look = plain_look();
    look.radius_start_m = look.radius_end_m = 0.05f;
    look.softness_m = 0.1f;
    const double before = total(light_of(renderer, {{{0, 0, 0.5f}}}, look));
    const double touching = total(light_of(renderer, {{{0, 0, 0.15f}}}, look));
    CHECK(before > 0);
    CHECK(touching > 0.3 * before);
    CHECK(touching < 0.8 * before);
    CHECK(total(light_of(renderer, {{{0, 0, -0.2f}}}, look)) == 0);
}

TEST_CASE("sprites: a black body's colour and brightness") {
    const auto context = context_or_skip();
    FireRenderer renderer(64, 64, dark());
    SpriteLook look = plain_look();
    look.radius_start_m = look.radius_end_m = 1;
    look.colour = glm::vec3(1);
    for (const float kelvin : {1400.0f, 1650.0f, 1900.0f}) {
        CAPTURE(kelvin);
        look.temperature_start_K = look.temperature_end_K = kelvin;
        const auto light = light_of(renderer, {{glm::vec3(0)}}, look);
        const glm::vec4 body = blackbody_ramp(kelvin);
        const glm::dvec3 expected = glm::dvec3(body) * std::exp(double(body.a));
        const glm::dvec3 got(light[32 * 64 + 32]);
        // A ramp of 256 texels, linear between them; and the pixel's middle is 1/64 off the sprite's
        CHECK(glm::length(got - expected) <= 0.005 * glm::length(expected));
    }
}

TEST_CASE("smoke: sorted from back to front, as the CPU would") {
    const auto context = context_or_skip();
    FireScene scene = make_scene("campfire", 4000, 1);
    SharedFire fire(scene);
    for (int k = 0; k < 200; ++k) fire.step();
    const ParticleKind& kind = scene.fire.kind[1];
    DepthSort sort(kind.count, 1 << 16);
    const course::Camera camera = camera_of(scene);
    sort.sort(fire, kind.first, kind.count, camera);
    std::vector<glm::vec4> sorted(kind.count), lives(kind.count);
    glBindBuffer(GL_ARRAY_BUFFER, sort.position().gl_buffer().id());
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(16 * kind.count), sorted.data());
    glBindBuffer(GL_ARRAY_BUFFER, sort.velocity().gl_buffer().id());
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(16 * kind.count), lives.data());
    const float slice_m = 2 * scene.view.distance_m / float(1 << 16);
    float last_m = 1e9f;
    std::size_t alive = 0;
    for (std::size_t k = 0; k < sorted.size() && sorted[k].w >= 0 && sorted[k].w < lives[k].w; ++k, ++alive) {
        const float depth_m = -(camera.view() * glm::vec4(glm::vec3(sorted[k]), 1)).z;
        CHECK(depth_m <= last_m + slice_m);
        last_m = depth_m;
    }
    CHECK(alive > 300);
    for (std::size_t k = alive; k < sorted.size(); ++k)  // then those that are not there
        CHECK(!(sorted[k].w >= 0 && sorted[k].w < lives[k].w));
}

TEST_CASE("smoke: the one in front covers the one behind") {
    const auto context = context_or_skip();
    FireRenderer renderer(64, 64, dark());
    SpriteLook look = plain_look();
    look.blend = Blend::alpha;
    look.opacity = 0.75f;
    look.radius_start_m = look.radius_end_m = 1;
    look.colour = glm::vec3(1);
    const FireLight near{{0, 0, 1}, glm::vec3(1), 0.5f};
    // The nearer puff is lit more: 1 / (0.5^2 + 0.5^2) = 2, the farther 1 / (2^2 + 0.5^2)
    const auto light = light_of(renderer, {{{0, 0, -1}}, {{0, 0, 0.5f}}}, look, {near});
    const glm::vec4 got = light[32 * 64 + 32];
    const double back = 0.75 / 4.25, expected = 0.75 * 2 + 0.25 * back;
    CHECK(std::abs(got.r - expected) <= 0.01);  // the pixel's middle is not the sprite's
    CHECK(std::abs(got.a - (1 - 0.25 * 0.25)) <= 0.01);
}

TEST_CASE("film: no white blob, no cut, and dark where nothing shines") {
    const auto context = context_or_skip();
    for (const std::string& name : scene_names()) {
        CAPTURE(name);
        const FireScene scene = make_scene(name, 8000, 1);
        SharedFire fire(scene);
        for (int k = 0; k < scene.warm_up_steps; ++k) fire.step();
        FireView view(scene, 320, 180);
        view.draw(fire, camera_of(scene));
        const course::Image image = view.image();
        int white = 0, bright = 0, dark = 0;
        for (int k = 0; k < 320 * 180; ++k) {
            const std::uint8_t* p = &image.rgb[3 * k];
            white += p[2] >= 250;                // blue as strong as it can be: white, for a fire
            bright += p[0] > 200 && p[1] > 120;  // yellow
            dark += p[0] < 60;
        }
        CHECK(white <= 0.0005 * 320 * 180);
        CHECK(bright >= 0.002 * 320 * 180);
        CHECK(dark >= 0.5 * 320 * 180);
        // And it is a fire that shines, not something that was there.
        SharedFire unlit(scene);
        view.draw(unlit, camera_of(scene));
        CHECK(difference(view.image(), image) > 3);
    }
}

// -------------------------------------------------------------------------------------------- bad input

TEST_CASE("the program says what is wrong") {
    const auto run = [](const std::string& arguments) {
        const course::TemporaryFolder out;
        return course::run_program("ch07_fire_particles", arguments + " --out '" + out.path().string() + "'");
    };
    const auto refused = [&](const std::string& arguments, const std::string& why) {
        CAPTURE(arguments);
        const course::ProgramRun ended = run(arguments);
        CHECK(ended.exit_code == 2);
        CHECK(ended.output.find(why) != std::string::npos);
    };
    refused("--scene candle --dt 0.1", "live only");
    refused("--scene torch --dt nan", "--dt");
    refused("--scene torch --dt 1e-9", "ages would not grow");
    refused("--scene torch --dt 1e-30 --steps 1", "ages would not grow");
    refused("--particles 0", "particles");
    refused("--scene bonfire", "bonfire");
    refused("--draw smoke", "--draw");
    refused("--exposure 100", "--exposure");
    refused("--exposure nan", "--exposure");
    refused("--particles 4294967295", "");
    const course::ProgramRun explained = run("--explain --scene candle");
    CHECK(explained.exit_code == 0);
    CHECK(explained.output.find("1 kernel (flame_step_kernel<false>)") != std::string::npos);
    CHECK(explained.output.find("32 bytes in OpenGL buffers, 4 from cudaMalloc") != std::string::npos);
}

TEST_CASE("extremes: one particle, the longest step, no light, all light") {
    const auto context = context_or_skip();
    for (const std::string& name : scene_names()) {
        CAPTURE(name);
        FireScene scene = make_scene(name, 1, 1);
        scene.dt_s = 0.01f;
        SharedFire fire(scene);
        for (int k = 0; k < 30; ++k) fire.step();
        for (const float exposure : {0.0f, 1e-6f, 1e6f}) {
            scene.stage.exposure = exposure;
            FireView view(scene, 33, 17);
            view.draw(fire, camera_of(scene));
            CHECK(view.image().rgb.size() == 3 * 33 * 17);
        }
    }
    FireRenderer renderer(16, 16, dark());
    CHECK_THROWS_AS(renderer.begin(front(), std::vector<FireLight>(5)), std::logic_error);
    const course::GlBuffer small(16);
    renderer.begin(front(), {});
    CHECK_THROWS_AS(renderer.draw({&small, &small, 0, 2}, plain_look()), std::logic_error);
    CHECK_THROWS_AS(renderer.draw({&small, &small, 1, 1}, plain_look()), std::logic_error);
}

TEST_CASE("extremes: nobody, a broken particle, very fast, very far, very long") {
    Fire nobody;
    launch_flame_clear({nullptr, nullptr, nullptr}, nobody);  // no launch of 0 blocks
    launch_flame_step({nullptr, nullptr, nullptr}, nobody, true, 0, 0.01f);
    CHECK(cudaGetLastError() == cudaSuccess);

    // A particle that is not a number harms nobody, and is a number again in its next life.
    const FireScene scene = make_scene("torch", 500, 1);
    DeviceFire healthy(scene.fire, true), hurt(scene.fire, true);
    healthy.run(100, scene.dt_s);
    hurt.run(100, scene.dt_s);
    auto x = hurt.position.download();
    x[77].x = x[77].y = NAN;
    hurt.position.upload(x);
    for (int k = 100; k < 400; ++k) {
        healthy.step(k, scene.dt_s);
        hurt.step(k, scene.dt_s);
    }
    course::check_equal(hurt.position.download(), healthy.position.download(), "position and age");

    // A million metres a second, and a fire 10 km away: drag and fp32 do what they must, and nothing else.
    for (const bool far : {false, true}) {
        CAPTURE(far);
        Fire fire = plain_fire(100);
        fire.kind[0].life_s = 1;
        if (far)
            fire.kind[0].emitter.centre_m = {1e4f, 1e4f, -1e4f};
        else
            fire.kind[0].velocity_m_per_s = {1e6f, 0, 0};
        fire.noise = make_curl_noise(1, 0.3f, 1, 0.1f, 2);
        DeviceFire device(fire, true);
        device.run(150, 0.01f);
        for (const float4 y : device.position.download()) {
            CHECK(std::isfinite(y.x + y.y + y.z));
            CHECK(std::abs(y.x) <= 1.1e5f);  // 1e6 m/s x 0.1 s of drag
        }
        CHECK(count_alive(device) >= 95);
    }

    // All at one point, with one life and no spread, still are born one after the other.
    DeviceFire point(plain_fire(1000));
    point.run(150, 0.01f);  // life 1 s
    std::vector<float> ages;
    for (const float4 y : point.position.download())
        if (y.w < 1) ages.push_back(y.w);
    std::sort(ages.begin(), ages.end());
    CHECK(ages.size() > 970);
    CHECK(std::unique(ages.begin(), ages.end()) - ages.begin() > 900);

    // A drag that holds at once, and none at all.
    for (const float drag_s : {1e-38f, 1e38f}) {
        CAPTURE(drag_s);
        glm::vec3 y(0), v(3, 0, 0);
        drag_step<float>({{1, 0, 0}, 2, drag_s, 0}, 0.5f, y, v);
        CHECK(std::abs(y.x - (drag_s < 1 ? 0.5f : 1.5f)) <= 1e-6f);
        CHECK(std::abs(y.y - (drag_s < 1 ? 0.0f : 0.25f)) <= 1e-6f);
        CHECK(std::abs(v.y - (drag_s < 1 ? 0.0f : 1.0f)) <= 1e-6f);
    }
}

TEST_CASE("a scene that makes no sense is refused") {
    const auto refused = [](const std::function<void(FireScene&)>& change) {
        FireScene scene = make_scene("torch", 10, 1);
        check(scene);  // it made sense before
        change(scene);
        CHECK_THROWS_AS(check(scene), course::BadInput);
    };
    refused([](FireScene& s) { s.fire.kind[0].life_s = NAN; });
    refused([](FireScene& s) { s.fire.kind[0].life_s = 0; });
    refused([](FireScene& s) { s.fire.kind[0].life_spread = 1; });
    refused([](FireScene& s) { s.fire.kind[0].decay_spread = -0.1f; });
    refused([](FireScene& s) { s.fire.kind[0].drag_time_s = 0; });
    refused([](FireScene& s) { s.fire.kind[0].cooling_time_s = NAN; });
    refused([](FireScene& s) { s.fire.kind[0].buoyancy_m_per_s2 = INFINITY; });
    refused([](FireScene& s) { s.fire.kind[0].edge_life = 0; });
    refused([](FireScene& s) { s.fire.kind[0].emitter.size_m = 0; });
    refused([](FireScene& s) { s.dt_s = 1; });
}

// --------------------------------------------------------------------------------------------- studies

TEST_CASE("the whirl's solution solves its equation, and the steps come to it with their orders") {
    const Whirl whirl;
    const glm::dvec3 x0(0.3, 0, 0.1), v0(0, 0.5, 0.2);
    CHECK(glm::distance(whirl.exact(x0, v0, 0), x0) <= 1e-12);
    const auto error = [&](Stepper stepper, int steps) {
        glm::dvec3 x = x0, v = v0;
        for (int k = 0; k < steps; ++k) whirl_step(whirl, stepper, k / double(steps), 1.0 / steps, x, v);
        return glm::distance(x, whirl.exact(x0, v0, 1));
    };
    const auto order = [&](Stepper stepper) {
        return std::log2(error(stepper, 1000) / error(stepper, 2000));
    };
    CHECK(order(Stepper::explicit_euler) == doctest::Approx(1).epsilon(0.05));
    CHECK(order(Stepper::semi_implicit_euler) == doctest::Approx(1).epsilon(0.05));
    CHECK(order(Stepper::exponential) == doctest::Approx(1).epsilon(0.05));
    CHECK(order(Stepper::exponential_ahead) == doctest::Approx(2).epsilon(0.05));
}

TEST_CASE("drag: Euler's limit is 2 / drag, the exponential step has none") {
    for (const double drag : {1.0, 1e4}) {
        CHECK(drag_is_stable(Stepper::explicit_euler, drag, 1.99 / drag));
        CHECK(!drag_is_stable(Stepper::explicit_euler, drag, 2.01 / drag));
        CHECK(!drag_is_stable(Stepper::semi_implicit_euler, drag, 2.01 / drag));
        CHECK(drag_is_stable(Stepper::exponential, drag, 1e6 / drag));
    }
}
