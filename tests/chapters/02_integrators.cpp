// Chapter 02: every method against numbers that are not ours, at its limit, in float, and at the edges.
#include "02_integrators/integrators.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "02_integrators/batch.h"
#include "02_integrators/bouncing_ball.h"
#include "02_integrators/checks.h"
#include "02_integrators/methods.h"
#include "02_integrators/stability.h"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"

using namespace integrators;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- tables of known answers

using Row = std::map<std::string, std::string>;  // column name to text

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line)
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    return cells;
}

std::vector<Row> read_table(const std::string& name) {
    std::ifstream file(std::string(COURSE_DATA_DIR) + "/02_integrators/" + name + ".csv");
    std::string line;
    REQUIRE_MESSAGE(std::getline(file, line), "cannot read " << name);
    const std::vector<std::string> columns = split(line);
    std::vector<Row> rows;
    while (std::getline(file, line)) {
        const std::vector<std::string> cells = split(line);
        REQUIRE(cells.size() == columns.size());
        Row row;
        for (std::size_t k = 0; k < cells.size(); ++k) row[columns[k]] = cells[k];
        rows.push_back(row);
    }
    REQUIRE(!rows.empty());
    return rows;
}

double number(const Row& row, const std::string& column) {
    return std::stod(row.at(column));
}

// ---- running

template <class Method, class Real = double, class System>
State<Real, System::kDim> fly(const System& system, double end_s, long steps, double u = 0) {
    constexpr int D = System::kDim;
    const State<double, D> start = system.exact(u, 0);
    State<Real, D> s = begin(system, Real(0), Vec<Real, D>(start.x), Vec<Real, D>(start.v));
    const double dt = end_s / steps;
    for (long k = 0; k < steps; ++k) s = Method::step(system, s, Real(k * dt), Real(dt));
    return s;
}

template <int D>
State<double, D> to_double(const State<float, D>& s) {
    return {Vec<double, D>(s.x), Vec<double, D>(s.v), Vec<double, D>(s.force)};
}
template <int D>
State<double, D> to_double(const State<double, D>& s) {
    return s;
}

template <class Method, class Real = double, class System>
double error_at(const System& system, double end_s, long steps) {
    return system.error(to_double(fly<Method, Real>(system, end_s, steps)), system.exact(0, end_s));
}

/// Calls `work` with the method of that name, as the tables call it.
template <class Work>
void with_table_method(const std::string& name, Work&& work) {
    if (name == "EE" || name == "explicit_euler") return work(ExplicitEuler{});
    if (name == "SE" || name == "semi_implicit_euler") return work(SemiImplicitEuler{});
    if (name == "SEimp" || name == "semi_implicit_euler_implicit_drag")
        return work(SemiImplicitEulerImplicitDrag{});
    if (name == "LF" || name == "leapfrog" || name == "KDKsym") return work(Leapfrog{});
    if (name == "KDK" || name == "leapfrog_lagged_drag") return work(LeapfrogLaggedDrag{});
    if (name == "VVpred" || name == "leapfrog_predicted_drag") return work(LeapfrogPredictedDrag{});
    if (name == "RK2") return work(Midpoint{});
    if (name == "RK4") return work(RungeKutta4{});
    FAIL("no method is called " << name);
}

/// All of them, for what must hold for any method.
template <class Work>
void with_explicit_methods(Work&& work) {
    work(ExplicitEuler{}), work(SemiImplicitEuler{}), work(SemiImplicitEulerImplicitDrag{}), work(Leapfrog{});
    work(LeapfrogLaggedDrag{}), work(LeapfrogPredictedDrag{}), work(Midpoint{}), work(RungeKutta4{});
    work(ExponentialLeapfrog{});
}
template <class Work>
void with_all_methods(Work&& work) {
    with_explicit_methods(work);
    work(ImplicitEuler{}), work(ImplicitMidpoint{});
}

double energy(const State<double, 1>& s) {
    return 0.5 * (s.x.x * s.x.x + s.v.x * s.v.x);
}

}  // namespace

// ------------------------------------------------------------------------- the oscillator without drag

TEST_CASE("each method gives exactly its own discrete answer, over up to 2 million steps") {
    // What the algorithm must output, not the ODE: a linear map applied n times, computed elsewhere in 40
    // digits. A wrong coefficient or order of updates shows at once. 1e-10 of the state's size: each step
    // rounds by 1e-16 of it, and 2e6 roundings of one sign would make 2e-10; they are of both signs.
    for (const Row& row : read_table("harmonic_discrete_exact"))
        with_table_method(row.at("method"), [&](auto method) {
            const double periods = number(row, "periods"), n = number(row, "steps_per_period");
            const auto s = fly<decltype(method)>(Oscillator{}, 2 * kPi * periods, long(n * periods));
            const double x = number(row, "x"), v = number(row, "v"), size = std::hypot(x, v);
            const double off = std::hypot(s.x.x - x, s.v.x - v) / size;
            CHECK_MESSAGE(!!(off <= 1e-10), row.at("method")
                                                << " N " << n << ", " << periods << " periods: " << off);
        });
}

TEST_CASE("energy follows each method's law") {
    const double h = 2 * kPi / 100;
    const long n = 1000;
    const auto ratio = [&](auto method, long steps) {
        return energy(fly<decltype(method)>(Oscillator{}, h * steps, steps)) /
               energy(Oscillator{}.exact(0, 0));
    };
    // |eigenvalue|^2 to the power n; a relative 1e-11 is n roundings of 1e-14.
    CHECK_FALSE(!(std::abs(ratio(ExplicitEuler{}, n) / std::pow(1 + h * h, n) - 1) <= 1e-11));
    CHECK_FALSE(!(std::abs(ratio(Midpoint{}, n) / std::pow(1 + h * h * h * h / 4, n) - 1) <= 1e-11));
    const double rk4 = 1 - std::pow(h, 6) / 72 + std::pow(h, 8) / 576;
    CHECK_FALSE(!(std::abs(ratio(RungeKutta4{}, n) / std::pow(rk4, n) - 1) <= 1e-11));
    CHECK_FALSE(!(std::abs(ratio(ImplicitMidpoint{}, n) - 1) <= 1e-11));
    CHECK_FALSE(!(std::abs(ratio(ImplicitEuler{}, n) * std::pow(1 + h * h, n) - 1) <= 1e-11));
}

TEST_CASE("over 10 thousand periods, leapfrog and semi-implicit Euler keep a neighbour of the energy") {
    const double h = 2 * kPi / 100;
    const auto invariant_drift = [&](auto method, auto invariant) {
        State<double, 1> s = Oscillator{}.exact(0, 0);
        const double before = invariant(s);
        double worst = 0, low = 1e9, high = 0;
        for (long k = 0; k < 1000000; ++k) {
            s = decltype(method)::step(Oscillator{}, s, 0.0, h);
            worst = std::max(worst, std::abs(invariant(s) - before));
            low = std::min(low, energy(s)), high = std::max(high, energy(s));
        }
        // No drift: energy stays in the band that the first period shows. Leapfrog's is [1 - h^2/4, 1]
        // exactly, semi-implicit Euler's within 1 -+ h/2, as |h x v| <= h (x^2 + v^2) / 2 says.
        CHECK(low / 0.5 > 1 - h);
        CHECK(high / 0.5 < 1 + h);
        return worst;
    };
    // A million steps, each rounding by up to 2e-16: 2e-10 if all went one way. They walk at random: far
    // below 1e-11.
    CHECK_FALSE(!(invariant_drift(Leapfrog{}, [&](const State<double, 1>& s) {
                      return s.v.x * s.v.x + (1 - h * h / 4) * s.x.x * s.x.x;
                  }) <= 1e-11));
    CHECK_FALSE(!(invariant_drift(SemiImplicitEuler{}, [&](const State<double, 1>& s) {
                      return s.x.x * s.x.x + s.v.x * s.v.x - h * s.x.x * s.v.x;
                  }) <= 1e-11));
}

TEST_CASE("explicit Euler's energy overflows in the period that its law says") {
    // N = 100: E passes the largest double in period 1803, x the largest float in period 450.
    const double h = 2 * kPi / 100;
    State<double, 1> s = Oscillator{}.exact(0, 0);
    double overflow_period = 0, float_period = 0;
    for (long k = 1; k < 200000 && overflow_period == 0; ++k) {
        s = ExplicitEuler::step(Oscillator{}, s, 0.0, h);
        if (float_period == 0 && std::hypot(s.x.x, s.v.x) > 3.4028235e38) float_period = k / 100.0;
        if (!(0.5 * s.x.x * s.x.x + 0.5 * s.v.x * s.v.x < kInfinity)) overflow_period = k / 100.0;
    }
    CHECK_FALSE(!(std::abs(overflow_period - 1803.2064) <= 0.011));  // a step is 0.01 periods
    // The table tells when |x| passes; the length of (x, v) does up to half a period earlier.
    CHECK_FALSE(!(std::abs(float_period - 450.3618) <= 0.5));
}

TEST_CASE("order: measured at t = 5, which is no whole period") {
    // At whole periods semi-implicit Euler looks second order: its error turns with the phase and comes back
    // to 0.
    std::map<std::string, double> last;
    for (const Row& row : read_table("harmonic_convergence_t5"))
        with_table_method(row.at("method"), [&](auto method) {
            const double dt = number(row, "dt"), expected = number(row, "phase_space_error_at_t5");
            const double got = error_at<decltype(method)>(Oscillator{}, 5.0, std::lround(5 / dt));
            // The error is a difference of numbers of size 1 after up to 800 steps: 1e-13 of rounding is left
            // in it.
            CHECK_MESSAGE(!!(std::abs(got - expected) <= 1e-13 + 1e-8 * expected),
                          row.at("method") << " dt " << dt << ": " << got << ", expected " << expected);
            if (dt <= 0.0125) {
                const double order = std::log2(last[row.at("method")] / got);
                const double nominal = row.at("method") == "RK4" ? 4 : row.at("method")[1] == 'E' ? 1 : 2;
                CHECK_MESSAGE(!!(std::abs(order - nominal) <= 0.05), row.at("method") << " order " << order);
            }
            last[row.at("method")] = got;
        });
}

TEST_CASE("steps to a given error are those of the table: leapfrog is the cheapest at 1 %, RK4 below") {
    const auto check = [](auto method, int steps, double expected) {
        const double got = error_at<decltype(method)>(Oscillator{}, 5.0, steps);
        CHECK_MESSAGE(!!(std::abs(got / expected - 1) <= 1e-6),
                      steps << " steps: " << got);  // 7 digits are given
    };
    check(ExplicitEuler{}, 1256, 0.010001873008282196);
    check(SemiImplicitEuler{}, 23975, 0.00010000079295231609);
    check(Leapfrog{}, 26, 0.009960969969955944);
    check(Leapfrog{}, 2589, 1.0003557842557352e-06);
    check(Midpoint{}, 456, 0.00010019089971772684);
    check(RungeKutta4{}, 7, 0.010763509461871414);
    check(RungeKutta4{}, 71, 1.024740735565484e-06);
}

TEST_CASE("free fall: the sign of the error tells the two Eulers apart") {
    // x = g dt^2 n (n -+ 1) / 2, and exact for the methods of order 2. No drag.
    struct FreeFall : Oscillator {
        Vec<double, 1> force(double, Vec<double, 1>) const { return Vec<double, 1>(-9.81); }
        double drag() const { return 0; }
    };
    const auto fall = [](auto method) {
        State<double, 1> s = begin(FreeFall{}, 0.0, Vec<double, 1>(0.0), Vec<double, 1>(0.0));
        for (int k = 0; k < 100; ++k) s = decltype(method)::step(FreeFall{}, s, 0.0, 0.01);
        return s.x.x;
    };
    // 100 additions of numbers up to 5 round by 1e-13 at most.
    CHECK_FALSE(!(std::abs(fall(ExplicitEuler{}) + 4.85595) <= 1e-12));
    CHECK_FALSE(!(std::abs(fall(SemiImplicitEuler{}) + 4.95405) <= 1e-12));
    CHECK_FALSE(!(std::abs(fall(Leapfrog{}) + 4.905) <= 1e-12));
    CHECK_FALSE(!(std::abs(fall(ExponentialLeapfrog{}) + 4.905) <= 1e-12));
    CHECK_FALSE(!(std::abs(fall(Midpoint{}) + 4.905) <= 1e-12));
    CHECK_FALSE(!(std::abs(fall(RungeKutta4{}) + 4.905) <= 1e-12));
}

// ----------------------------------------------------------------------------------------------- drag

TEST_CASE("the damped oscillator's closed form agrees with 40 digits") {
    for (const Row& row : read_table("damped_oscillator")) {
        const auto s = Oscillator{1, number(row, "zeta")}.exact(0, number(row, "omega*t"));
        // A few roundings of numbers below 1; at zeta 500 the two rates differ by a factor 1e6.
        CHECK_FALSE(!(std::abs(s.x.x - number(row, "x")) <= 2e-15));
        CHECK_FALSE(!(std::abs(s.v.x - number(row, "v/omega")) <= 2e-15));
    }
    for (const double zeta : {0.0, 0.1, 1.0, 10.0})
        for (const double u : {0.0, 0.3, 0.77}) {  // omega only changes the clock
            const auto slow = Oscillator{1, zeta}.exact(u, 3.0), fast = Oscillator{100, zeta}.exact(u, 0.03);
            CHECK_FALSE(!(std::abs(slow.x.x - fast.x.x) <= 1e-14));
            CHECK_FALSE(!(std::abs(100 * slow.v.x - fast.v.x) <= 1e-12));
        }
}

TEST_CASE("order with drag, and the error itself: where the drag is put decides") {
    for (const Row& row : read_table("drag_order_measured"))
        with_table_method(row.at("method"), [&](auto method) {
            const Oscillator system{1, number(row, "zeta")};
            const double coarse = error_at<decltype(method)>(system, 2.0, 400);
            const double fine = error_at<decltype(method)>(system, 2.0, 800), expected = number(row, "error");
            // RK4's error of 3e-13 is near the rounding of 800 steps, 1e-15 to 1e-14.
            CHECK_MESSAGE(!!(std::abs(fine - expected) <= 1e-14 + 1e-6 * expected),
                          row.at("method")
                              << " zeta " << system.zeta << ": " << fine << ", expected " << expected);
            CHECK_MESSAGE(!!(std::abs(std::log2(coarse / fine) - number(row, "order")) <= 0.03),
                          row.at("method") << " order " << std::log2(coarse / fine));
        });
}

TEST_CASE("order with drag over four halvings, for the drag ratios 0.1, 1 and 10") {
    const auto check = [](auto method, double nominal) {
        for (const double zeta : {0.1, 1.0, 10.0}) {
            const Oscillator system{1, zeta};
            double before = 0;
            for (const long steps : {1000L, 2000L, 4000L, 8000L}) {  // omega dt = 0.01 and below; t = 10
                const double now = error_at<decltype(method)>(system, 10.0, steps);
                // RK4 reaches its rounding floor of 1e-14 here: an order is measured above it.
                if (before > 0 && now > 1e-13)
                    CHECK_MESSAGE(!!(std::abs(std::log2(before / now) - nominal) <= 0.15),
                                  "zeta " << zeta << ", " << steps << " steps: " << std::log2(before / now));
                before = now;
            }
        }
    };
    check(ExplicitEuler{}, 1), check(SemiImplicitEuler{}, 1), check(SemiImplicitEulerImplicitDrag{}, 1);
    check(LeapfrogLaggedDrag{}, 1), check(ImplicitEuler{}, 1);
    check(Leapfrog{}, 2), check(LeapfrogPredictedDrag{}, 2), check(Midpoint{}, 2);
    check(ExponentialLeapfrog{}, 2), check(ImplicitMidpoint{}, 2);
    check(RungeKutta4{}, 4);
}

TEST_CASE("without drag, exponential leapfrog is leapfrog") {
    State<double, 1> a = Oscillator{}.exact(0.2, 0), b = a;
    for (int k = 0; k < 1000; ++k) {
        a = Leapfrog::step(Oscillator{}, a, 0.0, 0.1);
        b = ExponentialLeapfrog::step(Oscillator{}, b, 0.0, 0.1);
    }
    CHECK_FALSE(
        !(std::abs(a.x.x - b.x.x) + std::abs(a.v.x - b.v.x) <= 1e-12));  // 1000 roundings, other order
}

TEST_CASE("the drag factors keep their digits on both sides of the series' border") {
    CHECK(drag_factors(0).phi1 == 1);
    CHECK(drag_factors(0).phi2 == 0.5);
    for (const double z : {1e-300, 1e-12, 1e-6, 1e-3, 9.999e-3, 1e-2, 1.001e-2, 0.5, 3.0, 700.0, 1e12}) {
        // The series, summed until nothing is added, or for large z the closed form in long double.
        long double phi1, phi2;
        if (z < 1) {
            long double term = 1;
            phi1 = phi2 = 0;
            for (int n = 1; n < 40; ++n) {
                phi1 += term / n, phi2 += term / n / (n + 1);
                term *= -(long double)z / n;
            }
        } else {
            phi1 = -std::expm1(-(long double)z) / z;
            phi2 = (1 - phi1) / z;
        }
        // The short series leaves out 2e-11 of the sum; beyond its border 1 - phi1 >= 0.005 costs two digits
        // of 16.
        CHECK_FALSE(!(std::abs(drag_factors(z).phi1 / double(phi1) - 1) <= 2e-11));
        CHECK_FALSE(!(std::abs(drag_factors(z).phi2 / double(phi2) - 1) <= 2e-11));
    }
}

// ---------------------------------------------------------------------------------------- stability limits

TEST_CASE("limits from the step matrix are those of the table, for every method and drag ratio") {
    for (const Row& row : read_table("stability_limits"))
        for (const auto& [name, text] : row)
            if (name != "zeta")
                with_table_method(name, [&, &column = name](auto method) {
                    const double zeta = number(row, "zeta"), expected = number(row, column);
                    const double got = stability_limit<decltype(method)>(zeta);
                    // The step matrix's eigenvalue is known to 1e-13, and where two eigenvalues meet (zeta =
                    // 1), the limit only to the root of that, 3e-7.
                    CHECK_MESSAGE(!!(std::abs(got - expected) <= 1e-6 * expected),
                                  column << ", zeta " << zeta << ": " << got << ", expected " << expected);
                });
}

TEST_CASE("a run is stable at 0.99 of the table's limit and grows at 1.01") {
    for (const Row& row : read_table("stability_limits"))
        for (const auto& [name, text] : row)
            if (name != "zeta")
                with_table_method(name, [&, &column = name](auto method) {
                    const double zeta = number(row, "zeta"), limit = number(row, column);
                    const Oscillator system{1, zeta};
                    const auto largest = [&](double h, long steps, double enough) {
                        State<double, 1> s = system.exact(0, 0);
                        double most = 0;
                        for (long k = 0; k < steps; ++k) {
                            s = decltype(method)::step(system, s, 0.0, h);
                            const double size = std::hypot(s.x.x, s.v.x);
                            most = std::max(most, size);
                            if (size > enough || size < 1e-30)
                                break;  // told; or decayed (tiny numbers are slow)
                        }
                        return most;
                    };
                    // The slowest growth is that of explicit Euler at zeta = 0.01: 1 + 2e-6 a step, so 1e3
                    // takes 3.4e6 steps. Below the limit the largest transient is some 75 (zeta = 1, double
                    // eigenvalue).
                    if (limit > 0)
                        CHECK_MESSAGE(largest(0.99 * limit, 100000, 1e3) < 200, column << " zeta " << zeta);
                    const double above =
                        limit > 0 ? 1.01 * limit : 0.1;  // 0: unstable at any step, if weakly
                    CHECK_MESSAGE(largest(above, 5000000, 1e3) > 1e3, column << " zeta " << zeta);
                });
}

TEST_CASE("leapfrog with symmetric drag has the limit 2 at any drag ratio; implicit methods have none") {
    for (const double zeta : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0}) {
        CHECK_FALSE(!(std::abs(stability_limit<Leapfrog>(zeta) - 2) <= 2e-6));
        CHECK(stability_limit<ImplicitEuler>(zeta) == kInfinity);
        CHECK(stability_limit<ImplicitMidpoint>(zeta) == kInfinity);
        CHECK(stability_limit<ExponentialLeapfrog>(zeta) >= 1.999);  // and grows with the drag
    }
    CHECK(stability_limit<ExponentialLeapfrog>(100.0) > 100);
}

// ------------------------------------------------------------------------------------------------ stiffness

TEST_CASE("the stiff pair's answer is the table's, and its force pulls the way it should") {
    for (const Row& row : read_table("stiff_pair")) {
        const auto s = StiffPair{}.exact(0, number(row, "t"));
        // cos(1000 t) with t up to 100: an argument of 1e5 is known to 1.5e-11.
        CHECK_FALSE(!(std::abs(s.x.x - number(row, "u")) <= 2e-11));
        CHECK_FALSE(!(std::abs(s.x.y - number(row, "w")) <= 2e-11));
    }
    const Vec<double, 2> f = StiffPair{}.force(0.0, Vec<double, 2>(1, 0));
    CHECK_FALSE(!(std::abs(f.x + 500000.5) <= 1e-9));
    CHECK_FALSE(!(std::abs(f.y - 499999.5) <= 1e-9));
    const Vec<double, 2> b(0.3, -0.7), u = StiffPair{}.solve(1.5, 0.25, b);
    const Vec<double, 2> back = 1.5 * u - 0.25 * StiffPair{}.force(0.0, u);  // K u = -F(u)
    CHECK_FALSE(!(glm::length(back - b) <= 1e-9));                           // 1e-16 of 1e6 x u
}

TEST_CASE("leapfrog at dt = 1e-3 has the slow motion of the stiff pair right to 5e-6 at t = 100") {
    // Its frequency is too high by dt^2 / 24, which at t = 100 is a phase of 4.2e-6.
    CHECK_FALSE(!(error_at<Leapfrog>(StiffPair{}, 100.0, 100000) <= 5e-6));
    // Near the limit the fast phase is lost altogether, the slow motion is not: t dt^2 / 24 = 1.5e-5.
    const auto s = fly<Leapfrog>(StiffPair{}, 100.0, 52632);  // dt = 1.9e-3
    const auto exact = StiffPair{}.exact(0, 100.0);
    CHECK(std::abs(StiffPair::slow_mode(s) - StiffPair::slow_mode(exact)) < 1.6e-5);
    CHECK(std::abs(StiffPair::fast_mode(s) - StiffPair::fast_mode(exact)) > 0.1);
}

TEST_CASE("implicit methods step over the fast motion: one damps it, the other leaves it ringing") {
    const StiffPair pair;
    const double end = 10;
    const long steps = 1000;  // dt = 0.01: ten radians of the fast motion a step
    const auto euler = fly<ImplicitEuler>(pair, end, steps),
               midpoint = fly<ImplicitMidpoint>(pair, end, steps);
    // Slow motion: implicit Euler damps it by t dt / 2 = 5 %, midpoint shifts its phase by t dt^2 / 12 =
    // 8e-5.
    CHECK(pair.error(euler, pair.exact(0, end)) < 0.05);
    CHECK(pair.error(midpoint, pair.exact(0, end)) < 1e-4);
    // Fast motion: a factor 1 / sqrt(1 + 100) a step against exactly 1, with v / 1000 as its other part.
    const double fast_speed = std::sqrt(0.5) * (midpoint.v.x - midpoint.v.y) / 1000;
    CHECK(std::abs(StiffPair::fast_mode(euler)) < 1e-100);
    CHECK_FALSE(!(std::abs(std::hypot(StiffPair::fast_mode(midpoint), fast_speed) - 1) <= 1e-9));
    CHECK_THROWS_AS(
        run_watched<Leapfrog>(pair, pair.exact(0, 0), steps, 0.01, "leapfrog", 2e-3, [](long, auto) {}),
        course::Unstable);
}

TEST_CASE("a mote in the wind: stiff drag 1e6") {
    const MoteInWind mote;
    const auto unstable = [&](auto method, double dt) {
        try {
            run_watched<decltype(method)>(mote, mote.exact(0, 0), 2000, dt, decltype(method)::kName,
                                          longest_step_s<decltype(method)>(mote), [](long, auto) {});
            return std::string();
        } catch (const course::Unstable& error) {
            return std::string(error.what());
        }
    };
    CHECK(unstable(ExplicitEuler{}, 1.98e-6) == "");
    CHECK(unstable(ExplicitEuler{}, 2.1e-6).find("over the limit of explicit Euler, 2e-06 s") !=
          std::string::npos);
    CHECK(unstable(RungeKutta4{}, 2.75e-6) == "");
    CHECK(unstable(RungeKutta4{}, 2.83e-6).find("over the limit of RK4, 2.785e-06 s") != std::string::npos);
    CHECK_FALSE(!(std::abs(longest_step_s<RungeKutta4>(mote) / 2.7852935634052814e-06 - 1) <= 1e-9));
    // Ten steps in all. Implicit Euler is off by dt |y''| / (2 (1 + k dt)) <= 5e-7; the exponential step by
    // the wind's bend within the step divided by k, which is less.
    CHECK_FALSE(!(error_at<ImplicitEuler>(mote, 1.0, 10) <= 5e-7));
    CHECK_FALSE(!(error_at<ExponentialLeapfrog>(mote, 1.0, 10) <= 5e-7));
    // Midpoint does not damp: its first error, of size dt^2, alternates for ever.
    CHECK(error_at<ImplicitMidpoint>(mote, 1.0, 10) < 5e-3);
    // Leapfrog is stable too, as its second kick is implicit, and alternates in the same way.
    CHECK(error_at<Leapfrog>(mote, 1.0, 10) < 0.1);
}

// -------------------------------------------------------------------------------------------- flights

TEST_CASE("the projectile's flight agrees with 40 digits, and RK4 with the flight") {
    const Projectile system;
    const auto at = [&](double t, double x, double y) {
        const auto s = system.exact(0, t);
        CHECK_FALSE(!(std::abs(s.x.x - x) <= 1e-13));  // numbers below 64 round by 7e-15
        CHECK_FALSE(!(std::abs(s.x.y - y) <= 1e-13));
    };
    at(1, 23.608160417241994, 27.297284135865592);
    at(3, 46.61219039109421, 33.77395970390123);
    at(5.731401112323652, 56.583406486308306, 0);
    CHECK_FALSE(!(std::abs(system.exact(0, 2.222883268225417).v.y) <= 1e-13));
    CHECK_FALSE(!(error_at<RungeKutta4>(system, 3.0, 300) <= 1e-9));
    CHECK_FALSE(
        !(error_at<ExponentialLeapfrog>(system, 3.0, 1) <= 1e-11));  // a constant force: exact in one step
    const auto order = [&](auto method) {
        return std::log2(error_at<decltype(method)>(system, 3.0, 600) /
                         error_at<decltype(method)>(system, 3.0, 1200));
    };
    // The next term of the series is dt / tau = 0.0025 of the error.
    CHECK_FALSE(!(std::abs(order(ExplicitEuler{}) - 1) <= 0.01));
    CHECK_FALSE(!(std::abs(order(SemiImplicitEuler{}) - 1) <= 0.01));
    CHECK_FALSE(!(std::abs(order(Leapfrog{}) - 2) <= 0.01));
    CHECK_FALSE(!(std::abs(order(Midpoint{}) - 2) <= 0.01));
}

TEST_CASE("Kepler's orbit is where 40 digits say") {
    for (const Row& row : read_table("kepler_positions")) {
        const auto s = Kepler{}.exact(0, number(row, "t"));
        // E is known to 1e-16 and x changes by up to 4.4 of it near the perihelion; v by up to 100 times
        // more.
        CHECK_FALSE(!(std::abs(s.x.x - number(row, "x")) <= 1e-14));
        CHECK_FALSE(!(std::abs(s.x.y - number(row, "y")) <= 1e-14));
        CHECK_FALSE(!(std::abs(s.v.x - number(row, "vx")) <= 1e-12));
        CHECK_FALSE(!(std::abs(s.v.y - number(row, "vy")) <= 1e-12));
    }
    for (double t = -7; t < 7;
         t += 0.01) {  // Newton's method goes astray nowhere: energy is -1/2 all the way
        const auto s = Kepler{}.exact(0.3, t);
        CHECK_FALSE(!(std::abs(Kepler::energy(s) + 0.5) <= 1e-12));
        CHECK_FALSE(!(std::abs(Kepler::angular_momentum(s) - std::sqrt(0.19)) <= 1e-13));
    }
}

TEST_CASE("errors after one orbit are those of the table, for every method and number of steps") {
    for (const Row& row : read_table("kepler_work_precision"))
        with_table_method(row.at("method"), [&](auto method) {
            using Method = decltype(method);
            const long n = long(number(row, "steps_per_orbit"));
            const auto s = fly<Method>(Kepler{}, 2 * kPi, n);
            const double got = glm::length(s.x - Vec<double, 2>(0.1, 0)),
                         expected = number(row, "pos_err_after_1_orbit");
            // The perihelion makes much of little: rounding of 64000 steps is left as some 1e-11.
            CHECK_MESSAGE(!!(std::abs(got - expected) <= 2e-11 + 1e-7 * expected),
                          row.at("method") << ", " << n << " steps: " << got << ", expected " << expected);
            const double drift = std::abs(Kepler::energy(s) / -0.5 - 1),
                         expected_drift = number(row, "rel_E_err");
            CHECK_MESSAGE(!!(std::abs(drift - expected_drift) <= 2e-11 + 1e-6 * expected_drift),
                          row.at("method")
                              << ", " << n << " steps: " << drift << ", expected " << expected_drift);
            CHECK(std::lround(number(row, "force_evals")) == n * Method::kEvaluations);
        });
}

TEST_CASE("leapfrog and semi-implicit Euler keep the angular momentum to rounding over 100 thousand steps") {
    // Both move x along v and v along x only: each update leaves x cross v as it is. Explicit Euler fails
    // visibly.
    const auto drift = [](auto method) {
        const auto s = fly<decltype(method)>(Kepler{}, 50 * 2 * kPi, 100000);
        return std::abs(Kepler::angular_momentum(s) / std::sqrt(0.19) - 1);
    };
    CHECK_FALSE(!(drift(Leapfrog{}) <= 1e-12));
    CHECK_FALSE(!(drift(SemiImplicitEuler{}) <= 1e-12));
    CHECK(drift(ExplicitEuler{}) > 0.1);
}

// ------------------------------------------------------------------------------------------ the bouncing
// ball

TEST_CASE("the ball's exact flight has the table's impact times and heights") {
    const BouncingBall ball;
    const double times[] = {0.4515236409857309, 1.1739614665629003, 1.7519117270246358, 2.2142719353940246,
                            2.5841601020895353, 2.8800706354459438, 3.1167990621310704, 3.306181803479172,
                            3.4576879965576532, 3.578892951020438};
    for (int k = 0; k < 10; ++k) CHECK_FALSE(!(std::abs(ball.impact_s(k + 1) - times[k]) <= 1e-14));
    CHECK_FALSE(!(std::abs(ball.rest_s() - 4.063712768871578) <= 1e-14));
    CHECK_FALSE(!(std::abs(ball.exact(0, 0.5).x.x - 0.16025222626301816) <= 1e-14));
    CHECK_FALSE(!(std::abs(ball.exact(0, 1.0).x.x - 0.4680044525260363) <= 1e-14));
    CHECK_FALSE(!(std::abs(ball.exact(0, 2.0).x.x - 0.2607417283270572) <= 1e-14));
    CHECK_FALSE(!(std::abs(ball.exact(0, 3.0).x.x - 0.06870746096576572) <= 1e-14));
    CHECK(ball.exact(0, 5.0).x.x == 0);
}

TEST_CASE("interpolated impacts: ten of them where they should be, and energy never grows") {
    const BouncingBall ball;
    const double dt = 1e-3;
    const auto bounce = [&](auto flight) {
        using Flight = decltype(flight);
        State<double, 1> s = ball.exact(0, 0);
        std::vector<double> impacts;
        for (int k = 0; k < 6000; ++k) {
            const State<double, 1> before = s, after = Flight::step(ball, s, 0.0, dt);
            if (after.x.x < 0) impacts.push_back((k + impact_fraction(before.x.x, after.x.x)) * dt);
            s = ImpactInterpolated<Flight>::step(ball, s, 0.0, dt);
            // A flight of order 2 keeps the energy of a fall; finding the impact on a chord instead of the
            // parabola is g dt^2 / 8 high at most, 1.2e-6 m of 1 m, and the impact takes 36 %.
            CHECK(ball.energy(s) <= ball.energy(before) * (1 + 1e-6) + 1e-12);
            CHECK(s.x.x >= 0);
        }
        CHECK(std::abs(s.x.x) < 9.81 * dt * dt);  // t = 6 s: at rest since 4.06 s
        REQUIRE(impacts.size() >= 10);
        return impacts;
    };
    for (const std::vector<double>& impacts :
         {bounce(Leapfrog{}), bounce(Midpoint{}), bounce(RungeKutta4{})}) {
        // The chord lies up to g dt^2 / 8 below the parabola: an impact at the speed v is found g dt^2 / (8
        // v) early, too slow by g times that, and what follows is early by twice as much again.
        double early_s = 0;
        for (int k = 0; k < 10; ++k) {
            early_s += 9.81 * dt * dt / (8 * std::sqrt(2 * 9.81) * std::pow(0.8, k));
            CHECK_FALSE(!(std::abs(impacts[k] - ball.impact_s(k + 1)) <= 3 * early_s));  // k = 0: 8e-7 s
        }
    }
}

TEST_CASE("a ball at rest stays there, under each of the two rules") {
    const BouncingBall ball;
    State<double, 1> a = ball.exact(0, 10.0), b = a;
    for (int k = 0; k < 1000; ++k) {
        a = ImpactInterpolated<Leapfrog>::step(ball, a, 0.0, 0.01);
        b = ReflectedAtStepEnd<Leapfrog>::step(ball, b, 0.0, 0.01);
        CHECK(a.x.x == 0);
        CHECK(a.v.x == 0);
        CHECK(std::abs(b.x.x) < 9.81 * 0.01 * 0.01);  // it trembles by what gravity gives in a step
    }
}

TEST_CASE("order at impacts: 2 if interpolated, 1 if reflected at the end of the step") {
    // The root mean square over 256 heights: where in its step an impact falls is then averaged away.
    const auto order = [](auto method) {
        const BouncingBall ball;
        const auto error = [&](int steps) {
            auto batch = make_batch<double>(ball, 256);
            solve<decltype(method), double>(batch, ball, steps, 1.0);
            return rms_error(batch, ball, 1.0);
        };
        return std::log2(error(500) / error(4000)) / 3;
    };
    CHECK_FALSE(!(std::abs(order(ImpactInterpolated<Leapfrog>{}) - 2) <= 0.1));
    CHECK_FALSE(!(std::abs(order(ImpactInterpolated<RungeKutta4>{}) - 2) <= 0.1));
    CHECK_FALSE(!(std::abs(order(ImpactInterpolated<SemiImplicitEuler>{}) - 1) <= 0.1));
    CHECK_FALSE(!(std::abs(order(ReflectedAtStepEnd<Leapfrog>{}) - 1) <= 0.1));
    CHECK_FALSE(!(std::abs(order(ReflectedAtStepEnd<RungeKutta4>{}) - 1) <= 0.1));
}

// -------------------------------------------------------------------------------------------------- float

TEST_CASE("in float, each method follows its discrete answer to 1e-5 for a thousand steps") {
    // 1000 steps round numbers below 1 by 6e-8 each: 2e-6 if they walk at random.
    for (const Row& row : read_table("harmonic_discrete_exact")) {
        if (row.at("steps_per_period") != "100" || row.at("periods") != "10") continue;
        with_table_method(row.at("method"), [&](auto method) {
            const auto s = fly<decltype(method), float>(Oscillator{}, 20 * kPi, 1000);
            const double x = number(row, "x"), v = number(row, "v");
            CHECK_FALSE(!(std::hypot(s.x.x - x, s.v.x - v) <= 1e-5 * std::hypot(x, v)));
        });
    }
}

TEST_CASE("in float a smaller step makes RK4 worse: the rounding floor") {
    const auto rms = [](int steps, auto real) {
        using Real = decltype(real);
        auto batch = make_batch<Real>(Oscillator{}, 64);
        solve<RungeKutta4, Real>(batch, Oscillator{}, steps, 5.0);
        return rms_error(batch, Oscillator{}, 5.0);
    };
    // The method's own error at 160 steps is 6e-8 (h^4 t / 120), and falls below rounding after that.
    CHECK(rms(20, 0.0f) > 1e-5);
    CHECK(rms(160, 0.0f) < 1e-6);
    CHECK(rms(163840, 0.0f) > 3 * rms(160, 0.0f));  // a thousand times the work, a larger error
    CHECK(rms(163840, 0.0) < 1e-12);                // and in double it is not so
}

TEST_CASE("a batch gives what one copy gives, in any number") {
    // The same arithmetic; the compiler may fuse a multiplication with an addition in one loop and not in the
    // other.
    for (const int n : {1, 7, 16, 33}) {
        auto batch = make_batch<double>(Kepler{}, n);
        solve<Leapfrog, double>(batch, Kepler{}, 1000, 1.0);
        for (int i = 0; i < n; ++i) {
            const auto one = fly<Leapfrog>(Kepler{}, 1.0, 1000, double(i) / n);
            CHECK_FALSE(!(glm::length(batch.load(i).x - one.x) <= 1e-11));
        }
    }
}

// --------------------------------------------------------------------------------------------- the edges

TEST_CASE("a step of 0 changes nothing, a tiny one next to nothing") {
    with_all_methods([](auto method) {
        using Method = decltype(method);
        for (const double zeta : {0.0, 1.0, 1e6}) {
            const Oscillator system{1, zeta};
            const State<double, 1> s = system.exact(0.1, 0);
            for (const double dt : {0.0, 5e-324, 1e-300, 1e-30}) {
                const State<double, 1> after = Method::step(system, s, 0.0, dt);
                // Implicit midpoint makes the new velocity as 2 v_middle - v.
                CHECK_MESSAGE(!!(std::abs(after.x.x - s.x.x) <= 1e-16), Method::kName << " dt " << dt);
                CHECK_MESSAGE(!!(std::abs(after.v.x - s.v.x) <= 2.3e-16), Method::kName << " dt " << dt);
            }
        }
    });
}

TEST_CASE("stiffness 0: everybody flies straight on") {
    with_all_methods([](auto method) {
        using Method = decltype(method);
        const Oscillator free{0, 0};
        State<double, 1> s = begin(free, 0.0, Vec<double, 1>(1.0), Vec<double, 1>(0.5));
        for (int k = 0; k < 100; ++k) s = Method::step(free, s, 0.0, 0.25);
        CHECK_FALSE(
            !(std::abs(s.x.x - 13.5) <= 1e-13));  // RK4 divides by 6: 100 roundings of numbers up to 13.5
        CHECK_MESSAGE(s.v.x == 0.5, Method::kName);
    });
}

TEST_CASE("stiffness 1e12 and huge steps: a clear end, or an answer; never a silent NaN") {
    const Oscillator stiff{1e6, 0};
    with_explicit_methods([&](auto method) {
        using Method = decltype(method);
        for (const double dt : {1e-3, 1e30, 1e308}) {
            std::string what;
            try {
                run_watched<Method>(stiff, stiff.exact(0, 0), 1000, dt, Method::kName,
                                    longest_step_s<Method>(stiff), [](long, auto) {});
            } catch (const course::Unstable& error) {
                what = error.what();
            }
            CHECK_MESSAGE(what.find("step ") == 0, Method::kName << " dt " << dt << ": not noticed");
            const bool cause = what.find("over the limit of") != std::string::npos ||
                               what.find("has no stable step") != std::string::npos;
            CHECK_MESSAGE(cause, what);
        }
    });
    for (const double dt : {1e-3, 1e30}) {  // 1e308 squared is no number any more
        const auto euler =
            run_watched<ImplicitEuler>(stiff, stiff.exact(0, 0), 100, dt, "", kInfinity, [](long, auto) {});
        const auto midpoint = run_watched<ImplicitMidpoint>(stiff, stiff.exact(0, 0), 100, dt, "", kInfinity,
                                                            [](long, auto) {});
        CHECK(std::abs(euler.x.x) < 1e-6);       // damped
        CHECK(std::abs(midpoint.x.x) < 1.0001);  // ringing
    }
}

TEST_CASE("a state that is no number is named, with the step and the cause") {
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
        State<double, 1> s = Oscillator{}.exact(0, 0);
        s.v.x = bad;
        std::string what;
        try {
            run_watched<Leapfrog>(Oscillator{}, s, 10, 0.1, "leapfrog", 2.0, [](long, auto) {});
        } catch (const course::Unstable& error) {
            what = error.what();
        }
        CHECK_MESSAGE(what.find("step 0: x = (1)") == 0, what);
        CHECK_MESSAGE(what.find("started with a number that is none") != std::string::npos, what);
    }
    // One that becomes so on the way: a comet that falls into the sun.
    State<double, 2> s = begin(Kepler{}, 0.0, Vec<double, 2>(0.0), Vec<double, 2>(0.0));
    CHECK_THROWS_AS(run_watched<RungeKutta4>(Kepler{}, s, 10, 0.1, "RK4", 0.1, [](long, auto) {}),
                    course::Unstable);
}

// ---------------------------------------------------------------------------------------------- the program

TEST_CASE("bad input ends with exit code 2 and a sentence that names the value") {
    const struct {
        const char *arguments, *sentence;
    } cases[] = {
        {"--dt -0.1", "--dt must be"},
        {"--dt nan", "--dt must be"},
        {"--scene damped --zeta nan", "--zeta must be from 0 to 1000000, not nan"},
        {"--scene damped --zeta -1", "--zeta must be"},
        {"--scene stiff_pair --stiffness 0", "--stiffness must be from 1 to 1e12, not 0"},
        {"--scene stiff_pair --stiffness inf", "--stiffness must be"},
        {"--scene pendulum", "there is no scene 'pendulum'"},
        {"--method frog", "there is no method 'frog': choose one of explicit-Euler"},
        {"--scene kepler --method implicit-Euler", "this scene's force is not linear"},
        {"--study swing", "there is no study 'swing'"},
        {"--window", "--window"},
    };
    const course::TemporaryFolder folder;
    for (const auto& c : cases) {
        const course::ProgramRun run = course::run_program(
            "ch02_integrators", c.arguments + std::string(" --out ") + folder.path().string());
        CHECK_MESSAGE(run.exit_code == 2, c.arguments);
        CHECK_MESSAGE(run.output.find(c.sentence) != std::string::npos, run.output);
    }
}

TEST_CASE("an unstable run ends with exit code 3, says why, and keeps what there was until then") {
    const struct {
        const char *arguments, *sentence;
    } cases[] = {
        {"--scene stiff_pair --dt 0.0021", "over the limit of leapfrog, 0.002 s"},
        {"--scene stiff_drag --method RK4 --dt 3e-6", "over the limit of RK4, 2.785e-06 s"},
        {"--scene oscillator --method explicit-Euler --dt 0.2 --steps 10000", "has no stable step here"},
        {"--scene damped --zeta 10 --dt 0.3 --method leapfrog-lagged-drag", "leapfrog, lagged drag, 0.2 s"},
        {"--scene kepler --dt 1e30 --float", "over the limit of leapfrog"},
        {"--scene projectile --method RK2 --dt 5", "over the limit of RK2, 4 s"},
    };
    for (const auto& c : cases) {
        const course::TemporaryFolder folder;
        const course::ProgramRun run = course::run_program(
            "ch02_integrators", c.arguments + std::string(" --out ") + folder.path().string());
        CHECK_MESSAGE(run.exit_code == 3, c.arguments << ": " << run.output);
        CHECK_MESSAGE(run.output.find(c.sentence) != std::string::npos, run.output);
        CHECK(std::filesystem::exists(folder.path() / "result.json"));
    }
}

TEST_CASE("every scene runs by every method that can, in double and in float") {
    const course::TemporaryFolder folder;
    for (const std::string scene :
         {"oscillator", "damped", "stiff_pair", "stiff_drag", "projectile", "kepler", "bouncing_ball"})
        with_all_methods([&](auto method) {
            using Method = decltype(method);
            const bool linear = scene != "kepler" && scene != "bouncing_ball";
            if (kIsImplicit<Method> && !linear) return;
            for (const char* precision : {"", " --float"}) {
                const course::ProgramRun run = course::run_program(
                    "ch02_integrators", "--steps 20 --scene " + scene + " --method " + option_name<Method>() +
                                            precision + " --out " + folder.path().string());
                CHECK_MESSAGE(run.exit_code == 0, run.output);
                CHECK_MESSAGE(run.output.find("nan") == std::string::npos, run.output);
            }
        });
}

TEST_CASE("the tour writes its two pictures; explaining writes nothing") {
    const course::TemporaryFolder folder;
    const std::string out = " --out " + (folder.path() / "new").string();
    for (const char* scene : {"tour", "damped"})
        CHECK(course::run_program("ch02_integrators", std::string("--explain --scene ") + scene + out)
                  .exit_code == 0);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "new"));
    const course::ProgramRun run = course::run_program("ch02_integrators", "--width 96" + out);
    CHECK_MESSAGE(run.exit_code == 0, run.output);
    CHECK(std::filesystem::exists(folder.path() / "new" / "orbits.png"));
    CHECK(std::filesystem::exists(folder.path() / "new" / "phase.png"));
}

TEST_CASE("a study and a stability map write their rows") {
    const course::TemporaryFolder folder;
    const std::string out = " --quick --out " + folder.path().string();
    CHECK(course::run_program("ch02_integrators", "--study projectile" + out).exit_code == 0);
    CHECK(std::filesystem::exists(folder.path() / "study_projectile.csv"));
    CHECK(course::run_program("ch02_integrators", "--stability spring" + out).exit_code == 0);
    std::ifstream file(folder.path() / "stability_spring.csv");
    std::string line;
    std::getline(file, line);
    CHECK(line == "stability,method,dt,stiffness,stable,measured_limit,theory_limit");
    int rows = 0;
    for (; std::getline(file, line); ++rows) {
        const std::vector<std::string> cells = split(line);
        CHECK_FALSE(!(std::abs(std::stod(cells[5]) / std::stod(cells[6]) - 1) <=
                      0.011));  // bracketed by 0.99 and 1.01
    }
    CHECK(rows > 30);
}
