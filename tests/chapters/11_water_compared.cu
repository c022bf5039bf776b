// Chapter 11: what is counted is right, what is kept comes back, and an interrupted experiment goes on.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "11_water_compared/answers.h"
#include "11_water_compared/experiment.cuh"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

using namespace compared;

std::vector<float4> random_cloud(int n, float edge_m, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(0, edge_m);
    std::vector<float4> cloud;
    for (int i = 0; i < n; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        cloud.push_back(make_float4(x, y, z, 0));
    }
    return cloud;
}

/// Counted by looking at every pair; the fullest cell by putting each particle into its cell.
Crowd crowd_cpu(const std::vector<float4>& position, float radius_m, const grid::CellGrid& cells) {
    Crowd crowd;
    const std::vector<std::uint32_t> neighbours = grid::count_neighbours_cpu(position, radius_m);
    for (const std::uint32_t count : neighbours) {
        crowd.mean_neighbours += double(count) / double(position.size());
        crowd.most_neighbours = std::max(crowd.most_neighbours, count);
    }
    std::vector<std::uint32_t> in_cell(cells.cell_count(), 0);
    for (const float4& p : position)
        crowd.fullest_cell = std::max(
            crowd.fullest_cell, ++in_cell[grid::cell_number(cells, grid::cell_of(cells, grid::xyz(p)))]);
    return crowd;
}

void check_crowd(const std::vector<float4>& position, float radius_m) {
    const std::uint32_t n = std::uint32_t(position.size());
    CrowdCounter count(n, glm::vec3(0), glm::vec3(1), radius_m);
    const course::DeviceBuffer<float4> on_device(position);
    const Crowd got = count(on_device.data(), n);
    const Crowd expected = crowd_cpu(
        position, radius_m, grid::make_grid(glm::vec3(0), glm::vec3(1), radius_m, grid::max_cells_for(n)));
    CAPTURE(n);
    CHECK(std::fabs(got.mean_neighbours - expected.mean_neighbours) <= 1e-12 * n);  // sums of integers
    CHECK(got.most_neighbours == expected.most_neighbours);
    CHECK(got.fullest_cell == expected.fullest_cell);
}

RunPlan small_plan(Model model, int steps = 20) {
    RunPlan plan;
    plan.model = model;
    plan.exponent = 8;
    plan.steps = steps;
    plan.samples = 4;
    return plan;
}

RunRecord some_record() {
    RunRecord record;
    record.plan = small_plan(Model::spring_mass);
    record.device = "this one";
    record.dt_s = 1e-4;
    record.seconds_per_step = 0.0123;
    record.passes = {{"list", 0.001}, {"contacts", 0.002}};
    record.samples = {{5, 0.01, 27.5, 40, 12, 1.25, 0.4}, {10, 0.02, 28.5, 41, 13, 1.5, 0.3}};
    return record;
}

course::ProgramRun run(const std::string& arguments, const std::string& environment = "") {
    return course::run_program("ch11_water_compared", arguments, environment);
}

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("crossings of power laws are where the laws say") {
    const std::vector<double> n = {16384, 32768, 65536, 131072};
    std::vector<double> linear, steeper;
    for (const double x : n) {
        linear.push_back(x / 50000);
        steeper.push_back(std::pow(x / 50000, 1.3));
    }
    REQUIRE(crossings(n, linear, steeper).size() == 1);
    CHECK(crossings(n, linear, steeper)[0] == doctest::Approx(50000).epsilon(1e-9));
    CHECK(crossings(n, linear, linear).empty());
    CHECK(crossings({}, {}, {}).empty());
    CHECK(growth_exponent(n, steeper) == doctest::Approx(1.3).epsilon(1e-9));
}

TEST_CASE("a line is found again, and how much of the variation it explains") {
    const LineFit exact = fit_line({1, 2, 3, 4}, {5, 7, 9, 11});
    CHECK(exact.intercept == doctest::Approx(3));
    CHECK(exact.slope == doctest::Approx(2));
    CHECK(exact.explained == doctest::Approx(1));
    CHECK(fit_line({1, 2, 3}, {4, 4, 4}).explained == 0);  // nothing varies, so nothing is explained
    CHECK(fit_line({2, 2, 2}, {1, 5, 3}).explained == 0);
    // By hand: slope 3/5, R^2 = (sum of products)^2 / (5 x 2.5) = 9 / 12.5.
    CHECK(fit_line({0, 1, 2, 3}, {0.25, 0.25, 2.25, 1.25}).slope == doctest::Approx(0.5));
}

TEST_CASE("neighbours and cells are counted as by looking at every pair") {
    course::set_seed(3);
    check_crowd(random_cloud(3000, 1, 3), 0.11f);
    check_crowd(random_cloud(700, 0.08f, 4), 0.1f);  // all in one cell
    check_crowd(random_cloud(1, 1, 5), 0.1f);
    check_crowd(std::vector<float4>(50, make_float4(0.5f, 0.5f, 0.5f, 0)), 0.1f);  // all at one point
}

TEST_CASE("both models start from the same places, at rest, and none finds itself without partners") {
    std::set<std::array<float, 3>> places[2];
    for (const Model model : {Model::spring_mass, Model::sph}) {
        RunPlan plan = small_plan(model);
        plan.exponent = 10;
        const auto contestant = make_contestant(plan, from_the_middle());
        REQUIRE(contestant->size() == 1024);
        std::vector<float4> x(1024), v(1024);
        CUDA_CHECK(
            cudaMemcpy(x.data(), contestant->position(), 1024 * sizeof(float4), cudaMemcpyDeviceToHost));
        CUDA_CHECK(
            cudaMemcpy(v.data(), contestant->velocity(), 1024 * sizeof(float4), cudaMemcpyDeviceToHost));
        for (std::size_t i = 0; i < 1024; ++i) {
            places[model == Model::sph].insert({x[i].x, x[i].y, x[i].z});
            CHECK(v[i].x * v[i].x + v[i].y * v[i].y + v[i].z * v[i].z == 0);
        }
    }
    CHECK(places[0].size() == 1024);
    CHECK(places[0] == places[1]);
}

TEST_CASE("in the first steps both models fall freely") {
    for (const Model model : {Model::spring_mass, Model::sph}) {
        const RunRecord record = measure(small_plan(model, 12), from_the_middle(), [](int) {});
        REQUIRE(record.samples.size() == 4);
        const double t0 = record.samples[0].step * record.dt_s, t1 = record.samples[3].step * record.dt_s;
        const double fallen = record.samples[0].mean_height_m - record.samples[3].mean_height_m;
        // Forces between particles move nobody on average; heights are sums of floats near 0.5 m, and the
        // marbles or the water exchange nothing with the walls yet.
        CHECK(std::fabs(fallen - 0.5 * 9.81 * (t1 * t1 - t0 * t0)) <= 1e-6);
        CHECK(record.samples.back().step == 12);
        CHECK(record.seconds_per_step > 0);
    }
}

TEST_CASE("a pass has a name and a time, and together they are about a step") {
    for (const Model model : {Model::spring_mass, Model::sph}) {
        RunPlan plan = small_plan(model, 40);
        plan.exponent = 11;
        const RunRecord record = measure(plan, from_the_middle(), [](int) {});
        REQUIRE(record.passes.size() >= 2);
        double sum = 0;
        std::set<std::string> names;
        for (const auto& [name, seconds] : record.passes) {
            CHECK(seconds >= 0);
            sum += seconds;
            names.insert(name);
        }
        CHECK(names.size() == record.passes.size());
        CHECK(names.count(model == Model::sph ? "forces" : "contacts") == 1);
        // The machine may do other things in between: this only says that nothing large was forgotten.
        CHECK(sum > 0.1 * record.seconds_per_step);
    }
}

#ifdef __CUDASIM__
TEST_CASE("looks at the crowd happen at samples alone; the rest are the models' own kernels") {
    for (const Model model : {Model::spring_mass, Model::sph}) {
        cudasim::Recording recording;
        measure(small_plan(model, 20), from_the_middle(), [](int) {});
        CHECK(recording.count("grid::neighbours_coherent_kernel") == 2 * 4);
        CHECK(recording.count("kick_drift_kernel") == 20);
        CHECK(recording.count(model == Model::sph ? "contact_kernel" : "force_kernel") == 0);
    }
}
#endif

TEST_CASE("a record comes back as it was saved") {
    const course::TemporaryFolder folder;
    const RunRecord saved = some_record();
    save(folder.path(), saved);
    RunRecord loaded;
    REQUIRE(load(folder.path(), saved.plan, saved.device, loaded));
    CHECK(loaded.seconds_per_step == saved.seconds_per_step);
    CHECK(loaded.dt_s == saved.dt_s);
    CHECK(loaded.passes == saved.passes);
    REQUIRE(loaded.samples.size() == 2);
    CHECK(loaded.samples[1].step == 10);
    CHECK(loaded.samples[1].seconds == 0.02);
    CHECK(loaded.samples[1].mean_neighbours == 28.5);
    CHECK(loaded.samples[1].most_neighbours == 41);
    CHECK(loaded.samples[1].fullest_cell == 13);
    CHECK(loaded.samples[1].mean_partners == 1.5);
    CHECK(loaded.samples[1].mean_height_m == 0.3);
}

TEST_CASE("a run of another experiment is not taken for this one") {
    const course::TemporaryFolder folder;
    const RunRecord saved = some_record();
    save(folder.path(), saved);
    RunRecord loaded;
    CHECK(!load(folder.path(), saved.plan, "another device", loaded));
    RunPlan plan = saved.plan;
    plan.steps = 21;
    CHECK(!load(folder.path(), plan, saved.device, loaded));
    plan = saved.plan;
    plan.seed = 2;
    CHECK(!load(folder.path(), plan, saved.device, loaded));
    plan = saved.plan;
    plan.run = 1;
    CHECK(!load(folder.path(), plan, saved.device, loaded));
}

TEST_CASE("a file that is no record is named, not overwritten") {
    const course::TemporaryFolder folder;
    const RunRecord saved = some_record();
    for (const char* text : {"", "{", "[1, 2]", "{\"plan\": 3}"}) {
        course::write_file(file_of(folder.path(), saved.plan), text);
        RunRecord loaded;
        try {
            const bool done = load(folder.path(), saved.plan, saved.device, loaded);
            CHECK(!done);  // valid JSON of another plan
        } catch (const course::BadInput& error) {
            CHECK(std::string(error.what()).find("spring_mass_2e8") != std::string::npos);
        }
        CHECK(text_of(file_of(folder.path(), saved.plan)) == text);
    }
}

TEST_CASE("the answers follow from the records") {
    std::vector<RunRecord> records;
    for (const int exponent : {14, 15, 16, 17})
        for (const Model model : {Model::spring_mass, Model::sph}) {
            RunRecord r = some_record();
            r.plan.model = model;
            r.plan.exponent = exponent;
            const double n = double(1u << exponent);
            r.seconds_per_step = model == Model::sph ? n * 2e-7 : n * 2e-7 * std::pow(n / 65536, 0.5);
            records.push_back(r);
        }
    CHECK(answer_crossover(records).find("Crossover at 2^16 particles") != std::string::npos);
    for (RunRecord& r : records)
        if (r.plan.model == Model::sph) r.seconds_per_step *= 100;
    CHECK(answer_crossover(records).find("No crossover: a step of spring-mass is cheaper") !=
          std::string::npos);
    CHECK(answer_crossover({}).find("No size") != std::string::npos);

    RunRecord crowded = some_record();
    crowded.samples.clear();
    for (int k = 0; k < 30; ++k) crowded.samples.push_back({k + 1, 1e-3 * (2 + k), 27, 40, 12, 0.5 * k, 0.4});
    CHECK(answer_crowding({crowded}).find("interactions explain 100 %") != std::string::npos);
    CHECK(answer_crowding({}) == "Too few samples to say.");
}

TEST_CASE("an experiment that was interrupted goes on where it stopped") {
    const course::TemporaryFolder folder;
    const std::string arguments = "--min-exponent 6 --max-exponent 7 --runs 2 --steps 8 --draw none --out '" +
                                  folder.path().string() + "'";
    const course::ProgramRun first = run(arguments);
    REQUIRE(first.exit_code == 0);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "runs"))
        files.push_back(entry.path());
    REQUIRE(files.size() == 8);
    std::sort(files.begin(), files.end());
    std::vector<std::string> before;
    for (const auto& file : files) before.push_back(text_of(file));
    std::filesystem::remove(files[3]);
    const course::ProgramRun second = run(arguments);
    CHECK(second.exit_code == 0);
    CHECK(second.output.find("7 of 8 runs were done before") != std::string::npos);
    for (std::size_t k = 0; k < files.size(); ++k) {
        REQUIRE(std::filesystem::exists(files[k]));
        if (k != 3) CHECK(text_of(files[k]) == before[k]);
    }
}

TEST_CASE("one seed gives the same crowd, whatever the number of threads") {
    std::string looks[2];
    for (int k = 0; k < 2; ++k) {
        const course::TemporaryFolder folder;
        const course::ProgramRun result =
            run("--min-exponent 9 --max-exponent 9 --runs 1 --steps 60 --draw none --out '" +
                    folder.path().string() + "'",
                k ? "CUDASIM_THREADS=1" : "CUDASIM_THREADS=3");
        REQUIRE(result.exit_code == 0);
        for (const Model model : {Model::spring_mass, Model::sph}) {
            RunPlan plan;
            plan.model = model;
            plan.exponent = 9;
            nlohmann::json json = nlohmann::json::parse(text_of(file_of(folder.path() / "runs", plan)));
            for (auto& sample : json["samples"]) sample.erase("seconds");
            looks[k] += json["samples"].dump();
        }
    }
    CHECK(looks[0] == looks[1]);
}

TEST_CASE("bad input is a sentence and exit code 2; a step that is too long is exit code 3") {
    const course::TemporaryFolder folder;
    const std::string out = " --draw none --out '" + folder.path().string() + "'";
    for (const char* wrong : {"--min-exponent 15 --max-exponent 14", "--max-exponent 25", "--min-exponent 5",
                              "--runs -1", "--steps 1", "--dt 0.001", "--samples 0", "--stiffness 0",
                              "--stiffness nan", "--dt-factor -1", "--draw cubes", "--scene nosuch"}) {
        CAPTURE(wrong);
        const course::ProgramRun result = run(wrong + out);
        CHECK(result.exit_code == 2);
        CHECK(!result.output.empty());
    }
    const course::ProgramRun unstable =
        run("--min-exponent 8 --max-exponent 8 --runs 1 --steps 400 --dt-factor 30" + out);
    CHECK(unstable.exit_code == 3);
    CHECK(unstable.output.find("dt ") != std::string::npos);
}

TEST_CASE("--explain says what is measured, and what is left out") {
    const course::ProgramRun result =
        run("--explain --min-exponent 14 --max-exponent 16 --runs 5 --steps 100 --draw none");
    CHECK(result.exit_code == 0);
    CHECK(result.output.find("30 runs of 100 steps, 2^14 to 2^16 particles") != std::string::npos);
    CHECK(result.output.find("left out: OpenGL") != std::string::npos);
}
