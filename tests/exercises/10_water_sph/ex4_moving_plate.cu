// Exercise 10.4: a moving plate, against velocities by hand, all pairs in double, and Couette's flow.
#include "ex4_moving_plate.cuh"

#include <cmath>
#include <string>

#include "tests/exercises/10_water_sph/particles.cuh"
#include "tests/support/course_test.h"

namespace {

using sph::Box;
using sph::Fluid;
using sph::Wall;

/// Accelerations in the order of `position`; densities are those of the lesson.
std::vector<float4> friction(const std::vector<float4>& position, const std::vector<float4>& velocity,
                             const Fluid& fluid, const Box& box, float3 upper,
                             std::vector<float>* density = nullptr) {
    const SortedParticles particles(position, fluid, box);
    const auto sorted_velocity = particles.to_cells(velocity);
    course::DeviceBuffer<float4> acceleration(particles.n);
    sph::plate_friction_kernel<<<particles.blocks(), SortedParticles::kThreads>>>(
        acceleration.data(), particles.position(), sorted_velocity.data(), particles.density().data(),
        particles.ranges(), particles.cells, fluid, box, upper, particles.n);
    CUDA_CHECK(cudaGetLastError());
    if (density) *density = particles.from_cells(particles.density());
    return particles.from_cells(acceleration);
}

/// A lattice between plates a gap of 1 mm apart, 4 spacings wide and 2 thick; the fluid is that of the
/// lesson's Poiseuille flow.
struct Gap {
    std::vector<float4> position, velocity;
    Fluid fluid;
    Box box;

    explicit Gap(int spacings) {
        const float spacing_m = 1e-3f / spacings;
        for (int i = 0; i < 4 * spacings * 2; ++i)
            position.push_back(make_float4((i % 4 + 0.5f) * spacing_m, (i / 4 % spacings + 0.5f) * spacing_m,
                                           (i / 4 / spacings + 0.5f) * spacing_m, 0));
        velocity.assign(position.size(), make_float4(0, 0, 0, 0));
        fluid.support_m = 2 * spacing_m;
        fluid.mass_kg = float(1000 * std::pow(double(spacing_m), 3) / sph::lattice_density(2));
        fluid.viscosity_m2_per_s = 1e-6f;
        box = {{0, 0, 0},
               {4 * spacing_m, 1e-3f, 2 * spacing_m},
               {Wall::periodic, Wall::no_slip, Wall::periodic}};
    }
};

}  // namespace

TEST_CASE("the mean of a particle's and its image's velocity is the plate's") {
    course::set_hint(1);
    std::vector<glm::vec3> mean, expected;
    for (const glm::vec3 plate : {glm::vec3(0, 0, 0), glm::vec3(2, 0, 0), glm::vec3(-1, 0, 3)})
        for (const glm::vec3 v : {glm::vec3(0, 0, 0), glm::vec3(2, 0, 0), glm::vec3(0.5f, -4, 1)}) {
            mean.push_back(0.5f * (v + sph::seen_in_plate(v, plate)));
            expected.push_back(plate);
        }
    course::check_close(mean, expected, {1e-6}, "mean velocity (m/s)", "case");  // numbers of a few ones
}

TEST_CASE("water in the middle of the gap: friction between neighbours") {
    course::set_hint(2);
    Gap gap(10);
    gap.fluid.mass_kg *= 1.5f;  // denser than at rest: it matters which density stands where
    for (std::size_t i = 0; i < gap.position.size(); ++i) gap.velocity[i].x = 1e-5f * (i / 4 % 10 == 5);
    std::vector<float> density;
    const auto a = friction(gap.position, gap.velocity, gap.fluid, gap.box, {0, 0, 0}, &density);
    // One row of the lattice moves. The row above it has these of its particles near: one straight below at
    // q = 1/2, four at sqrt(2)/2, four at sqrt(3)/2. lap W = 45 (1 - q) / (pi h^5).
    const double h = gap.fluid.support_m;
    const double near = 0.5 + 4 * (1 - std::sqrt(0.5)) + 4 * (1 - std::sqrt(0.75));
    const double pull = 1e-6 * 1000 * gap.fluid.mass_kg / (density[0] * double(density[0])) * 45 /
                        (sph::kPi * std::pow(h, 5)) * near * 1e-5;
    std::vector<double> got, expected;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const int row = int(i / 4 % 10);
        if (row < 3 || row == 5 || row > 7) continue;  // 2 spacings from the moving row friction ends
        got.push_back(a[i].x);
        expected.push_back(row == 4 || row == 6 ? pull : 0);
    }
    course::check_close(got, expected, {1e-5 * pull}, "acceleration (m/s^2) beside a moving row", "particle");
}

TEST_CASE("plates: still water feels the one that moves, and water that moves is held by the one at rest") {
    course::set_hint(3);
    Gap gap(10);
    const float u = 1e-5f;
    const auto pulled = friction(gap.position, gap.velocity, gap.fluid, gap.box, {u, 0, 2 * u});
    for (float4& v : gap.velocity) v = make_float4(u, 0, 2 * u, 0);
    const auto held = friction(gap.position, gap.velocity, gap.fluid, gap.box, {u, 0, 2 * u});
    const double largest = std::abs(pulled.back().x);
    CHECK(pulled.back().x > 0);
    std::vector<float4> mirrored(pulled.size());
    for (std::size_t i = 0; i < pulled.size(); ++i) {
        // Seen from the moving plate, all of it happens at the other plate, the other way round.
        const std::size_t row = i / 4 % 10, other = i + 4 * (9 - 2 * row);
        mirrored[i] = make_float4(-pulled[other].x, -pulled[other].y, -pulled[other].z, 0);
        const float4 a = pulled[i];
        if (row < 8) CHECK((a.x == 0 && a.y == 0 && a.z == 0));
        CHECK(std::abs(a.z - 2 * a.x) <= 1e-5 * largest);
    }
    course::check_close(held, mirrored, {1e-5 * largest}, "acceleration (m/s^2)", "particle");
}

TEST_CASE("Couette's flow") {
    course::set_hint(3);
    // tests/data/README.md, 4_sph couette_morris1997: velocities at y/L = 0.25, 0.5, 0.75 after 0.0225, 0.045
    // and 0.1125 s; the plate moves at 1.25e-5 m/s.
    struct Row {
        double time_s, v[3];
    };
    Gap gap(8);  // its rows lie at 1/16, 3/16, 5/16, ...: the table's heights are halfway between two
    const float plate = 1.25e-5f, dt_s = 0.0225f / 8;
    std::vector<double> got, expected;
    int step = 0;
    for (const Row& row :
         {Row{0.0225, {5.086852684813396e-09, 2.3027656815701938e-07, 2.9824103664554413e-06}},
          Row{0.045, {1.5485527572234598e-07, 1.1947516405310718e-06, 5.05820945617828e-06}},
          Row{0.1125, {1.3179788769102652e-06, 3.6284409870731896e-06, 7.4742337918445315e-06}}}) {
        for (; step * dt_s < row.time_s - 0.5 * dt_s; ++step) {
            const auto a = friction(gap.position, gap.velocity, gap.fluid, gap.box, {plate, 0, 0});
            for (std::size_t i = 0; i < a.size(); ++i) gap.velocity[i].x += dt_s * a[i].x;
        }
        for (int k = 0; k < 3; ++k) {
            const int below = 2 * k + 1;  // row under the table's height
            got.push_back((double(gap.velocity[4 * below].x) + gap.velocity[4 * below + 4].x) / 2 / plate);
            expected.push_back(row.v[k] / plate);
        }
    }
    // 3 %: eight spacings resolve the steep start by so much, explicit Euler adds less.
    course::check_close(got, expected, {0.03}, "velocity / the plate's", "point");
}
