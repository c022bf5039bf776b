// Exercise 10.1: the whole pressure force, against its value between equals, Newton's third law and the exact
// speed of sound on a lattice.
#include "ex1_whole_force.cuh"

#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include "tests/exercises/10_water_sph/particles.cuh"
#include "tests/support/course_test.h"

namespace {

using glm::vec3;
using sph::Fluid;
using sph::Pressed;

Fluid fluid_of(float support_m, float mass_kg) {
    Fluid fluid;
    fluid.support_m = support_m;
    fluid.mass_kg = mass_kg;
    return fluid;
}

/// The exercise's accelerations of a body of water without walls.
std::vector<vec3> accelerations(const std::vector<float4>& position, const Fluid& fluid) {
    const SortedParticles particles(position, fluid, far_box(25 * fluid.support_m));
    course::DeviceBuffer<float4> acceleration(particles.n);
    sph::push_kernel<<<particles.blocks(), SortedParticles::kThreads>>>(
        acceleration.data(), particles.position(), particles.density().data(), particles.ranges(),
        particles.cells, fluid, particles.n);
    CUDA_CHECK(cudaGetLastError());
    std::vector<vec3> result;
    for (const float4& a : particles.from_cells(acceleration)) result.push_back(grid::xyz(a));
    return result;
}

}  // namespace

TEST_CASE("two particles of the same pressure and density") {
    course::set_hint(1);
    // The coefficient is 2 p / rho^2, and -dW/dr = slope / h^4 with the tabulated values of spiky
    // (tests/data/README.md, 4_sph kernel_values).
    struct Row {
        double q, slope;
    };
    const double mass = 0.5, support = 0.25;
    const vec3 direction = glm::normalize(vec3(2, -1, 3)), place(0.75f, -0.5f, 0.125f);
    std::vector<vec3> got, expected;
    for (const Row& row :
         {Row{0.25, 8.0572189940272}, Row{0.5, 3.58098621956765}, Row{0.75, 0.895246554891911}})
        for (const double pressure : {3000.0, 50.0, -200.0}) {
            const double rho = 800;
            const Pressed j{place, float(rho), float(pressure)};
            const Pressed i{place + float(row.q * support) * direction, float(rho), float(pressure)};
            got.push_back(sph::push_on(i, j, fluid_of(support, mass)));
            expected.push_back(vec3(glm::dvec3(direction) *
                                    (mass * 2 * pressure / (rho * rho) * row.slope / std::pow(support, 4))));
        }
    // fp32 positions near 1 m: 1e-7 of 0.06 m is 2e-6 of the distance, and the slope takes it up to four
    // times.
    course::check_close(got, expected, {0, 2e-5}, "push on i (m/s^2)", "pair");
}

TEST_CASE("no push without a direction, and none beyond the support") {
    course::set_hint(2);
    const Fluid fluid = fluid_of(0.25f, 0.5f);
    const Pressed i{{0.5f, 0.25f, -1}, 900, 400};
    std::vector<vec3> got;
    for (const vec3 apart : {vec3(0), vec3(0.25f, 0, 0), vec3(0, -0.75f, 0)})
        got.push_back(sph::push_on(i, {i.position_m + apart, 1100, 700}, fluid));
    course::check_equal(got, std::vector<vec3>(got.size(), vec3(0)),
                        "push on i (0, 0.25 and 0.75 m apart, support 0.25 m)", "pair");
}

TEST_CASE("what one gets the other loses") {
    course::set_seed(3);
    course::set_hint(2);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    const Fluid fluid = fluid_of(0.1f, 0.25f);
    std::vector<vec3> on_i, minus_on_j;
    for (int pair = 0; pair < 200; ++pair) {
        const auto particle = [&] {
            return Pressed{0.05f * vec3(unit(random), unit(random), unit(random)), 500 + 1000 * unit(random),
                           5000 * unit(random)};
        };
        const Pressed i = particle(), j = particle();
        on_i.push_back(sph::push_on(i, j, fluid));
        minus_on_j.push_back(-sph::push_on(j, i, fluid));
    }
    // Both are products and sums of the same positive numbers, in another order: a few roundings of fp32.
    course::check_close(on_i, minus_on_j, {0, 2e-6}, "push on i (expected: minus the push on j)", "pair");
}

TEST_CASE("a body of water does not push itself away") {
    course::set_seed(4);
    course::set_hint(2);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float4> position;  // denser on one side, so that densities and pressures differ a lot
    for (int i = 0; i < 1000; ++i) {
        const float x = unit(random);
        position.push_back(make_float4(x * x, unit(random), unit(random), 0));
    }
    position[7] = position[6];  // two at the same place
    glm::dvec3 sum(0);
    double sizes = 0;
    for (const vec3& a : accelerations(position, fluid_of(0.2f, 1.0f))) {
        sum += glm::dvec3(a);
        sizes += glm::length(a);
    }
    // 1000 fp32 sums of about 30 terms, each rounded at random: far less than 1e-6 of all accelerations
    // together.
    course::check_close(
        std::vector<glm::dvec3>{sum}, {glm::dvec3(0)}, 1e-6 * sizes,
        "sum of all accelerations (m/s^2; their sizes add up to " + std::to_string(sizes) + ")", "body");
}

TEST_CASE("sound is as fast as the lattice says") {
    course::set_hint(1);
    // A small standing wave u = A sin(k x) on an infinite lattice accelerates each particle by -omega^2 u.
    // The exact omega / (c k) for poly6 and spiky with support 2 spacings and zero pressure at rest
    // (tests/data/README.md, 4_sph acoustic_dispersion_discrete_exact). Equation 10 as printed has 0.661 and
    // 0.695.
    struct Row {
        int wavelength;
        double speed;
    };
    for (const Row& row : {Row{10, 0.9348753778709014}, Row{20, 0.9829861442017288}}) {
        // One wavelength to look at, and five spacings around it: nobody in it, and none of their neighbours,
        // misses any of theirs.
        const int margin = 5, nx = row.wavelength + 2 * margin, ny = 2 * margin + 1;
        std::vector<float4> position = unit_lattice(nx, ny, ny);
        const double k = 2 * sph::kPi / row.wavelength, amplitude_m = 3e-3;
        std::vector<double> wave(position.size());
        for (std::size_t i = 0; i < position.size(); ++i) {
            wave[i] = std::sin(k * position[i].x);
            position[i].x = float(position[i].x + amplitude_m * wave[i]);
        }
        Fluid fluid = fluid_of(2, float(1000 / sph::lattice_density(2)));
        fluid.sound_speed_m_per_s = 10;
        fluid.lowest_pressure_Pa = -1e30f;
        const std::vector<vec3> a = accelerations(position, fluid);

        std::vector<float> got, expected;  // along x, of the row of particles through the middle
        double projection = 0, norm = 0;
        for (int x = margin; x < margin + row.wavelength; ++x) {
            const std::size_t i = x + nx * (margin + std::size_t(ny) * margin);
            got.push_back(a[i].x);
            expected.push_back(float(-std::pow(10 * k * row.speed, 2) * amplitude_m * wave[i]));
            projection += a[i].x * wave[i];
            norm += wave[i] * wave[i];
        }
        const double squared = -projection / (norm * amplitude_m) / (k * k);  // of the speed of sound
        std::ostringstream what;
        what << "Wave of " << row.wavelength << " spacings: sound at " << 10 * row.speed
             << " m/s is right, yours "
             << (squared > 0 ? "runs at " + std::to_string(std::sqrt(squared)) + " m/s" : "does not exist")
             << ".\nAcceleration along x (m/s^2)";
        // The wave is not infinitely small: terms of the order A k, 2e-3, of the largest acceleration.
        // Positions are fp32, 1e-6 m at 10 m against an amplitude of 3e-3 m: some 1e-3 more, and as much for
        // the density.
        const double largest = std::pow(10 * k * row.speed, 2) * amplitude_m;
        if (!course::check_close(got, expected, 0.005 * largest, what.str(), "particle of the row")) return;
        // In the projection the rounding averages out: as in the chapter's own test.
        CHECK(std::abs(std::sqrt(squared) / (10 * row.speed) - 1) < 2e-3);
    }
}
