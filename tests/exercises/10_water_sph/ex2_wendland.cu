// Exercise 10.2: Wendland's C2 kernel, against its table, its integrals, the density of a lattice and the
// speed of sound in it.
#include "ex2_wendland.cuh"

#include <cmath>
#include <string>

#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

/// The table (tests/data/README.md, 4_sph kernel_values, wendland_C2) counts in the smoothing length l, with
/// the support at 2 l. With l = 1 m that is W in 1/m^3 and dW/dr in 1/m^4 for a support of 2 m.
struct Row {
    double r_m, value, derivative;
};
constexpr double kTableSupport_m = 2;
const std::vector<Row> kTable = {{0.0, 0.417781725616225, 0.0},
                                 {0.25, 0.367343966017294, -0.349851396206946},
                                 {0.5, 0.264377498241518, -0.440629163735863},
                                 {0.75, 0.159371080633631, -0.382490593520714},
                                 {0.9, 0.107042989283075, -0.312787955697298},
                                 {1.0, 0.0783340735530422, -0.261113578510141},
                                 {1.5, 0.00652783946275352, -0.0489587959706514},
                                 {1.9, 1.25334517684868e-5, -0.000496115799169267}};
const std::string kTableRows = "rows: r = 0, 0.25, 0.5, 0.75, 0.9, 1, 1.5, 1.9 m; support 2 m";

/// One thread per distance.
__global__ void evaluate_kernel(float* value, float* slope, const float* r_m, float support_m,
                                std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    value[i] = sph::wendland(r_m[i], support_m);
    slope[i] = sph::wendland_slope(r_m[i], support_m);
}

/// Integral of f from 0 to `end`, by Simpson's rule with 1000 intervals.
template <class Function>
double integral(double end, Function f) {
    const double step = end / 1000;
    double sum = f(0.0) + f(end);
    for (int k = 1; k < 1000; ++k) sum += (k % 2 ? 4 : 2) * f(k * step);
    return sum * step / 3;
}

/// Sum of f(x, r) over all points of a cubic lattice of spacing 1 m within the support.
template <class Function>
double lattice_sum(double support_m, Function f) {
    const int reach = int(support_m);
    double sum = 0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z) {
                const double r_m = std::sqrt(double(x * x + y * y + z * z));
                if (r_m < support_m) sum += f(x, r_m);
            }
    return sum;
}

}  // namespace

TEST_CASE("values of the published table") {
    course::set_hint(1);
    INFO(kTableRows);
    std::vector<double> got, expected;
    for (const Row& row : kTable) {
        got.push_back(sph::wendland(row.r_m, kTableSupport_m));
        expected.push_back(row.value);
    }
    // The table has 15 digits; (1 - q)^4 multiplies a rounding of 1e-16 by up to 80 at r = 1.9 m.
    course::check_close(got, expected, {0, 1e-13}, "W (1/m^3)", "table row");
}

TEST_CASE("slopes of the published table") {
    course::set_hint(2);
    INFO(kTableRows);
    std::vector<double> got, expected;
    for (const Row& row : kTable) {
        got.push_back(sph::wendland_slope(row.r_m, kTableSupport_m));
        expected.push_back(-row.derivative);
    }
    course::check_close(got, expected, {0, 1e-13}, "-dW/dr (1/m^4)", "table row");  // as above
}

TEST_CASE("nothing at the support and beyond it") {
    course::set_hint(1);
    INFO(std::string("rows: r = 0.5, 0.6, 1, 5 m; support 0.5 m"));
    std::vector<double> values, slopes;
    for (const double r_m : {0.5, 0.6, 1.0, 5.0}) {
        values.push_back(sph::wendland(r_m, 0.5));
        slopes.push_back(sph::wendland_slope(r_m, 0.5));
    }
    if (course::check_equal(values, std::vector<double>(4, 0.0), "W (1/m^3)", "row"))
        course::check_equal(slopes, std::vector<double>(4, 0.0), "-dW/dr (1/m^4)", "row");
}

TEST_CASE("at every support the integral is 1, and so is that of the slope") {
    course::set_hint(3);
    INFO(std::string("supports: 0.02, 0.5, 1, 3 m"));
    std::vector<double> integrals, moments;
    for (const double support_m : {0.02, 0.5, 1.0, 3.0}) {
        integrals.push_back(integral(
            support_m, [&](double r) { return 4 * sph::kPi * r * r * sph::wendland(r, support_m); }));
        // Integrated by parts, the integral of W is that of -dW/dr r / 3: the factor that makes a sum of
        // slopes a gradient.
        moments.push_back(integral(support_m, [&](double r) {
            return 4 * sph::kPi / 3 * r * r * r * sph::wendland_slope(r, support_m);
        }));
    }
    // Simpson's error for these polynomials, (1/1000)^4 times some 100, is below 1e-10.
    if (course::check_close(integrals, std::vector<double>(4, 1.0), 1e-9, "integral of W over all space",
                            "support"))
        course::check_close(moments, std::vector<double>(4, 1.0), 1e-9,
                            "integral of -dW/dr r/3 over all space", "support");
}

TEST_CASE("a lattice has its known density and speed of sound") {
    course::set_hint(3);
    // tests/data/README.md, 4_sph lattice_density_error (cubic) and acoustic_dispersion_discrete_exact: rho /
    // rho0 and omega / (c k) of a wave of 20 spacings, for the support in spacings.
    struct Lattice {
        double support_m, density, speed;
    };
    INFO(std::string("supports: 2.4, 2.6, 3, 4 spacings"));
    std::vector<double> density, density_expected, speed, speed_expected;
    for (const Lattice& row : {Lattice{2.4, 1.0174569256334764, 0.9505991623898432},
                               Lattice{2.6, 1.0095007837847996, 0.9486520044362664},
                               Lattice{3.0, 1.0031410828249117, 0.9675822980915533},
                               Lattice{4.0, 1.0005486164045418, 0.9473252417966745}}) {
        density.push_back(
            lattice_sum(row.support_m, [&](int, double r) { return sph::wendland(r, row.support_m); }));
        density_expected.push_back(row.density);
        // With the same kernel for density and force, omega^2 = (c m / rho)^2 S^2, S = sum -dW/dr x/r sin(k
        // x).
        const double k = 2 * sph::kPi / 20;
        const double sum = lattice_sum(row.support_m, [&](int x, double r) {
            return r > 0 ? sph::wendland_slope(r, row.support_m) * x / r * std::sin(k * x) : 0;
        });
        speed.push_back(sum / density.back() / k);
        speed_expected.push_back(row.speed);
    }
    // Sums of up to 250 terms in double.
    if (course::check_close(density, density_expected, {0, 1e-12}, "density of the lattice / rho0",
                            "support"))
        course::check_close(speed, speed_expected, {0, 1e-12}, "speed of sound in the lattice / c",
                            "support");
}

TEST_CASE("in a kernel, in fp32") {
    course::set_hint(3);
    const float support_m = 0.05f;  // as in the chapter's scenes: 1/h^4 is 1.6e5 / m^4
    const int n = 700;              // not a multiple of the block; up to 1.4 supports
    std::vector<float> r_m(n);
    std::vector<double> value_expected(n), slope_expected(n);
    for (int i = 0; i < n; ++i) {
        r_m[i] = 0.002f * support_m * i;
        const double l = 0.5 * support_m, q = std::min(r_m[i] / l, 2.0),
                     rest = 1 - q / 2;  // as books write it
        value_expected[i] = 21 / (16 * sph::kPi * std::pow(l, 3)) * std::pow(rest, 4) * (1 + 2 * q);
        slope_expected[i] = 21 / (16 * sph::kPi * std::pow(l, 4)) * 5 * q * std::pow(rest, 3);
    }
    const course::DeviceBuffer<float> r(r_m);
    course::DeviceBuffer<float> value(n), slope(n);
    evaluate_kernel<<<(n + 127) / 128, 128>>>(value.data(), slope.data(), r.data(), support_m, n);
    CUDA_CHECK(cudaGetLastError());
    const auto to_double = [](const std::vector<float>& v) {
        return std::vector<double>(v.begin(), v.end());
    };
    // Some ten roundings of fp32, 6e-8 each, of the largest value: W(0) = 3.34 / h^3, and 7.1 / h^4 for the
    // slope.
    const double w0 = 3.34 / std::pow(support_m, 3), steepest = 7.1 / std::pow(support_m, 4);
    if (course::check_close(to_double(value.download()), value_expected, 1e-6 * w0,
                            "W (1/m^3) at r = k h / 500, h = 0.05 m,", "k"))
        course::check_close(to_double(slope.download()), slope_expected, 1e-6 * steepest,
                            "-dW/dr (1/m^4) at r = k h / 500, h = 0.05 m,", "k");
}
