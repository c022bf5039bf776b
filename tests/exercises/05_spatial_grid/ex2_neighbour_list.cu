// Exercise 05.2: neighbour lists, against all pairs on the CPU.
#include "ex2_neighbour_list.cuh"

#include <limits>
#include <string>

#include "05_spatial_grid/cloud.h"
#include "tests/support/course_test.h"

namespace {

using Cloud = std::vector<float4>;

// As int, so that a value the stub returns is recognised.
std::vector<int> to_int(const std::vector<std::uint32_t>& values) {
    return std::vector<int>(values.begin(), values.end());
}

void check_lists(const Cloud& cloud, float radius_m) {
    const std::uint32_t n = std::uint32_t(cloud.size());
    const grid::Bounds box = grid::bounds_cpu(cloud);
    const grid::CellGrid cells = grid::make_grid(box.low_m, box.high_m, radius_m, 100000);
    const course::DeviceBuffer<float4> position(cloud);
    course::DeviceBuffer<float4> sorted_position(n);
    grid::CountingSort sort(n, cells.cell_count());
    sort.build(position.data(), cells, n);
    grid::gather_kernel<<<grid::blocks_for(n, 128), 128>>>(sorted_position.data(), position.data(),
                                                           sort.order(), n);
    CUDA_CHECK(cudaGetLastError());
    const grid::NeighbourList list =
        grid::list_neighbours(sorted_position.data(), sort.ranges(), cells, radius_m, n);

    const Cloud sorted = sorted_position.download();
    std::vector<int> first{0};
    std::vector<std::vector<int>> expected(n);
    for (std::uint32_t p = 0; p < n; ++p) {
        for (std::uint32_t q = 0; q < n; ++q)
            if (q != p && grid::is_near(grid::xyz(sorted[p]), grid::xyz(sorted[q]), radius_m * radius_m))
                expected[p].push_back(int(q));
        first.push_back(first.back() + int(expected[p].size()));
    }
    if (!course::check_equal(to_int(list.first.download()), first, "first", "place")) return;
    const std::vector<int> entries = to_int(list.neighbour.download());
    REQUIRE(int(entries.size()) == first.back());
    for (std::uint32_t p = 0; p < n; ++p) {
        const std::vector<int> got(entries.begin() + first[p], entries.begin() + first[p + 1]);
        const std::string what = "list of the particle at place " + std::to_string(p);
        if (!course::check_equal(got, expected[p], what, "entry")) return;  // the first wrong one is enough
    }
}

}  // namespace

TEST_CASE("1500 particles, 30 neighbours each") {
    course::set_seed(7);
    course::set_hint(1);
    check_lists(grid::random_cloud(1500, 7), grid::radius_for_30(1500));
}

TEST_CASE("one particle, and two out of each other's reach: empty lists") {
    course::set_hint(2);
    check_lists({make_float4(1, 2, 3, 0)}, 0.5f);
    check_lists({make_float4(1, 2, 3, 0), make_float4(5, 2, 3, 0)}, 0.5f);
}

TEST_CASE("60 coincident particles among others: each lists the other 59") {
    course::set_seed(8);
    course::set_hint(2);
    Cloud cloud = grid::random_cloud(200, 8);
    cloud.insert(cloud.begin() + 50, 60, make_float4(-0.5f, -0.5f, 0.25f, 0));
    check_lists(cloud, 0.2f);
}

TEST_CASE("particles at NaN have empty lists and are in nobody's") {
    course::set_seed(9);
    course::set_hint(3);
    Cloud cloud = grid::random_cloud(300, 9);
    cloud[17].x = std::numeric_limits<float>::quiet_NaN();
    cloud.back().y = -std::numeric_limits<float>::infinity();
    check_lists(cloud, 0.2f);
}
