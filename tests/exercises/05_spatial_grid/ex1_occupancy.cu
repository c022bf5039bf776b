// Exercise 05.1: occupancy, against a count on the CPU.
#include "ex1_occupancy.cuh"

#include <algorithm>
#include <limits>

#include "05_spatial_grid/cloud.h"
#include "tests/support/course_test.h"

namespace {

using Cloud = std::vector<float4>;

grid::CellGrid grid_around(const Cloud& cloud, float radius_m) {
    const grid::Bounds box = grid::bounds_cpu(cloud);
    return grid::make_grid(box.low_m, box.high_m, radius_m, 100000);
}

grid::Occupancy occupancy_cpu(const Cloud& cloud, const grid::CellGrid& cells) {
    std::vector<int> count(cells.cell_count() + 1);  // with the limbo, which is then left out
    for (const float4& p : cloud) ++count[grid::cell_or_limbo(cells, p)];
    count.pop_back();
    return {*std::max_element(count.begin(), count.end()),
            int(count.size() - std::count(count.begin(), count.end(), 0))};
}

/// Both numbers of every cloud against the CPU.
void check_clouds(const std::vector<Cloud>& clouds, float radius_m) {
    std::vector<int> most, most_expected, occupied, occupied_expected;
    for (const Cloud& cloud : clouds) {
        const grid::CellGrid cells = grid_around(cloud, radius_m);
        const course::DeviceBuffer<float4> position(cloud);
        grid::CountingSort sort(std::uint32_t(cloud.size()), cells.cell_count());
        sort.build(position.data(), cells, std::uint32_t(cloud.size()));
        const grid::Occupancy got = grid::measure_occupancy(sort.ranges(), cells);
        const grid::Occupancy expected = occupancy_cpu(cloud, cells);
        most.push_back(got.most), most_expected.push_back(expected.most);
        occupied.push_back(got.occupied_cells), occupied_expected.push_back(expected.occupied_cells);
    }
    course::check_equal(most, most_expected, "most particles in a cell", "cloud");
    course::check_equal(occupied, occupied_expected, "occupied cells", "cloud");
}

}  // namespace

TEST_CASE("even clouds of 1, 200 and 5000 particles") {
    course::set_seed(3);
    course::set_hint(1);
    check_clouds({grid::random_cloud(1, 3), grid::random_cloud(200, 3), grid::random_cloud(5000, 3)}, 0.1f);
}

TEST_CASE("all particles in one cell") {
    course::set_seed(4);
    course::set_hint(2);
    check_clouds({Cloud(1000, make_float4(-2, 3, 0, 0)), grid::random_cloud(777, 4)}, 2.0f);
}

TEST_CASE("most cells are empty: 300 particles on a diagonal") {
    course::set_hint(2);
    Cloud diagonal;
    for (int k = 0; k < 300; ++k) diagonal.push_back(make_float4(0.01f * k, 0.01f * k, -0.01f * k, 0));
    check_clouds({diagonal}, 0.1f);
}

TEST_CASE("the limbo is no cell: 500 particles at NaN") {
    course::set_seed(5);
    course::set_hint(3);
    Cloud cloud = grid::random_cloud(400, 5);
    cloud.insert(cloud.begin() + 100, 500, make_float4(std::numeric_limits<float>::quiet_NaN(), 0, 0, 0));
    check_clouds({cloud}, 0.2f);
}
