// The report: conclusions from rows whose answer is known, plots, and files that are not what they should be.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "common/report/conclusion.h"
#include "common/report/plot.h"
#include "common/study.h"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"

namespace {

using namespace course::report;

/// error = c t^-order, at `count` times that double.
Line power_law(const std::string& method, double c, double order, double first_s, int count) {
    Line line{method, {}};
    for (int k = 0; k < count; ++k) {
        const double t = first_s * std::pow(2.0, k);
        line.points.push_back({1 / t, 1, c * std::pow(t, -order), t, t, t});
    }
    return line;
}

StudyData study_of(std::vector<Line> lines) {
    return {{"00_test", "s", "Which?", "cpu", "device", false},
            "m",
            "dt_s",
            true,
            false,
            false,
            std::move(lines)};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

bool has_gnuplot() {
    return std::system("gnuplot --version > /dev/null 2>&1") == 0;
}

std::string study_json() {
    course::Study study(
        {"s", "Which \"one\" <is> it?", "m", "dt_s", course::StudyPlot::error_against_time, true}, "00_test",
        false);
    for (int k = 1; k < 5; ++k) {
        study.add({"first", 1.0 / k, 1, 1.0 / k, {1e-3, 9e-4, 2e-3, 5}, double(k)});
        study.add(
            {"second, float", 1.0 / k, 1, k == 1 ? NAN : 0.1 / (k * k), {2e-3, 1e-3, 2e-3, 5}, double(k)});
    }
    return study.json();
}

std::string map_json() {
    course::StabilityMap map({"map", "Which?", "bounded", "2 / k", "k (1/s)"}, "00_test", false);
    for (double k : {0.0, 1.0, 100.0})
        map.column("m", k, 2 / (k + 1), {0.5, 1, 2}, 3, [&](double dt) { return dt * (k + 1) < 1.9; });
    return map.json();
}

}  // namespace

TEST_CASE("the time for an error lies on the line between measured points") {
    const Line line = power_law("m", 1, 2, 1, 6);  // error = t^-2 for t = 1 ... 32
    CHECK(std::abs(seconds_for_error(line, 1e-2) - 10) < 1e-9);
    CHECK(seconds_for_error(line, 5) == 1);            // its fastest run is better than that
    CHECK(std::isinf(seconds_for_error(line, 1e-4)));  // never extrapolated
    Line noisy = line;
    noisy.points.push_back({1, 1, 0.5, 64, 64, 64});  // slower and worse: it changes nothing
    noisy.points.push_back({1, 1, INFINITY, 0.5, 0.5, 0.5});
    CHECK(std::abs(seconds_for_error(noisy, 1e-2) - 10) < 1e-9);
}

TEST_CASE("the conclusion names the winner, by how much, and where another one wins") {
    // Error t^-1 against 100 t^-4: they cross at t = 100^(1/3), error 0.2.
    const std::string text =
        conclusion(study_of({power_law("Euler", 1, 1, 1, 14), power_law("RK4", 100, 4, 1, 8)}));
    CHECK(contains(text, "For an error of 1e-3, RK4 is the cheapest, 56 times cheaper than Euler."));
    CHECK(contains(text, "The cheapest, by error: 1e2 to 1: Euler; 1e-1 to 1e-6: RK4."));
    // t = 1 / error, or the 1 s of its first run, against (100 / error)^(1/4).
    CHECK(contains(text,
                   "for at most that error: 1.0 at 1e2, 0.7 at 30, 0.6 at 1e1, 0.4 at 3, 0.3 at 1, 0.8 at "
                   "0.3, 1.8 at 1e-1, 4.4 at 0.03, 10 at 1e-2"));
    CHECK(contains(text, "Only RK4 gets to 1e-6."));
    CHECK(!contains(text, "worse again"));
}

TEST_CASE("methods that are equal within the noise are called equal") {
    const std::string text =
        conclusion(study_of({power_law("a", 1, 1, 1, 10), power_law("b", 1.05, 1, 1, 10)}));
    CHECK(contains(text, "a and b are the cheapest and about equal"));
}

TEST_CASE("a floor is named: more time, more error") {
    Line line = power_law("float", 1, 2, 1, 5);
    line.points.push_back({1, 1, 0.1, 1000, 1000, 1000});
    CHECK(contains(conclusion(study_of({line, power_law("double", 1, 2, 2, 5)})),
                   "more time makes it worse again: float (0.003906)."));
}

TEST_CASE("a study of cost names the growth and the fastest at the largest") {
    StudyData study = study_of({});
    study.error_against_time = false;
    study.parameter = "n";
    for (const double power : {1.0, 2.0}) {
        Line line{power == 1 ? "grid" : "brute force", {}};
        for (double n : {1000.0, 10000.0, 100000.0})
            line.points.push_back({n, n, 0, 1e-9 * std::pow(n, power), 0, 0});
        study.lines.push_back(line);
    }
    const std::string text = conclusion(study);
    CHECK(contains(text, "At n = 100000, grid is the fastest, 100000 times faster than brute force."));
    CHECK(contains(text, "Time grows as n to the power 1.00 (grid) and 2.00 (brute force)."));
    CHECK(contains(text, "Largest error: 0."));
}

TEST_CASE("parts of a method are added up before it is compared") {
    StudyData study = study_of({});
    study.error_against_time = false;
    study.parameter = "n";
    const auto line = [](const std::string& method, double s) {
        return Line{method, {{10, 10, 0, s, s, s}, {20, 20, 0, 2 * s, 2 * s, 2 * s}}};
    };
    study.lines = {line("grid: build", 1), line("grid: query", 2), line("brute force", 2)};
    CHECK(contains(conclusion(study),
                   "At n = 20, brute force is the fastest, 1.5 times faster than grid (parts added up)."));
}

TEST_CASE("cases are not compared with each other, methods within a case are") {
    StudyData study = study_of({power_law("wave", 1, 2, 1, 5), power_law("splash, Euler", 1, 1, 1, 5),
                                power_law("splash, RK4", 1, 4, 1, 5)});
    study.lines_are_cases = true;
    const std::string text = conclusion(study);
    CHECK(contains(text,
                   "Wave: From an error of 1 in 1 s to 0.003906 in 16 s: the error falls as the time to the "
                   "power -2.00."));
    CHECK(contains(text, "Splash: For an error of 1e-1, RK4 is the cheapest, 5.6 times cheaper than Euler."));
    CHECK(!contains(text, "than wave"));
    // From 1 s to 1.2 s a power of the time would be noise.
    study.lines = {{"wave", {{1, 1, 1, 1, 1, 1}, {2, 1, 0.01, 1.2, 1.2, 1.2}}}};
    CHECK(contains(conclusion(study), "the error falls and the time hardly grows."));
}

TEST_CASE("where each value is another problem, methods are compared at the largest") {
    const auto line = [](const std::string& method, double seconds, double error) {
        return Line{method, {{10, 10, 1e-9, 1e-6, 1e-6, 1e-6}, {20, 20, error, seconds, seconds, seconds}}};
    };
    StudyData study = study_of({line("naive", 2, 0.5), line("tree", 1, 0.1), line("Kahan", 4, 0.01)});
    study.parameter = "n";
    study.values_are_problems = true;
    CHECK(conclusion(study) ==
          "At n = 20, each of these is the cheapest for its error: tree (1 s, error 0.1); Kahan (4 s, error "
          "0.01). "
          "Slower and no more exact than one of them: naive (2 s, error 0.5).");
}

TEST_CASE("methods with the same limits share a sentence") {
    StabilityData data;
    for (const char* method : {"a", "b", "c"})
        data.maps.push_back({method, {{1, *method == 'c' ? 0.5 : 1.0, 1, {{1, true}}}}});
    data.stiffness = "k";
    CHECK(conclusion(data) ==
          "a and b: the measured limit is 1.00 of the theory's. c: the measured limit is 0.50 of the "
          "theory's: at k = 1 the theory promises too much. ");
}

TEST_CASE("a conclusion on stability compares with the theory, also where nothing was unstable") {
    course::TemporaryFolder folder;
    std::ofstream(folder.path() / "map.json") << map_json();
    StabilityData data = load_stability(folder.path() / "map.json");
    CHECK(contains(conclusion(data), "m: the measured limit is 0.9"));
    CHECK(contains(conclusion(data), "promises too much"));
    for (Column& column : data.maps[0].columns) column.measured_limit = INFINITY;
    CHECK(contains(conclusion(data), "Nothing was unstable in 3 of 3 columns, up to 2 times"));
}

TEST_CASE("what a study writes, the report reads") {
    course::TemporaryFolder folder;
    std::ofstream(folder.path() / "s.json") << study_json();
    const StudyData study = load_study(folder.path() / "s.json");
    REQUIRE(study.lines.size() == 2);
    CHECK(study.lines[0].method == "first");
    CHECK(study.lines[0].points.size() == 4);
    CHECK(study.lines[0].points[2].seconds == 3 * 1e-3);  // steps times seconds per step
    CHECK(std::isinf(study.lines[1].points[0].error));
    CHECK(study.error_against_time);
    CHECK(study.lines_are_cases);
    CHECK(study.origin.question == "Which \"one\" <is> it?");
    CHECK_THROWS(load_stability(folder.path() / "s.json"));
}

TEST_CASE("gnuplot draws studies and maps as SVG and PNG") {
    if (!has_gnuplot()) course::skip("gnuplot is not installed (Debian: gnuplot-nox)");
    course::TemporaryFolder folder;
    const auto chapter = folder.path() / "report" / "00_test";
    std::filesystem::create_directories(chapter);
    std::ofstream(chapter / "study_s.json") << study_json();
    std::ofstream(chapter / "stability_map.json") << map_json();
    const auto page = folder.path() / "report.html";
    const course::ProgramRun run = course::run_program(
        "course_report", "'" + (folder.path() / "report").string() + "' '" + page.string() + "'");
    CHECK(run.output == "");  // gnuplot has nothing to warn of
    CHECK(run.exit_code == 0);
    for (const char* name : {"study_s.svg", "study_s.png", "stability_map.svg", "stability_map.png"})
        CHECK(std::filesystem::file_size(chapter / name) > 2000);
    std::ifstream file(page);
    const std::string html{std::istreambuf_iterator<char>(file), {}};
    CHECK(contains(html, "src=\"report/00_test/study_s.svg\""));
    CHECK(contains(html, "Which &quot;one&quot; &lt;is&gt; it?"));
    CHECK(contains(html, "<td>unstable</td>"));
    CHECK(contains(html, "<code>./course run 00 --study s</code>"));
    CHECK(contains(html, "<code>./course run 00 --stability map</code>"));
}

TEST_CASE("a damaged file is named and left out, the others are shown") {
    if (!has_gnuplot()) course::skip("gnuplot is not installed (Debian: gnuplot-nox)");
    course::TemporaryFolder folder;
    const auto chapter = folder.path() / "00_test";
    std::filesystem::create_directories(chapter);
    std::ofstream(chapter / "study_good.json") << study_json();
    std::ofstream(chapter / "study_torn.json") << study_json().substr(0, 200);
    std::ofstream(chapter / "study_empty.json") << R"({"kind": "study", "rows": []})";
    const auto page = folder.path() / "page.html";
    const course::ProgramRun run =
        course::run_program("course_report", "'" + folder.path().string() + "' '" + page.string() + "'");
    CHECK(run.exit_code == 2);
    CHECK(contains(run.output, "left out"));
    CHECK(contains(run.output, "study_torn.json"));
    CHECK(contains(run.output, "study_empty.json"));
    CHECK(std::filesystem::exists(chapter / "study_good.svg"));
    CHECK(std::filesystem::exists(page));
}

TEST_CASE("a folder without measurements is a clear error and no page") {
    course::TemporaryFolder folder;
    const auto page = folder.path() / "page.html";
    const course::ProgramRun run =
        course::run_program("course_report", "'" + folder.path().string() + "' '" + page.string() + "'");
    CHECK(run.exit_code == 2);
    CHECK(contains(run.output, "no study and no stability map in"));
    CHECK(!std::filesystem::exists(page));
}
