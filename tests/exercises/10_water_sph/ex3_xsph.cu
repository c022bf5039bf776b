// Exercise 10.3: XSPH, against two particles by hand, the exact damping of waves on a lattice, momentum, and
// all pairs in double.
#include "ex3_xsph.cuh"

#include <cmath>
#include <random>
#include <string>

#include "10_water_sph/sph_cpu.h"
#include "tests/exercises/10_water_sph/particles.cuh"
#include "tests/support/course_test.h"

namespace {

using glm::dvec3;
using sph::Box;
using sph::Fluid;

Fluid fluid_of(float support_m, float mass_kg) {
    Fluid fluid;
    fluid.support_m = support_m;
    fluid.mass_kg = mass_kg;
    return fluid;
}

/// The exercise's velocities, in the order of `position`; with the given densities, or the lesson's.
std::vector<float4> smooth(const std::vector<float4>& position, const std::vector<float4>& velocity,
                           const Fluid& fluid, const Box& box, float strength,
                           const std::vector<float>& density = {}) {
    const SortedParticles particles(position, fluid, box);
    const auto sorted_velocity = particles.to_cells(velocity);
    const auto given_density = density.empty() ? course::DeviceBuffer<float>() : particles.to_cells(density);
    course::DeviceBuffer<float4> smoothed(particles.n);
    sph::smooth_velocity_kernel<<<particles.blocks(), SortedParticles::kThreads>>>(
        smoothed.data(), particles.position(), sorted_velocity.data(),
        density.empty() ? particles.density().data() : given_density.data(), particles.ranges(),
        particles.cells, fluid, box, strength, particles.n);
    CUDA_CHECK(cudaGetLastError());
    return particles.from_cells(smoothed);
}

/// All pairs, with all mirror images, in double.
std::vector<float4> smooth_cpu(const std::vector<float4>& position, const std::vector<float4>& velocity,
                               const std::vector<float>& density, const Fluid& fluid, const Box& box,
                               float strength) {
    const auto others = sph::with_images(position, velocity, box);
    const double h = fluid.support_m;
    std::vector<float4> result;
    for (std::size_t i = 0; i < position.size(); ++i) {
        const dvec3 x(grid::xyz(position[i])), v(grid::xyz(velocity[i]));
        dvec3 sum(0);
        for (const auto& other : others) {
            const dvec3 d = (x - other.position_m) / h;
            const double w = sph::poly6(d.x * d.x + d.y * d.y + d.z * d.z) / (h * h * h);
            sum += w / ((double(density[i]) + density[other.particle]) / 2) * (other.velocity_m_per_s - v);
        }
        const dvec3 u = v + double(strength) * fluid.mass_kg * sum;
        result.push_back(make_float4(float(u.x), float(u.y), float(u.z), 0));
    }
    return result;
}

/// n particles at random places of a box, denser on one side of it, with random velocities of up to 1 m/s.
void random_water(std::vector<float4>& position, std::vector<float4>& velocity, int n, glm::vec3 low,
                  glm::vec3 high, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < n; ++i) {
        const float along = unit(random);
        const glm::vec3 x = low + (high - low) * glm::vec3(along * along, unit(random), unit(random));
        position.push_back(make_float4(x.x, x.y, x.z, 0));
        velocity.push_back(make_float4(2 * unit(random) - 1, unit(random), -unit(random), 0));
    }
}

}  // namespace

TEST_CASE("two particles, by hand") {
    // Half a support apart, in one cell: W = 0.660943745603794 / h^3 (tests/data/README.md, 4_sph
    // kernel_values, poly6).
    const std::vector<float4> position{make_float4(-0.25f, -0.375f, -0.25f, 0),
                                       make_float4(-0.25f, -0.125f, -0.25f, 0)};
    const std::vector<float4> velocity{make_float4(3, 0, -1, 0), make_float4(-1, 2, 0, 0)};
    const float mass = 50, strength = 0.5f, h = 0.5f;
    const double share = strength * mass / 1000 * 0.660943745603794 / (h * h * h);
    std::vector<float4> expected;
    for (int i = 0; i < 2; ++i) {
        const float4 mine = velocity[i], other = velocity[1 - i];
        expected.push_back(make_float4(float(mine.x + share * (other.x - mine.x)),
                                       float(mine.y + share * (other.y - mine.y)),
                                       float(mine.z + share * (other.z - mine.z)), 0));
    }
    const auto check = [&](const std::vector<float>& density) {
        // Two numbers of a few m/s, a handful of fp32 roundings.
        return course::check_close(
            smooth(position, velocity, fluid_of(h, mass), far_box(4), strength, density), expected, 1e-6,
            "velocity (m/s)");
    };
    course::set_hint(1);
    if (!check({1000, 1000})) return;
    course::set_hint(2);
    INFO(std::string("densities 800 and 1200 kg/m^3: the mean is 1000 for both"));
    check({800, 1200});
}

TEST_CASE("one particle and its mirror image, by hand") {
    course::set_hint(3);
    // A quarter of a support from the wall, so half a support from its image: W as above. The image moves
    // alike along the wall and the other way across it.
    const float mass = 50, strength = 0.5f, h = 0.5f;
    const Box box{{-1, -4, -4}, {4, 4, 4}};
    const double share = strength * mass / 1000 * 0.660943745603794 / (h * h * h);
    course::check_close(smooth({make_float4(-0.875f, 0.2f, 0.2f, 0)}, {make_float4(-3, 2, 1, 0)},
                               fluid_of(h, mass), box, strength, {1000}),
                        {make_float4(float(-3 + share * 6), 2, 1, 0)}, 1e-6,  // as above
                        "velocity (m/s) 0.125 m from the wall x = -1 m");
}

TEST_CASE("where all move alike, nobody changes") {
    course::set_seed(5);
    course::set_hint(1);
    std::vector<float4> position, velocity;
    random_water(position, velocity, 1000, glm::vec3(-0.5f), glm::vec3(0.5f), 5);
    velocity.assign(position.size(), make_float4(0.3f, -1.7f, 0.1f, 0));
    // Differences of equal velocities are zeros. Rounding is allowed for all the same, to those who sum up
    // first.
    course::check_close(smooth(position, velocity, fluid_of(0.2f, 1), far_box(4), 0.5f), velocity, {0, 1e-5},
                        "velocity (m/s) in a uniform flow");
}

TEST_CASE("a neighbour in any of the 26 cells around counts") {
    course::set_hint(2);
    // One particle in the middle of a cell, a moving one in each direction by turns; corners are 0.95 h away.
    const float h = 0.25f;
    const Box box{{-0.5f, -0.5f, -0.5f}, {1, 1, 1}};
    const Fluid fluid = fluid_of(h, 10);
    const grid::CellGrid cells = SortedParticles({make_float4(0, 0, 0, 0)}, fluid, box).cells;
    const float edge = 1 / cells.cells_per_m;
    const glm::vec3 middle = cells.origin_m + 2.5f * edge;
    std::vector<float> got, expected;
    std::vector<std::string> direction;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                if (x == 0 && y == 0 && z == 0) continue;
                const glm::vec3 other = middle + 0.55f * edge * glm::vec3(x, y, z);
                const auto v = smooth(
                    {make_float4(middle.x, middle.y, middle.z, 0), make_float4(other.x, other.y, other.z, 0)},
                    {make_float4(0, 0, 0, 0), make_float4(1000, 0, 0, 0)}, fluid, box, 1, {1000, 1000});
                const dvec3 q = (dvec3(other) - dvec3(middle)) / double(h);
                got.push_back(v[0].x);
                expected.push_back(
                    float(10 * sph::poly6(q.x * q.x + q.y * q.y + q.z * q.z) / (double(h) * h * h)));
                direction.push_back("(" + std::to_string(x) + ", " + std::to_string(y) + ", " +
                                    std::to_string(z) + ")");
            }
    for (std::size_t k = 0; k < got.size(); ++k) {
        // The weight at a corner is (1 - 0.91)^3 of fp32 numbers: each of its roundings, 1e-7, grows by 3 /
        // 0.09.
        const std::string what = "vx (m/s) beside a particle of 1000 m/s in the cell at " + direction[k];
        if (!course::check_close(std::vector<float>{got[k]}, {expected[k]}, {0, 3e-5}, what)) return;
    }
}

TEST_CASE("what one gains the other loses: momentum stays") {
    course::set_seed(6);
    course::set_hint(2);
    std::vector<float4> position, velocity;
    random_water(position, velocity, 1000, glm::vec3(-0.5f), glm::vec3(0.5f), 6);
    const auto smoothed = smooth(position, velocity, fluid_of(0.2f, 1), far_box(4), 0.5f);
    dvec3 sum(0);
    double changes = 0;
    for (std::size_t i = 0; i < position.size(); ++i) {
        const dvec3 change = dvec3(grid::xyz(smoothed[i])) - dvec3(grid::xyz(velocity[i]));
        sum += change;
        changes += sph::distance(change);
    }
    REQUIRE(changes > 100);  // the velocities themselves have changed a lot
    // 1000 velocities rounded by up to 6e-8 m/s each, at random: some 2e-6 m/s in all.
    course::check_close(
        std::vector<dvec3>{sum}, {dvec3(0)}, 2e-5,
        "sum of all changes of velocity (m/s; their sizes add up to " + std::to_string(changes) + ")",
        "body");
}

TEST_CASE("the noise goes, the flow stays: waves on a lattice") {
    course::set_hint(2);
    // A velocity that varies as cos(k x) keeps that form: each particle's is multiplied by the same factor,
    // 1 - strength sum_j (m / rho) W_j (1 - cos(k x_j)), and the sum over a lattice is known exactly.
    const float strength = 0.5f;
    const Fluid fluid = fluid_of(2, float(1000 / sph::lattice_density(2)));
    const int nx = 24, ny = 9, margin = 4;
    const std::vector<float4> position = unit_lattice(nx, ny, ny);
    for (const int wavelength :
         {2, 20}) {  // 2 spacings: each particle against its neighbours, which is noise
        const double k = 2 * sph::kPi / wavelength;
        double damping = 0;
        for (int x = -2; x <= 2; ++x)
            for (int y = -2; y <= 2; ++y)
                for (int z = -2; z <= 2; ++z)
                    damping += fluid.mass_kg / 1000 * sph::poly6((x * x + y * y + z * z) / 4.0) / 8 *
                               (1 - std::cos(k * x));
        std::vector<float4> velocity;
        for (std::size_t i = 0; i < position.size(); ++i)
            velocity.push_back(make_float4(0, float(std::cos(k * double(i % nx))), 0, 0));
        const auto smoothed = smooth(position, velocity, fluid, far_box(20), strength,
                                     std::vector<float>(position.size(), 1000));
        std::vector<float> got,
            expected;  // along the row through the middle, none of whose neighbours is missing
        for (int x = margin; x < nx - margin; ++x) {
            const std::size_t i = x + nx * (margin + std::size_t(ny) * margin);
            got.push_back(smoothed[i].y);
            expected.push_back(float((1 - strength * damping) * velocity[i].y));
        }
        const std::string what = "a wave of " + std::to_string(wavelength) + " spacings keeps " +
                                 std::to_string(100 * (1 - strength * damping)) +
                                 " % of its velocity; vy (m/s)";
        // 26 fp32 terms of at most 0.1 m/s.
        if (!course::check_close(got, expected, 1e-6, what, "particle of the row")) return;
    }
}

TEST_CASE("all pairs, between walls") {
    course::set_seed(7);
    course::set_hint(3);
    std::vector<float4> position, velocity;
    const Box box{{-0.1f, 0, 0.2f}, {0.3f, 0.3f, 0.5f}};
    random_water(position, velocity, 700, {-0.1f, 0, 0.2f}, {0.3f, 0.3f, 0.5f},
                 7);            // not a multiple of the block
    position[7] = position[6];  // two at the same place
    const Fluid fluid = fluid_of(0.07f, 1000 * 0.4f * 0.3f * 0.3f / 700);
    std::vector<float> density;
    for (const double rho : sph::density_cpu(position, fluid, box)) density.push_back(float(rho));
    // About 30 terms of both signs of up to 1 m/s, summed in fp32.
    course::check_close(smooth(position, velocity, fluid, box, 0.7f, density),
                        smooth_cpu(position, velocity, density, fluid, box, 0.7f), 3e-6, "velocity (m/s)");
}

TEST_CASE("a particle at NaN keeps its velocity and disturbs nobody") {
    course::set_hint(2);
    const std::vector<float4> position{make_float4(0, 0, 0, 0), make_float4(NAN, 0, 0, 0)};
    const std::vector<float4> velocity{make_float4(1, 2, 3, 0), make_float4(4, 5, 6, 0)};
    course::check_close(smooth(position, velocity, fluid_of(0.5f, 50), far_box(4), 0.5f, {1000, 1000}),
                        velocity, {0, 1e-6}, "velocity (m/s)");
}
