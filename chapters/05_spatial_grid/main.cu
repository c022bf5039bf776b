// Chapter 05: neighbours by brute force and over the grid, in four steps. What they cost is measured by its
// studies.
#include "05_spatial_grid/costs.h"
#include "05_spatial_grid/pictures.h"
#include "05_spatial_grid/studies.cuh"
#include "common/program.h"

using namespace grid;

namespace {

constexpr std::uint32_t kCrowd = 1u << 14;
constexpr const char* kWrongCounts =
    "particles whose number of neighbours is not brute force's (0: all are exact)";

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

/// Runs all methods on the cloud. @throws std::runtime_error if two of them disagree
std::vector<std::uint32_t> neighbours_by_all_methods(Cloud& cloud) {
    std::vector<std::uint32_t> reference, counts;
    for (const Method& method : methods(cloud)) {
        method.build();
        method.query();
        counts = method.counts();
        if (reference.empty()) reference = counts;
        check_same(counts, reference, method.name);
    }
    return counts;
}

course::Table methods_table(std::uint32_t n, const CellGrid& cells) {
    course::Table table("What each method launches and stores, for " + std::to_string(n) + " particles",
                        {"method", "kernels to build", "to query", "bytes a particle"});
    for (const Cost& cost : costs(n, cells.cell_count()))
        table.row({cost.method, cost.build.size(), cost.query.size(), double(cost.bytes) / n});
    return table;
}

course::Table crowding_table(std::uint64_t seed) {
    const float radius_m = radius_for_30(kCrowd);
    course::Table table("Where it breaks: " + std::to_string(kCrowd) + " particles, ever more crowded",
                        {"cloud", "cells", "fullest cell", "candidates each", "neighbours each"});
    for (const Crowd& crowd : crowds(kCrowd, seed, radius_m)) {
        Cloud cloud(crowd.position, radius_m);
        const Crowding c = crowding_of(crowd.position, cloud.cells, neighbours_by_all_methods(cloud));
        table.row({crowd.name, cloud.cells.cell_count(), c.fullest, c.candidates_each, c.neighbours_each});
    }
    return table;
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "05_spatial_grid", "A spatial grid",
        "Who is near whom: brute force, and a grid that looks at 27 cells instead of everybody");
    program.options.particles = 4096;
    program.study({"neighbours", "How does each method's time grow with the number of particles?",
                   kWrongCounts, "n", course::StudyPlot::time_against_value},
                  study_neighbours);
    program.study({"occupancy", "What does it cost when particles crowd into few cells?", kWrongCounts,
                   "particles_in_fullest_cell", course::StudyPlot::time_against_value},
                  study_occupancy);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& o = program.options;
        if (o.window) throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
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
        Cloud cloud(search.position, search.radius_m);
        neighbours_by_all_methods(cloud);
        result.table(methods_table(o.particles, cloud.cells));
        result.table(crowding_table(o.seed));
        result.note("The five methods find the same neighbours for every particle asked: the error is 0.");
        result.note("Times: ./course run 05 --study neighbours, and --study occupancy.");
    });
}
