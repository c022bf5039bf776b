// Chapter 13: the march against formulas, the grid against its particles, the pictures against the CPU.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "13_volume_rendering/explain.h"
#include "13_volume_rendering/known_volumes.h"
#include "13_volume_rendering/studies.cuh"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

using namespace volume;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr const char* kProgram = "ch13_volume_rendering";

// ------------------------------------------------------------------------------------------- known answers

/// The ray along z through the middle of a known volume, in as many steps as asked for.
template <StepRule kRule, class Field>
Seen<double> march_along_z(const Field& field, int steps, double x = 0) {
    const Ray<double> ray{{x, 0, -5}, {0, 0, 1}};
    const Span<double> span = box_span(ray, glm::dvec3(field.low_m()), glm::dvec3(field.high_m()));
    // A hair more than the exact length, so that rounding does not make one step more of it.
    const float step_m = float((span.far_m - span.near_m) / steps * (1 + 1e-6));
    return march<kRule>(field, ray, span, {step_m, 0});
}

constexpr double kSlabAnswer = 1.4253193974482041, kSlabTransmittance = 0.049787068367863944;
const Slab<double> kSlab{2, 3, 1.5};

/// A camera in front of the origin, looking along -z.
Lens front_lens(int width, int height, float distance_m = 4) {
    course::Camera camera;
    camera.eye_m = {0.1f, 0.2f, distance_m};
    return make_lens(camera, width, height);
}

template <StepRule kRule = StepRule::exponential, class Field>
std::vector<float4> picture_of(const Field& field, const Lens& lens, MarchSettings settings) {
    course::DeviceBuffer<float4> seen(std::size_t(lens.width) * lens.height);
    launch_march<kRule>(seen.data(), field, lens, settings);
    return seen.download();
}

// --------------------------------------------------------------------------------------------- particles

/// Live particles of two kinds, at random in a box somewhat larger than the grid of small_grid().
struct Cloud {
    std::vector<float4> position, velocity;
    Cargos cargos;
};
Cloud make_cloud(std::uint32_t n, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-0.6f, 0.6f), unit(0, 1);
    Cloud cloud;
    cloud.cargos.count = 2;
    cloud.cargos.first[1] = n / 2;
    cloud.cargos.cargo[0] = {{0.08f, 0.05f}, {2e-6f, 1e-6f}, {12, 6}, 0.1f, 0.3f};
    cloud.cargos.cargo[1] = {{0.10f, 0.16f}, {3e-6f, 3e-6f}, {0, 0}, 0.2f, 0.2f};
    for (std::uint32_t i = 0; i < n; ++i) {
        cloud.position.push_back(make_float4(at(random), at(random), at(random), unit(random)));
        cloud.velocity.push_back(make_float4(0, 0, 0, 1));  // lives 1 s: the age is the part that is burnt
    }
    return cloud;
}
CellGrid small_grid() {
    return grid_over({-0.5f, -0.5f, -0.45f}, {0.5f, 0.55f, 0.5f}, 0.06f);
}

Sums splat(const Cloud& cloud, const CellGrid& cells) {
    const course::DeviceBuffer<float4> position(cloud.position), velocity(cloud.velocity);
    Splatter splatter(cells, Gas{});
    splatter.splat(position.data(), velocity.data(), std::uint32_t(cloud.position.size()), cloud.cargos);
    return splatter.sums();
}

unsigned long long sum(const std::vector<unsigned long long>& values) {
    unsigned long long total = 0;
    for (const unsigned long long v : values) total += v;
    return total;
}

/// A volume on the device that holds a cloud.
struct CloudVolume {
    Cloud cloud;
    FireVolume fire;
    CloudVolume(std::uint32_t n, VolumeLook look) : cloud(make_cloud(n, 7)), fire(with(look, cloud)) {
        const course::DeviceBuffer<float4> position(cloud.position), velocity(cloud.velocity);
        fire.fill(position.data(), velocity.data(), n);
        CUDA_CHECK(cudaDeviceSynchronize());
    }
    static VolumeLook with(VolumeLook look, const Cloud& cloud) {
        look.cargos = cloud.cargos;
        return look;
    }
};
VolumeLook small_look() {
    VolumeLook look;
    look.low_m = {-0.5f, -0.5f, -0.45f};
    look.high_m = {0.5f, 0.55f, 0.5f};
    look.cell_m = 0.06f;
    look.block_edge = 4;
    look.enough = 0;
    return look;
}

/// A grid that is the same everywhere.
struct Uniform {
    CellGrid cells;
    course::DeviceBuffer<float2> values;
    course::DeviceBuffer<float4> glow;
    Uniform(glm::vec3 low_m, glm::vec3 high_m, float cell_m, float extinction_per_m, float temperature_K)
        : cells(grid_over(low_m, high_m, cell_m)),
          values(std::vector<float2>(cells.cell_count(), make_float2(extinction_per_m, temperature_K))),
          glow(glow_table()) {}
    FireField<false> field(float albedo = 0) const {
        return {cells, values.data(), glow.data(), albedo, {}, {}, {}};
    }
};

bool same_bits(const std::vector<float4>& a, const std::vector<float4>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float4)) == 0;
}

}  // namespace

// ------------------------------------------------------------------------------------- the march, in double

TEST_CASE("a slab: 1 - exp(-sigma dx) is exact at any number of steps") {
    for (const int steps : {1, 8, 16, 32, 64, 128}) {
        CAPTURE(steps);
        const Seen<double> seen = march_along_z<StepRule::exponential>(kSlab, steps);
        CHECK(!(std::abs(seen.light.x - kSlabAnswer) > 1e-13));  // sums of up to 128 doubles
        CHECK(!(std::abs(seen.transmittance - kSlabTransmittance) > 1e-14));
    }
}

TEST_CASE("a slab: the errors of the two other rules are those of the reference") {
    const int steps[] = {8, 16, 32, 64, 128};
    const double proportional[] = {0.03975600600371543, 0.02057214255547013, 0.010407704058350564,
                                   0.005228985045039547, 0.002620179215786056};
    const double midpoint[] = {-0.008317353246556136, -0.0020857313108173514, -0.0005218337786114802,
                               -0.00013048352585620648, -3.262244937940473e-05};
    for (int k = 0; k < 5; ++k) {
        CAPTURE(steps[k]);
        const Seen<double> two = march_along_z<StepRule::midpoint>(kSlab, steps[k]);
        // The rounding of 128 steps in double: far below the smallest error in the table.
        CHECK(!(std::abs(two.light.x - kSlabAnswer - midpoint[k]) > 1e-12));
        const Seen<double> one = march_along_z<StepRule::proportional>(kSlab, steps[k]);
        CHECK(!(std::abs(one.light.x - kSlabAnswer - proportional[k]) > 1e-12));
    }
}

TEST_CASE("a slab that hardly absorbs, and one that lets nothing through") {
    // sigma -> 0: I = j L. mean_decay keeps the digits that 1 - exp(-x) loses.
    const Seen<double> thin = march_along_z<StepRule::exponential>(Slab<double>{1e-12, 3, 1.5}, 16);
    CHECK(!(std::abs(thin.light.x - 4.5) > 1e-11));
    const Seen<double> none = march_along_z<StepRule::exponential>(Slab<double>{0, 3, 1.5}, 16);
    CHECK(!(std::abs(none.light.x - 4.5) > 1e-13));
    CHECK(none.transmittance == 1);
    for (const double sigma : {1e6, 1e30}) {  // the source function of the front is all one sees
        const Seen<double> thick =
            march_along_z<StepRule::exponential>(Slab<double>{sigma, 2 * sigma, 1.5}, 16);
        CHECK(!(std::abs(thick.light.x - 2) > 1e-13));
        CHECK(thick.transmittance == 0);
    }
}

TEST_CASE("a Gaussian cloud: light and errors are those of the reference") {
    const double answer = 1.44794720085779;
    const int steps[] = {16, 32, 64, 128, 256};
    const double error[] = {0.00025415966143560453, 6.399992023276013e-05, 1.6028570003934206e-05,
                            4.00892684471188e-06, 1.002343194000943e-06};
    const GaussianCloud<double> cloud{1.3, 0.4, 2};
    for (int k = 0; k < 5; ++k) {
        CAPTURE(steps[k]);
        const Seen<double> seen = march_along_z<StepRule::exponential>(cloud, steps[k]);
        // The reference's answer has 15 digits; its errors are differences from it.
        CHECK(!(std::abs(seen.light.x - answer - error[k]) > 1e-12));
    }
    // (b): the glow has another width than the density, and neither has an end. The reference is a quadrature
    // good to 1e-13. At |z| = 3 m both are below 1e-12, and the midpoint rule of a smooth hump converges
    // fast.
    const GaussianCloud<double> endless{1.3, 0.4, 0, 2, 0.25, 3};
    CHECK(!(std::abs(march_along_z<StepRule::exponential>(endless, 20000).light.x - 0.6786610835527159) >
            1e-7));
    const Seen<double> beside = march_along_z<StepRule::exponential>(endless, 1000, 0.5);
    CHECK(!(std::abs(-std::log(beside.transmittance) - 0.596761385836768) > 1e-12));
}

TEST_CASE("a ball: what shines through is known at three distances from its middle") {
    const double offset[] = {0, 0.5, 0.9},
                 through[] = {0.1353352832366127, 0.17692120631776423, 0.41820656716303695};
    for (const int steps : {100, 1000, 10000})
        for (int k = 0; k < 3; ++k) {
            CAPTURE(offset[k]);
            const Seen<double> seen =
                march_along_z<StepRule::exponential>(Ball<double>{1, 0}, steps, offset[k]);
            // The edge falls between two samples at each end: up to half a step too much or too little each.
            CHECK(!(std::abs(std::log(seen.transmittance / through[k])) > 2.0 / steps * 1.001));
        }
}

// ------------------------------------------------------------------------------------------ rays and boxes

TEST_CASE("rays from inside, beside, along a face, away from it, and without a direction") {
    const glm::vec3 low(-1), high(1);
    const auto span = [&](glm::vec3 from, glm::vec3 way) {
        return box_span(Ray<float>{from, way}, low, high);
    };
    CHECK(span({0, 0, 5}, {0, 0, -1}).near_m == 4);
    CHECK(span({0, 0, 5}, {0, 0, -1}).far_m == 6);
    CHECK(span({0, 0, 0}, {0, 0, -1}).near_m == 0);  // from inside
    CHECK(span({0, 0, 0}, {0, 0, -1}).far_m == 1);
    CHECK(span({0, 0, 5}, {0, 0, 1}).empty());      // away from it
    CHECK(span({0, 2, 5}, {0, 0, -1}).empty());     // beside it
    CHECK(span({1, 0, 5}, {0, 0, -1}).far_m == 6);  // along a face: inside
    CHECK(span({1.001f, 0, 5}, {0, 0, -1}).empty());
    CHECK(!span({5, 5, 5}, glm::normalize(glm::vec3(-1))).empty());  // through a corner, along the diagonal
    CHECK(span({0, 0, 5}, {0, 0, kNan}).empty());
    CHECK(span({kNan, 0, 5}, {0, 0, 0}).empty());
}

TEST_CASE("the kernel's pictures of known volumes agree with the CPU's, and with the formula") {
    const Lens lens = front_lens(61, 43);  // no multiple of a block's 8 pixels
    const MarchSettings settings{0.05f, 0};
    const auto reference = [&](const auto& field) {
        std::vector<float4> seen;
        for (int y = 0; y < lens.height; ++y)
            for (int x = 0; x < lens.width; ++x) {
                const Ray<float> r = lens.ray(x, y);
                const Ray<double> ray{glm::dvec3(r.origin_m), glm::dvec3(r.direction)};
                const Seen<double> s =
                    march(field, ray, box_span(ray, glm::dvec3(field.low_m()), glm::dvec3(field.high_m())),
                          settings);
                seen.push_back(make_float4(float(s.light.x), float(s.light.y), float(s.light.z),
                                           float(s.transmittance)));
            }
        return seen;
    };
    // Some 60 steps in fp32. Where a ray grazes an edge of the box its length is small, and one step more or
    // less of it does not matter.
    course::check_close(picture_of(GaussianCloud<float>{1.3f, 0.4f, 2}, lens, settings),
                        reference(GaussianCloud<double>{1.3, 0.4, 2}), course::Tolerance(2e-5), "light",
                        "pixel");
    course::check_close(picture_of(Slab<float>{2, 3, 1.5f}, lens, settings),
                        reference(Slab<double>{2, 3, 1.5}), course::Tolerance(2e-5), "light", "pixel");
    for (const float4& s : picture_of(Slab<float>{2, 3, 1.5f}, lens, {1e-3f, 0}))
        CHECK(!(std::abs(s.x - 1.5f * (1 - s.w)) >
                3e-4f));  // I = j / sigma (1 - T): 2000 roundings of 6e-8 x 1.5
}

TEST_CASE("a uniform grid is a slab: through the kernel, from outside and from inside") {
    const Uniform uniform({-0.5f, -0.5f, -0.75f}, {0.5f, 0.5f, 0.75f}, 0.1f, 2, 1900);
    const glm::vec3 glow = glow_at(glow_table().data(), 1900);
    for (const float distance_m : {4.0f, 0.75f, 0.2f}) {
        course::Camera camera;
        camera.eye_m = {0, 0, distance_m};
        const float4 seen = picture_of(uniform.field(), make_lens(camera, 1, 1), {0.03f, 0})[0];
        const float depth = 2 * (std::min(distance_m, 0.75f) + 0.75f);
        CHECK(!(std::abs(seen.w - std::exp(-depth)) > 2e-6f));  // 50 products of numbers below 1, in fp32
        CHECK(!(std::abs(seen.x - glow.x * (1 - std::exp(-depth))) > 1e-5f));
        CHECK(!(std::abs(seen.y - glow.y * (1 - std::exp(-depth))) > 1e-5f));
    }
}

TEST_CASE("steps that are zero, negative, no number, far too small or far too long") {
    const Slab<float> slab{2, 3, 1.5f};
    const Lens lens = front_lens(3, 3);
    for (const float step_m : {0.0f, -1.0f, kNan, kInfinity})
        CHECK_THROWS_AS(picture_of(slab, lens, {step_m, 0}), course::BadInput);
    for (const float enough : {-0.1f, 1.0f, kNan})
        CHECK_THROWS_AS(picture_of(slab, lens, {0.1f, enough}), course::BadInput);
    CHECK_THROWS_AS(picture_of(slab, Lens{}, {0.1f, 0}), course::BadInput);  // a picture of 0 x 0 pixels
    for (const float step_m :
         {1e-30f, 1e30f}) {  // 65,536 steps at most, one at least: a slab is exact in both
        const float4 seen = picture_of(slab, front_lens(1, 1), {step_m, 0})[0];
        CHECK(!(std::abs(seen.x - 1.5f * (1 - seen.w)) > 2e-3f));  // 65,536 roundings of up to 6e-8
        CHECK(
            !(std::abs(seen.w - 0.0498f) > 5e-3f));  // the camera looks a little askew: a slightly longer way
    }
}

// ----------------------------------------------------------------------------------------------- the splat

TEST_CASE("along one axis a particle's shares make one, wherever it is") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(0, 20), radius(0, 9);
    for (int k = 0; k < 2000; ++k) {
        const float x = k < 3 ? float(10 * k) : place(random), r = k % 5 == 0 ? 0.0f : radius(random);
        const AxisWeights w = axis_weights(x, r, 20);
        double total = 0, moment = 0;
        for (int c = 0; c < w.count; ++c) {
            CHECK(w.weight[c] >= 0);
            total += w.weight[c];
            moment += w.weight[c] * (w.first + c + 0.5);
        }
        REQUIRE(w.count >= 1);
        CHECK(w.first >= 0);
        CHECK(w.first + w.count <= 20);
        CHECK(!(std::abs(total - 1) > 1e-6));  // up to 19 weights, each rounded to 6e-8
        // Away from the rim the middle stays near: a smooth hump, sampled. 0.11 cells is what a hump of one
        // cell's radius is off at worst (at a quarter of the way between two centres).
        if (x > 10 - 1 && x < 10 + 1) CHECK(!(std::abs(moment - x) > 0.12));
    }
}

TEST_CASE("the splat's sums are those of the CPU, quantum by quantum") {
    for (const std::uint32_t n : {1u, 2u, 777u}) {
        const Cloud cloud = make_cloud(n, n);
        const Sums got = splat(cloud, small_grid());
        const Sums expected = splat_cpu(cloud.position, cloud.velocity, cloud.cargos, small_grid(), {});
        CHECK(got.soot == expected.soot);
        CHECK(got.heat == expected.heat);
    }
}

TEST_CASE("nothing is lost: the grid holds what its particles carry, to the last quantum") {
    const Cloud cloud = make_cloud(1000, 5);
    const CellGrid cells = small_grid();
    unsigned long long soot = 0, heat = 0;
    double soot_kg = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Deposit d = deposit_of(cloud.cargos, i, cloud.position[i], 1, {});
        if (!inside(cells, d.centre_m)) continue;
        soot += d.soot;
        heat += d.heat;
        soot_kg += double(d.soot) * Quantum{}.soot_kg;
    }
    const Sums sums = splat(cloud, cells);
    CHECK(sum(sums.soot) == soot);
    CHECK(sum(sums.heat) == heat);
    CHECK(soot > 1000000);
    // The field, too: extinction times volume is soot times its extinction, to the rounding of a float each.
    Splatter splatter(cells, Gas{});
    const course::DeviceBuffer<float4> position(cloud.position), velocity(cloud.velocity);
    splatter.splat(position.data(), velocity.data(), 1000, cloud.cargos);
    double extinction_m2 = 0;
    for (const float2& v : splatter.download())
        extinction_m2 += double(v.x) * std::pow(1 / double(cells.cells_per_m), 3);
    CHECK(!(std::abs(extinction_m2 / (8700 * soot_kg) - 1) > 2e-7));
}

TEST_CASE("the order of the particles does not show, nor do threads") {
    Cloud cloud = make_cloud(600, 9);
    const Sums forward = splat(cloud, small_grid());
    std::mt19937 random(1);
    std::vector<int> order(300);
    for (int k = 0; k < 300; ++k) order[k] = k;
    std::shuffle(order.begin(), order.end(), random);
    Cloud mixed = cloud;
    for (int k = 0; k < 300; ++k) mixed.position[k] = cloud.position[order[k]];  // those of the first kind
    const Sums shuffled = splat(mixed, small_grid());
    CHECK(forward.soot == shuffled.soot);
    CHECK(forward.heat == shuffled.heat);
#ifdef __CUDASIM__
    for (const unsigned workers : {1u, 2u, 5u})
        for (const auto kind :
             {cudasim::Order::kForward, cudasim::Order::kReverse, cudasim::Order::kShuffled}) {
            const cudasim::WorkerScope threads(workers);
            const cudasim::OrderScope scope({kind, 3});
            const Sums again = splat(cloud, small_grid());
            CHECK(forward.soot == again.soot);
            CHECK(forward.heat == again.heat);
        }
#endif
}

TEST_CASE("particles that are not there: none, unborn, dead, no number, infinitely far, outside") {
    const CellGrid cells = small_grid();
    Cloud cloud = make_cloud(12, 2);
    cloud.cargos.count = 1;
    for (int k = 0; k < 12; ++k) cloud.position[k] = make_float4(0, 0, 0, 0.5f);
    const unsigned long long each = sum(splat(cloud, cells).soot) / 12;
    REQUIRE(each > 0);
    cloud.position[0].w = -1;    // not born
    cloud.position[1].w = 1;     // dead: its life is 1 s
    cloud.position[2].w = kNan;  // age is no number
    cloud.position[3].x = kNan;
    cloud.position[4].y = kInfinity;
    cloud.position[5].z = -kInfinity;
    cloud.position[6].x = 0.521f;  // the last of 17 cells ends at 0.52
    cloud.position[7].x = 1e30f;
    cloud.velocity[8].w = kNan;  // life is no number
    CHECK(sum(splat(cloud, cells).soot) == 3 * each);
    CHECK(sum(splat(Cloud{{}, {}, cloud.cargos}, cells).soot) == 0);
}

TEST_CASE("one cell, one particle in a corner, all particles at one point, particles of no size") {
    Cloud cloud = make_cloud(200, 4);
    for (float4& p : cloud.position) p = make_float4(0.49f, 0.49f, 0.49f, 0.5f);
    unsigned long long whole = 0;
    for (std::uint32_t i = 0; i < 200; ++i)
        whole += deposit_of(cloud.cargos, i, cloud.position[i], 1, {}).soot;
    const CellGrid one = grid_over(glm::vec3(-0.5f), glm::vec3(0.5f), 1);
    CHECK(one.cell_count() == 1);
    CHECK(sum(splat(cloud, one).soot) == whole);
    CHECK(sum(splat(cloud, small_grid()).soot) == whole);  // at the rim, nothing falls off
    for (Cargo& cargo : cloud.cargos.cargo) cargo.radius_m[0] = cargo.radius_m[1] = 0;
    CHECK(sum(splat(cloud, small_grid()).soot) == whole);
}

TEST_CASE("grids and particles that make no sense are refused") {
    CHECK_THROWS_AS(grid_over(glm::vec3(0), glm::vec3(1), 0), course::BadInput);
    CHECK_THROWS_AS(grid_over(glm::vec3(0), glm::vec3(1), kNan), course::BadInput);
    CHECK_THROWS_AS(grid_over(glm::vec3(0), glm::vec3(1, 0, 1), 0.1f), course::BadInput);
    CHECK_THROWS_AS(grid_over(glm::vec3(0), glm::vec3(1, kInfinity, 1), 0.1f), course::BadInput);
    CHECK_THROWS_AS(grid_over(glm::vec3(0), glm::vec3(1000), 1e-3f), course::BadInput);  // 10^18 cells
    Cloud cloud = make_cloud(10, 1);
    for (const float radius_m : {1.0f, -0.1f, kNan, kInfinity}) {
        cloud.cargos.cargo[1].radius_m[1] = radius_m;
        CHECK_THROWS_AS(splat(cloud, small_grid()), course::BadInput);
    }
    cloud = make_cloud(10, 1);
    for (const float soot_kg : {-1e-9f, kNan, kInfinity, 1.0f}) {
        cloud.cargos.cargo[0].soot_kg[0] = soot_kg;
        CHECK_THROWS_AS(splat(cloud, small_grid()), course::BadInput);
    }
    for (auto change : {+[](VolumeLook& l) { l.step_in_cells = 0; },
                        +[](VolumeLook& l) { l.block_edge = -1; }, +[](VolumeLook& l) { l.light_edge = 65; },
                        +[](VolumeLook& l) { l.albedo = kNan; }, +[](VolumeLook& l) { l.glows = 0; },
                        +[](VolumeLook& l) { l.samples = 0; }, +[](VolumeLook& l) { l.gas.flame_K = 100; }}) {
        VolumeLook look = small_look();
        change(look);
        CHECK_THROWS_AS(FireVolume{look}, course::BadInput);
    }
}

TEST_CASE("hot gas mixes with air: never hotter than the flame, little heat in proportion") {
    const Gas gas;
    CHECK(field_value(gas, 0, 0, 1).y == gas.air_K);
    CHECK(field_value(gas, 0, 1e9, 1).y == doctest::Approx(gas.flame_K));
    // 1 K m^3 in 1 m^3 warms by 1 K; a 3400th less, since a little of it meets gas that is hot already. fp32
    // near 301 resolves 3e-5.
    CHECK(!(std::abs(field_value(gas, 0, 1, 1).y - 301) > 4e-4f));
    CHECK(field_value(gas, 2e-3, 0, 2).x == doctest::Approx(8.7));  // 1 g/m^3 of soot, 8700 m^2/kg
}

// ----------------------------------------------------------------------------------- the march through grids

TEST_CASE("pictures of a grid agree with the CPU's") {
    const CloudVolume volume(300, small_look());
    const Lens lens = front_lens(37, 29, 2);
    const MarchSettings settings{0.031f, 0};
    // 30 steps in fp32; positions differ from those in double by up to 2e-7 m, times a field that changes by
    // up to 1000 per metre.
    course::check_close(picture_of(volume.fire.field<false>(), lens, settings),
                        march_cpu(FieldOnHost(volume.fire.field<false>()).field, lens, settings.step_m),
                        course::Tolerance(1e-4, 1e-4), "light", "pixel");
}

TEST_CASE("the blocks' maxima are those of the CPU") {
    const CloudVolume volume(5, small_look());
    const std::vector<float2> field = volume.fire.splatter().download();
    for (const int edge : {1, 4, 5, 64})
        for (const int apron : {1, 3}) {
            BlockMap map(volume.fire.splatter().cells(), edge, apron);
            map.build(volume.fire.splatter().field());
            course::check_equal(map.largest().download(),
                                blocks_cpu(field, volume.fire.splatter().cells(), edge, apron),
                                "largest extinction", "block");
        }
    CHECK_THROWS_AS(BlockMap(small_grid(), 0), course::BadInput);
    CHECK_THROWS_AS(BlockMap(small_grid(), 65), course::BadInput);
}

TEST_CASE("skipping empty space changes no bit of a picture, with or without detail") {
    for (const float reach_m : {0.0f, 0.09f})
        for (const int edge : {1, 3, 8}) {
            VolumeLook look = small_look();
            look.detail.reach_m = reach_m;
            look.block_edge = edge;
            const CloudVolume skipping(4, look);  // four particles: most of the grid is empty
            look.block_edge = 0;
            const CloudVolume plain(4, look);
            for (const float distance_m : {2.0f, 0.3f}) {  // from outside and from inside
                const Lens lens = front_lens(45, 33, distance_m);
                course::DeviceBuffer<float4> a(45 * 33), b(45 * 33);
                skipping.fire.draw(a.data(), lens);
                plain.fire.draw(b.data(), lens);
                CAPTURE(edge);
                CAPTURE(reach_m);
                CHECK(same_bits(a.download(), b.download()));
                double light = 0;
                for (const float4& s : a.download()) light += 1 - s.w;
                CHECK(light > 1);  // something is there
            }
        }
}

TEST_CASE("a ray that ends early leaves out no more than it lets through") {
    CloudVolume volume(400, small_look());
    const Lens lens = front_lens(40, 30, 2);
    course::DeviceBuffer<float4> seen(40 * 30);
    volume.fire.draw(seen.data(), lens);
    const std::vector<float4> all = seen.download();
    // Light left out is at most what is let through times the brightest source there is.
    const float brightest = glow_at(glow_table().data(), 2000).x;
    int ended = 0;
    for (const float enough : {0.5f, 0.1f, 0.01f}) {
        volume.fire.look().enough = enough;
        volume.fire.draw(seen.data(), lens);
        const std::vector<float4> early = seen.download();
        for (std::size_t i = 0; i < all.size(); ++i) {
            CHECK(!(all[i].x - early[i].x > enough * brightest));
            CHECK(!(early[i].x > all[i].x + 1e-6f));
            CHECK(!(early[i].w - all[i].w > enough));
            ended += early[i].w != all[i].w;
        }
    }
    CHECK(ended > 100);  // rays did end early
}

TEST_CASE("no particles: no light, all of what lies behind") {
    CloudVolume volume(0, small_look());
    course::DeviceBuffer<float4> seen(10 * 10);
    volume.fire.draw(seen.data(), front_lens(10, 10, 2));
    for (const float4& s : seen.download()) {
        CHECK(s.x == 0);
        CHECK(s.w == 1);
    }
    CHECK(volume.fire.glows().count == 0);
}

TEST_CASE("soot a million times as thick stays a picture") {
    VolumeLook look = small_look();
    look.gas.extinction_m2_per_kg = 8.7e9f;
    CloudVolume volume(200, look);
    course::DeviceBuffer<float4> seen(20 * 20);
    volume.fire.draw(seen.data(), front_lens(20, 20, 2));
    for (const float4& s : seen.download()) {
        CHECK((s.x >= 0 && s.x <= 1e6f));
        CHECK((s.w >= 0 && s.w <= 1));
    }
}

// ---------------------------------------------------------------------------------------- the fire's own
// light

TEST_CASE(
    "a uniform fire gives off 4 pi (1 - albedo) sigma B V, less what stays in it, and all of it is in its "
    "glows") {
    const Uniform uniform(glm::vec3(-0.5f), glm::vec3(0.5f), 0.1f, 2, 1800);
    const glm::ivec3 blocks = block_counts(uniform.cells, 4);
    course::DeviceBuffer<float4> power(std::size_t(blocks.x) * blocks.y * blocks.z);
    power_kernel<<<1, 64>>>(power.data(), uniform.field(0.25f), 4, blocks);
    CUDA_CHECK(cudaGetLastError());
    // On 0.2 m, half a block, exp(-0.4) is left in the end, (1 - exp(-0.4)) / 0.4 on average.
    const double expected =
        4 * 3.14159265358979 * 0.75 * 2 * glow_at(glow_table().data(), 1800).x * (1 - std::exp(-0.4)) / 0.4;
    for (const int count : {1, 2, 3}) {
        const Glows glows = make_glows(power.download(), uniform.cells, 4, blocks, count);
        CHECK(glows.count == count);
        double total = 0;
        for (int k = 0; k < glows.count; ++k) {
            total += glows.glow[k].power.x;
            // Blocks of 4 cells over 10: the centre of a block cut off by the grid's end is off by 0.1 m.
            CHECK(!(std::abs(glows.glow[k].position_m.x) > 0.1f));
        }
        CHECK(!(std::abs(total / expected - 1) > 1e-5));  // 1000 cells added in fp32
    }
    CHECK(make_glows(std::vector<float4>(power.size(), make_float4(0, 0, 0, 0)), uniform.cells, 4, blocks, 3)
              .count == 0);
}

TEST_CASE("light through smoke: exp(-sigma d) up to the glow, the inverse square beyond it") {
    const Uniform smoke(glm::vec3(-0.5f), glm::vec3(0.5f), 0.1f, 3, 300);
    const FieldOnHost smoke_on_host(smoke.field());
    Glows glows;
    glows.count = 1;
    glows.glow[0] = {{0, 0, 0}, 0.1f, {2, 1, 0}};
    for (const float x : {0.05f, 0.2f, 0.4f, 0.8f}) {
        const float way = std::max(0.0f, std::min(x, 0.5f) - 0.1f);  // through smoke, outside of the glow
        const float expected = 2 * std::exp(-3 * way) / (4 * 3.14159265f * (x * x + 0.01f));
        const glm::vec3 got = fluence_at(smoke_on_host.field, glows, {x, 0, 0}, 0.01f, true);
        CHECK(!(std::abs(got.x / expected - 1) > 1e-5f));
        CHECK(got.z == 0);
        const glm::vec3 open = fluence_at(smoke_on_host.field, glows, {x, 0, 0}, 0.01f, false);
        CHECK(!(std::abs(open.x * std::exp(-3 * way) / expected - 1) > 1e-5f));
    }
}

TEST_CASE("the light grid's kernel agrees with the CPU") {
    const CloudVolume volume(300, small_look());
    const CellGrid coarse{volume.fire.splatter().cells().origin_m,
                          volume.fire.splatter().cells().cells_per_m / 4,
                          block_counts(volume.fire.splatter().cells(), 4)};
    course::DeviceBuffer<float4> fluence(coarse.cell_count());
    const glm::vec3 ambient(0.1f, 0.2f, 0.3f);
    FireField<false> field = volume.fire.field<false>();
    REQUIRE(volume.fire.glows().count > 0);
    for (const bool shadows : {true, false}) {
        fluence_kernel<<<grid::blocks_for(coarse.cell_count(), 64), 64>>>(
            fluence.data(), coarse, field, volume.fire.glows(), ambient, 0.05f, shadows);
        CUDA_CHECK(cudaGetLastError());
        // The same operations; a GPU's exp differs in the last bits, 20 steps deep.
        course::check_close(
            fluence.download(),
            fluence_cpu(coarse, FieldOnHost(field).field, volume.fire.glows(), ambient, 0.05f, shadows),
            course::Tolerance(1e-6, 1e-5), "light", "cell");
    }
}

TEST_CASE("smoke shades smoke") {
    VolumeLook look = small_look();
    look.gas.extinction_m2_per_kg = 87000;
    const CloudVolume shaded(300, look);
    look.shadows = false;
    const CloudVolume open(300, look);
    look.light_edge = 0;
    const CloudVolume black(300, look);
    const auto brightness = [](const CloudVolume& volume) {
        course::DeviceBuffer<float4> seen(30 * 30);
        volume.fire.draw(seen.data(), front_lens(30, 30, 2));
        double sum = 0;
        for (const float4& s : seen.download()) sum += s.x;
        return sum;
    };
    CHECK(brightness(black) < brightness(shaded));
    CHECK(brightness(shaded) < brightness(open));
}

// --------------------------------------------------------------------------------- detail, film and the
// whole

TEST_CASE("detail moves the place of reading by no more than its reach, and by nothing at the ground") {
    const std::vector<float4> table = detail_table(1);
    const Detail detail{table.data(), 0.05f, 0.3f, 0.1f, 7.3f};
    std::mt19937 random(2);
    std::uniform_real_distribution<float> at(-3, 3);
    float largest = 0;
    for (int k = 0; k < 3000; ++k) {
        const glm::vec3 x(at(random), at(random), at(random)), shift = shifted(detail, x) - x;
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(!(std::abs(shift[axis]) > 0.05f + 1e-6f));
            largest = std::max(largest, std::abs(shift[axis]));
        }
        if (x.y <= 0) CHECK(glm::length(shift) == 0);
    }
    CHECK(largest > 0.025f);
}

TEST_CASE("film: black stays black, more light is never darker, and nothing gets beyond white") {
    CHECK(exposed(glm::vec3(0), 3) == glm::vec3(0));
    float before = 0;
    for (float light = 1e-3f; light < 1e3f; light *= 1.5f) {
        const float now = exposed(glm::vec3(light), 1).x;
        CHECK((now >= before && now <= 1));
        before = now;
    }
    // A light that is the same everywhere is the same after the glare: it is only spread.
    course::DeviceBuffer<float4> light(std::vector<float4>(37 * 23, make_float4(0.3f, 0.2f, 0.1f, 0)));
    const course::Image plain = Darkroom(37, 23, false).develop(light.data(), {2, 0});
    const course::Image glare = Darkroom(37, 23, true).develop(light.data(), {2, 0.5f});
    int off = 0;
    for (std::size_t i = 0; i < plain.rgb.size(); ++i) off += std::abs(plain.rgb[i] - glare.rgb[i]) > 1;
    CHECK(off == 0);
    // Film, then sRGB, with at most half a step of grain.
    const int expected = course::to_srgb(1 - std::exp(-0.6f));
    CHECK(std::abs(plain.pixel(5, 5)[0] - expected) <= 1);
}

TEST_CASE("a fire makes the same picture with any number of threads") {
    VolumeScene scene = make_scene("torch", 500, 3);
    scene.look.cell_m = 0.02f;
    const auto picture = [&] {
        Particles particles(scene);
        for (int k = 0; k < 40; ++k) particles.step();
        FireVolume fire(scene.look);
        fire.fill(particles.position(), particles.velocity(), particles.size());
        return Photographer(64, 36, scene.look).photograph(fire, camera_of(scene)).rgb;
    };
    const std::vector<std::uint8_t> first = picture();
    CHECK(first == picture());
#ifdef __CUDASIM__
    for (const unsigned workers : {1u, 3u}) {
        const cudasim::WorkerScope threads(workers);
        CHECK(first == picture());
    }
#endif
    int bright = 0;
    for (const std::uint8_t value : first) bright += value > 200;
    CHECK(bright > 8);  // there is a fire in it
}

TEST_CASE("the samples of a pixel: evenly around its middle, and edges get soft") {
    for (const int samples : {1, 2, 4, 16, 64}) {
        glm::vec2 sum(0);
        std::vector<int> column(samples), row(samples);
        for (int k = 0; k < samples; ++k) {
            const glm::vec2 shift = sample_shift(k, samples);
            sum += shift;
            ++column.at(std::size_t((shift.x + 0.5f) * float(samples)));
            ++row.at(std::size_t((shift.y + 0.5f) * float(samples)));
        }
        CHECK(glm::length(sum) < 1e-6f);  // multiples of 1/128: exact
        CHECK(column == std::vector<int>(samples, 1));
        CHECK(row == std::vector<int>(samples, 1));
    }
    // A torch's stick against the sky: colours between the two are there with 16 samples only.
    VolumeScene scene = make_scene("torch", 1, 1);
    scene.look.cell_m = 0.05f;
    const float4 nothing = make_float4(0, 0, 0, -1);
    const course::DeviceBuffer<float4> position(std::vector<float4>{nothing, nothing}), velocity(2);
    int between[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
        scene.look.samples = k == 0 ? 1 : 16;
        FireVolume fire(scene.look);
        fire.fill(position.data(), velocity.data(), 0);
        const course::Image image = Photographer(64, 36, scene.look).photograph(fire, camera_of(scene));
        const int sky = image.pixel(2, 34)[2];
        for (int x = 0; x < 64; ++x) {
            const int blue = image.pixel(x, 35)[2];
            between[k] += blue > sky / 4 && blue < sky - 6;
        }
    }
    CHECK(between[1] > between[0]);
}

TEST_CASE("sprites: the light in the picture is the light of the particles") {
    // One particle in front of the camera: the picture's light, times the area of a pixel there, is what the
    // particle gives off along the line of sight.
    Cargos cargos;
    cargos.count = 1;
    cargos.cargo[0] = {{0.1f, 0.1f}, {1e-6f, 1e-6f}, {2, 2}, 0, 0};
    const course::DeviceBuffer<float4> x(std::vector<float4>{make_float4(0, 0, 0, 0.5f)});
    const course::DeviceBuffer<float4> v(std::vector<float4>{make_float4(0, 0, 0, 1)});
    course::Camera camera;
    const Lens lens = make_lens(camera, 120, 90);
    course::DeviceBuffer<float4> seen(120 * 90);
    SpriteDrawer(120, 90).draw(seen.data(), x.data(), v.data(), 1, cargos, Gas{}, {1900, 1700}, lens, 1);
    double light = 0;
    for (const float4& s : seen.download()) light += s.x;
    const double pixel_m = 2 * 3 * std::tan(0.35) / 90;  // the camera is 3 m away and sees 0.7 rad
    const double expected = 1e-6 * 8700 * glow_at(glow_table().data(), 1800).x;
    CHECK(!(std::abs(light * pixel_m * pixel_m / expected - 1) > 0.01));  // a spot sampled at 140 pixels
}

// -------------------------------------------------------------------------------------------- the program

TEST_CASE("--explain tells what is launched and allocated, and what is left out") {
#ifdef __CUDASIM__
    for (int variant = 0; variant < 4; ++variant) {
        VolumeScene scene = make_scene("torch", 300, 1);
        scene.look.cell_m = 0.03f;
        if (variant == 1) scene.look.block_edge = 0, scene.look.detail.reach_m = 0;
        if (variant == 2) scene.look.light_edge = 0, scene.look.solid = false, scene.look.samples = 1;
        if (variant == 3) scene.look.film.glare = 0, scene.look.samples = 3;
        Particles particles(scene);
        particles.step();
        cudasim::Recording making;
        FireVolume fire(scene.look);
        const std::size_t bytes = making.bytes();
        CHECK(bytes == fire.bytes());
        Photographer photographer(40, 30, scene.look);
        const std::size_t pixel_bytes =
            making.bytes() - bytes - (scene.look.film.glare > 0 ? 2 * 16 * 10 * 8 : 0);
        CHECK(pixel_bytes == 1200 * (20u + (composites(scene.look) ? 16 : 0) + (scene.look.solid ? 20 : 0)));
        cudasim::Recording recording;
        fire.fill(particles.position(), particles.velocity(), particles.size());
        photographer.photograph(fire, camera_of(scene));
        CHECK(recording.allocations() == 0);  // a picture allocates nothing
        std::size_t total = 0;
        for (const auto& [kernel, count] : launches_per_picture(scene.look)) {
            CAPTURE(kernel);
            CHECK(recording.count(kernel) == std::size_t(count));
            total += count;
        }
        CHECK(recording.launches().size() == total);
        const std::string text = explain(scene);
        CHECK((text.find("empty-space skipping") != std::string::npos) == (variant == 1));
        CHECK((text.find("logs, ground and sky") != std::string::npos) == (variant == 2));
        CHECK((text.find("glare, with") != std::string::npos) == (variant == 3));
    }
    Particles particles(make_scene("torch", 300, 1));
    cudasim::Recording step;
    particles.step();
    CHECK(step.launches().size() == 1);
    CHECK(step.count("flame_step_kernel") == 1);
#else
    course::require_simulator();
#endif
}

TEST_CASE("no OpenGL at all: the program is not linked with it, and says so") {
    // The loader prints what a program needs instead of starting it.
    const course::ProgramRun libraries = course::run_program(kProgram, "", "LD_TRACE_LOADED_OBJECTS=1");
    REQUIRE(libraries.output.find("libc") != std::string::npos);
    for (const char* name : {"libGL", "libEGL", "libOpenGL", "libGLEW", "libglfw", "libX11"})
        CHECK(libraries.output.find(name) == std::string::npos);
    const course::ProgramRun run = course::run_program(kProgram, "--explain");
    CHECK(run.exit_code == 0);
    CHECK(run.output.find("left out: OpenGL") != std::string::npos);
}

TEST_CASE("a short run leaves a picture; bad input ends with a sentence and exit code 2") {
    const course::TemporaryFolder folder;
    const std::string out = " --out " + folder.path().string();
    const course::ProgramRun run = course::run_program(
        kProgram, "--scene torch --particles 200 --cell 0.03 --width 64 --height 36 --still-only" + out);
    CHECK(run.exit_code == 0);
    CHECK(std::filesystem::exists(folder.path() / "torch.png"));
    CHECK(std::filesystem::exists(folder.path() / "result.json"));
    const std::string small = " --still-only --width 64 --height 36 --cell 0.04";
    CHECK(course::run_program(kProgram, "--particles 1" + small + out).exit_code == 0);
    for (const std::string scene : {"torch", "vortex"}) {  // with vortons and without: one rule
        const course::ProgramRun long_step =
            course::run_program(kProgram, "--scene " + scene + " --particles 100 --dt 1000" + small + out);
        CHECK(long_step.exit_code == 2);
        CHECK(long_step.output.find("the time step must be at most half of that") != std::string::npos);
    }
    for (const char* bad : {"--particles 0", "--cell -1", "--cell nan", "--cell 0.001", "--cell 1e-7",
                            "--march-step -2", "--samples 65", "--march-step nan", "--scene bonfire",
                            "--window", "--dt -1", "--dt nan", "--width 0"}) {
        CAPTURE(bad);
        const course::ProgramRun wrong = course::run_program(kProgram, bad + out);
        CHECK(wrong.exit_code == 2);
        CHECK(wrong.output.find("error: ") != std::string::npos);
    }
}
