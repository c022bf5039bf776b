// Exercise 08.2: the curl of linear flows, which differences give exactly, and of a grid's rim.
#include "ex2_vorticity_grid.cuh"

#include <cmath>

#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

using namespace vortex;
using Points = std::vector<float4>;

/// u = m x at the centre of every cell; w is not to be read.
template <class Flow>
Points at_centres(const CellGrid& cells, Flow flow) {
    Points field;
    for (std::uint32_t c = 0; c < cells.cell_count(); ++c) {
        const glm::vec3 u = flow(centre_m(cells, cell_at(cells.size, c)));
        field.push_back(make_float4(u.x, u.y, u.z, 1e9f));
    }
    return field;
}

Points vorticity(const CellGrid& cells, const Points& host_field) {
    const course::DeviceBuffer<float4> field(host_field);
    course::DeviceBuffer<float4> result(host_field.size());
    const std::uint32_t threads = 32;  // the last block is not full
    vorticity_kernel<<<(cells.cell_count() + threads) / threads, threads>>>(result.data(), field.data(),
                                                                            cells);
    CUDA_CHECK(cudaGetLastError());
    return result.download();
}

float4 with_length(glm::vec3 v) {
    return make_float4(v.x, v.y, v.z, glm::length(v));
}

}  // namespace

TEST_CASE("a wheel: twice its turn rate in every cell, the rim as well") {
    course::set_hint(3);
    const CellGrid cells{glm::vec3(-1, 0.5f, -2), 4.0f, glm::ivec3(5, 4, 3)};
    const glm::vec3 turn(0.5f, -1.5f, 2);
    const Points field = at_centres(cells, [&](glm::vec3 x) { return glm::cross(turn, x); });
    // Velocities up to 6 m/s, rounded to 4e-7, over an edge of 1/4 m.
    course::check_close(vorticity(cells, field), Points(field.size(), with_length(2.0f * turn)), {2e-5},
                        "vorticity", "cell");
}

TEST_CASE("strain without spin: no vorticity") {
    course::set_hint(3);
    const CellGrid cells{glm::vec3(0), 2.0f, glm::ivec3(3, 5, 4)};
    const Points field = at_centres(
        cells, [](glm::vec3 x) { return glm::vec3(x.x + 2 * x.y - x.z, 2 * x.x - 3 * x.y, -x.x + 2 * x.z); });
    course::check_close(vorticity(cells, field), Points(field.size(), with_length(glm::vec3(0))), {2e-5},
                        "vorticity", "cell");
}

TEST_CASE("a flow that is not linear: differences over two edges in the middle, one at the rim") {
    course::set_hint(2);
    const CellGrid cells{glm::vec3(0), 1.0f, glm::ivec3(5, 1, 1)};
    // v = x^2 at x = 0.5 ... 4.5: one curl component, dv/dx.
    const Points field = at_centres(cells, [](glm::vec3 x) { return glm::vec3(0, x.x * x.x, 0); });
    Points expected;
    for (const float slope : {2.0f, 3.0f, 5.0f, 7.0f, 8.0f}) expected.push_back(with_length({0, 0, slope}));
    course::check_close(vorticity(cells, field), expected, {1e-5}, "vorticity", "cell");
}

TEST_CASE("one cell: nought, and no NaN") {
    course::set_hint(2);
    const CellGrid cells{glm::vec3(0), 1.0f, glm::ivec3(1)};
    course::check_equal(vorticity(cells, {make_float4(3, 4, 5, 6)}), Points{with_length(glm::vec3(0))},
                        "vorticity", "cell");
}
