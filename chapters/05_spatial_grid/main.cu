// Chapter 05: neighbours by brute force and over the grid, in three steps; time against the number of
// particles.
#include "05_spatial_grid/costs.h"
#include "05_spatial_grid/crowding.cuh"
#include "05_spatial_grid/measure.cuh"
#include "05_spatial_grid/pictures.h"
#include "common/program.h"

using namespace grid;

namespace {

constexpr int kRepeats = 5;         // medians of so many runs
constexpr int kFirstExponent = 12;  // the smallest cloud measured: 2^12 particles
constexpr std::uint32_t kCrowd = 1u << 14;

CellGrid grid_of(const std::vector<float4>& position, float radius_m) {
    const course::DeviceBuffer<float4> x(position);
    const Bounds box = find_bounds(x.data(), std::uint32_t(position.size()));
    return make_grid(box.low_m, box.high_m, radius_m, max_cells_for(position.size()));
}

void explain(std::uint32_t n, std::uint64_t seed) {
    const CellGrid cells = grid_of(random_cloud(n, seed), radius_for_30(n));
    std::printf("%u particles, radius %.4g m, %d x %d x %d cells of %.4g m\n", n, radius_for_30(n),
                cells.size.x, cells.size.y, cells.size.z, 1 / cells.cells_per_m);
    const auto print_passes = [](const char* when, const std::vector<std::string>& passes) {
        std::printf("  %s, %zu %s", when, passes.size(), passes.size() == 1 ? "pass" : "passes");
        for (std::size_t k = 0; k < passes.size(); ++k)
            std::printf("%s%s", k == 0 ? ": " : ", ", passes[k].c_str());
        std::printf("\n");
    };
    for (const Cost& cost : costs(n, cells.cell_count())) {
        std::printf("%s: %.1f bytes a particle\n", cost.method.c_str(), double(cost.bytes) / n);
        print_passes("build", cost.build);
        print_passes("query", cost.query);
    }
    std::printf(
        "Left out: no velocities and no time step, nothing moves; no lists of neighbours, they are only "
        "counted.\n");
}

/// The search of the particle nearest to the middle of the cube.
Search search_in_the_middle(std::uint32_t n, std::uint64_t seed) {
    Search s;
    s.position = random_cloud(n, seed);
    s.radius_m = radius_for_30(n);
    s.cells = grid_of(s.position, s.radius_m);
    const auto off_centre = [&](std::uint32_t i) { return glm::length(xyz(s.position[i]) - 0.5f); };
    for (std::uint32_t i = 0; i < n; ++i)
        if (off_centre(i) < off_centre(s.centre)) s.centre = i;

    const course::DeviceBuffer<float4> x(s.position);
    CountingSort sort(n, s.cells.cell_count());
    sort.build(x.data(), s.cells, n);
    std::vector<std::uint32_t> order(n), cell_first(s.cells.cell_count() + 1);
    CUDA_CHECK(cudaMemcpy(order.data(), sort.order(), n * sizeof order[0], cudaMemcpyDeviceToHost));
    CUDA_CHECK(cudaMemcpy(cell_first.data(), sort.ranges().cell_first,
                          cell_first.size() * sizeof cell_first[0], cudaMemcpyDeviceToHost));

    double candidates = 0, neighbours = 0;
    for (std::uint32_t i = 0; i < n; ++i)
        for_each_row(s.cells, xyz(s.position[i]), [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            for (std::uint32_t k = cell_first[first_cell]; k < cell_first[last_cell + 1]; ++k) {
                const std::uint32_t j = order[k];
                if (j == i) continue;
                const bool near = is_near(xyz(s.position[i]), xyz(s.position[j]), s.radius_m * s.radius_m);
                ++candidates;
                neighbours += near;
                if (i == s.centre) s.candidates.push_back(j);
                if (i == s.centre && near) s.neighbours.push_back(j);
            }
        });
    s.share = candidates > 0 ? neighbours / candidates : 0;
    return s;
}

std::vector<Measurement> measure_all(int last_exponent, std::uint64_t seed) {
    std::vector<Measurement> rows;
    course::Progress progress("measuring", last_exponent - kFirstExponent + 1);
    for (int exponent = kFirstExponent; exponent <= last_exponent; ++exponent) {
        rows.push_back(measure(1u << exponent, seed, kRepeats));
        progress.update(exponent - kFirstExponent + 1);
    }
    return rows;
}

course::Table table_of(const std::vector<Measurement>& rows) {
    course::Table table("Milliseconds, medians of " + std::to_string(kRepeats) +
                            " runs. Brute force was asked for 'asked' particles and its time scaled to all.",
                        {"particles", "neighbours", "asked", "brute force", "bounds", "sort: build", "query",
                         "count: build", "query", "reorder: build", "query"});
    for (const Measurement& m : rows)
        table.row({m.n, m.neighbours_each, m.asked, m.brute_force.query_ms, m.bounds_ms,
                   m.sorted_grid.build_ms, m.sorted_grid.query_ms, m.counting_sort.build_ms,
                   m.counting_sort.query_ms, m.reordered.build_ms, m.reordered.query_ms});
    return table;
}

course::Table crowding_table(std::uint64_t seed) {
    const float radius_m = radius_for_30(kCrowd);
    course::Table table(
        "Where it breaks: " + std::to_string(kCrowd) + " particles, ever more crowded (reordered search, ms)",
        {"cloud", "cells", "fullest cell", "candidates", "neighbours", "build", "query"});
    for (const Crowd& crowd : crowds(kCrowd, seed, radius_m)) {
        const CrowdTimes t = measure_crowd(crowd.position, radius_m, kRepeats);
        table.row(
            {crowd.name, t.cells, t.fullest, t.candidates_each, t.neighbours_each, t.build_ms, t.query_ms});
    }
    return table;
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "05_spatial_grid", "A spatial grid",
        "Who is near whom: brute force, and a grid that looks at 27 cells instead of everybody");
    program.options.particles = 4096;
    int last_exponent = 19;
    program.option("--max-exponent", last_exponent, "measure up to 2^this particles (12 to 24)");
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& o = program.options;
        if (o.window) throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
        if (last_exponent < kFirstExponent || last_exponent > 24)
            throw course::BadInput("--max-exponent must be from 12 to 24, not " +
                                   std::to_string(last_exponent));
        if (o.particles > 1u << 24)
            throw course::BadInput("--particles must be from 1 to 16777216 in this chapter, not " +
                                   std::to_string(o.particles));
        if (o.explain) return explain(o.particles, o.seed);

        course::Result& result = program.result();
        result.device = course::device_name();
        const Search search = search_in_the_middle(o.particles, o.seed);
        course::save_png(o.out / "search.png", draw_search(search, o.width, o.height));
        result.picture("search.png",
                       "One particle's search: its cells, the candidates in them, its neighbours");
        const std::vector<Measurement> rows = measure_all(last_exponent, o.seed);
        course::save_png(o.out / "times.png", draw_times(rows, result.device, o.width, o.height));
        result.picture("times.png", "Time against the number of particles, one line per method");
        result.table(table_of(rows));
        result.table(crowding_table(o.seed));
        result.note("The four methods find the same neighbours for every particle asked: the error is 0.");
        result.note(result.device.find("simulator") == std::string::npos
                        ? "Measured on: " + result.device + "."
                        : "Times of the CUDA simulator, on the CPU: they compare these methods here and say "
                          "nothing about a GPU.");
    });
}
