// Exercise 05.3: a periodic box, against exact integer arithmetic over all pairs.
#include "ex3_periodic.cuh"

#include <Random123/philox.h>

#include <algorithm>
#include <string>

#include "tests/support/course_test.h"

namespace {

using glm::ivec3;
using glm::vec3;

constexpr int kUnits = 1 << 20;  // coordinates are whole multiples of 1 / kUnits: every difference is exact

/// Points of the cube [0, 1)^3, as the reference table defines them, stretched to the box.
std::vector<ivec3> philox_cloud(std::uint32_t n, std::uint32_t seed, vec3 box_m = vec3(1)) {
    std::vector<ivec3> cloud;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto r = r123::Philox4x32()({{i, 0, 0, 0}}, {{seed, 0}});
        // box_m is a multiple of 1/8 here and the upper 17 bits are taken then: still whole units.
        cloud.push_back(box_m == vec3(1) ? ivec3(r[0] >> 12, r[1] >> 12, r[2] >> 12)
                                         : ivec3(8.0f * box_m) * ivec3(r[0] >> 15, r[1] >> 15, r[2] >> 15));
    }
    return cloud;
}

std::vector<float4> to_metres(const std::vector<ivec3>& cloud) {
    std::vector<float4> position;
    for (ivec3 p : cloud) position.push_back(make_float4(p.x, p.y, p.z, 0));
    for (float4& p : position) p = make_float4(p.x / kUnits, p.y / kUnits, p.z / kUnits, 0);
    return position;
}

/// Neighbours of each particle among all particles and their images, in whole units.
std::vector<int> count_cpu(const std::vector<ivec3>& cloud, vec3 box_m, float radius_m) {
    const ivec3 box(box_m * float(kUnits));
    const long long radius = (long long)(double(radius_m) * kUnits);
    std::vector<int> count(cloud.size(), 0);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        for (std::size_t j = 0; j < cloud.size(); ++j) {
            long long squared = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const long long apart = std::abs(cloud[i][axis] - cloud[j][axis]);
                const long long nearest = std::min(apart, box[axis] - apart);
                squared += nearest * nearest;
            }
            count[i] += i != j && squared < radius * radius;
        }
    return count;
}

/// What the exercise counts, in the order of the input.
std::vector<int> count_periodic(const std::vector<float4>& position, const grid::CellGrid& cells,
                                float radius_m) {
    const std::uint32_t n = std::uint32_t(position.size()), blocks = grid::blocks_for(n, 128);
    const course::DeviceBuffer<float4> x(position);
    course::DeviceBuffer<float4> sorted_x(n);
    course::DeviceBuffer<std::uint32_t> sorted_count(n);
    grid::CountingSort sort(n, cells.cell_count());
    sort.build(x.data(), cells, n);
    grid::gather_kernel<<<blocks, 128>>>(sorted_x.data(), x.data(), sort.order(), n);
    grid::neighbours_periodic_kernel<<<blocks, 128>>>(sorted_count.data(), sorted_x.data(), sort.ranges(),
                                                      cells, radius_m, n);
    CUDA_CHECK(cudaGetLastError());
    std::vector<std::uint32_t> order(n);
    CUDA_CHECK(cudaMemcpy(order.data(), sort.order(), n * sizeof order[0], cudaMemcpyDeviceToHost));
    const std::vector<std::uint32_t> in_cell_order = sorted_count.download();
    std::vector<int> count(n);
    for (std::uint32_t place = 0; place < n; ++place) count[order[place]] = int(in_cell_order[place]);
    return count;
}

/// Exclusive or of a hash of each pair i < j, as the reference table defines it.
__global__ void pair_hash_kernel(unsigned long long* hash, const float4* position, const std::uint32_t* order,
                                 grid::CellRanges ranges, grid::CellGrid cells, float radius_m,
                                 std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const vec3 x = grid::xyz(position[i]);
    unsigned long long mine = 0;
    grid::for_each_wrapped_cell(cells, x, [&](std::uint32_t cell) {
        for (std::uint32_t k = ranges.cell_first[cell]; k < ranges.cell_last[cell]; ++k) {
            const std::uint32_t j = order[k];
            const vec3 d = grid::nearest_image(x - grid::xyz(position[j]), grid::box_of(cells));
            if (i >= j || !grid::is_near(d, vec3(0), radius_m * radius_m)) continue;
            std::uint64_t z = (std::uint64_t(i) << 32) + j + 0x9e3779b97f4a7c15u;  // splitmix64
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
            z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
            mine ^= z ^ (z >> 31);
        }
    });
    hash[i] = mine;
}

}  // namespace

TEST_CASE("the nearest image of a difference") {
    course::set_hint(1);
    const vec3 box(1.0f, 0.5f, 4.0f);
    const std::vector<vec3> difference{
        {0.25f, 0.125f, 1}, {0.75f, 0.375f, 3}, {-0.75f, -0.375f, -3}, {0.9f, -0.1f, -2.5f}};
    const std::vector<vec3> expected{
        {0.25f, 0.125f, 1}, {-0.25f, -0.125f, -1}, {0.25f, 0.125f, 1}, {-0.1f, -0.1f, 1.5f}};
    std::vector<vec3> got;
    for (vec3 d : difference) got.push_back(grid::nearest_image(d, box));
    course::check_close(got, expected, course::Tolerance(1e-7), "nearest image",
                        "difference");  // rounding of 0.9 - 1
}

TEST_CASE("the cells around a cell: each once, those beyond a face from the opposite one") {
    course::set_hint(2);
    for (const ivec3 size : {ivec3(5, 4, 3), ivec3(3, 3, 3), ivec3(2, 5, 1), ivec3(1, 1, 1)}) {
        const grid::CellGrid cells{vec3(0), 4.0f, size};
        for (int c = 0; c < int(cells.cell_count()); ++c) {
            const ivec3 centre(c % size.x, c / size.x % size.y, c / size.x / size.y);
            std::vector<int> expected, got;
            for (int other = 0; other < int(cells.cell_count()); ++other) {
                const ivec3 apart = glm::abs(
                    ivec3(other % size.x, other / size.x % size.y, other / size.x / size.y) - centre);
                const ivec3 nearest = glm::min(apart, size - apart);
                if (nearest.x <= 1 && nearest.y <= 1 && nearest.z <= 1) expected.push_back(other);
            }
            grid::for_each_wrapped_cell(cells, (vec3(centre) + 0.5f) / 4.0f,
                                        [&](std::uint32_t cell) { got.push_back(int(cell)); });
            std::sort(got.begin(), got.end());
            const std::string what = "grid of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                                     " x " + std::to_string(size.z) + ", around cell " + std::to_string(c) +
                                     ": visited cell";
            if (!course::check_equal(got, expected, what, "number")) return;
        }
    }
}

TEST_CASE("all neighbours in a box of 8 x 3 x 5 cells") {
    course::set_seed(12);
    course::set_hint(2);
    const grid::CellGrid cells{vec3(0), 8.0f, {8, 3, 5}};
    const vec3 box = grid::box_of(cells);
    const std::vector<ivec3> cloud = philox_cloud(1200, 12, box);
    for (const float radius_m : {0.125f, 0.0625f, 0.12109375f})
        course::check_equal(count_periodic(to_metres(cloud), cells, radius_m),
                            count_cpu(cloud, box, radius_m), "neighbours");
}

TEST_CASE("fewer than three cells along an axis: no pair counted twice") {
    course::set_seed(13);
    course::set_hint(3);
    for (const ivec3 size : {ivec3(2, 2, 2), ivec3(1, 2, 5), ivec3(1, 1, 1), ivec3(6, 2, 1)}) {
        const grid::CellGrid cells{vec3(0), 4.0f, size};
        const vec3 box = grid::box_of(cells);
        const std::vector<ivec3> cloud = philox_cloud(300, 13, box);
        // Just under half the shortest side, but no more than a cell's edge; whole units.
        const float radius_m = std::min(0.25f, std::min({box.x, box.y, box.z}) / 2 - 1.0f / kUnits);
        if (!course::check_equal(count_periodic(to_metres(cloud), cells, radius_m),
                                 count_cpu(cloud, box, radius_m),
                                 "neighbours in " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                                     " x " + std::to_string(size.z) + " cells"))
            return;
    }
}

TEST_CASE("pair counts and hashes of the periodic Philox clouds") {
    course::set_hint(3);
    struct Reference {  // tests/data/README.md: philox_cloud_pair_counts, periodic
        std::uint32_t n, seed;
        float cutoff;
        std::uint64_t pairs, hash;
    };
    for (const Reference& ref : {Reference{1000, 1, 0.125f, 4144, 0xbcf4a67b7fff64a0u},
                                 Reference{10000, 2, 0.0625f, 50863, 0x575b1a0ff363f33cu}}) {
        const std::vector<float4> cloud = to_metres(philox_cloud(ref.n, ref.seed));
        const grid::CellGrid cells = grid::make_periodic_cube(1.0f, ref.cutoff);
        std::uint64_t twice = 0;
        for (int count : count_periodic(cloud, cells, ref.cutoff)) twice += count;
        CHECK(twice == 2 * ref.pairs);

        const course::DeviceBuffer<float4> x(cloud);
        course::DeviceBuffer<unsigned long long> hashes(ref.n);
        grid::CountingSort sort(ref.n, cells.cell_count());
        sort.build(x.data(), cells, ref.n);
        pair_hash_kernel<<<grid::blocks_for(ref.n, 128), 128>>>(hashes.data(), x.data(), sort.order(),
                                                                sort.ranges(), cells, ref.cutoff, ref.n);
        CUDA_CHECK(cudaGetLastError());
        std::uint64_t hash = 0;
        for (unsigned long long h : hashes.download()) hash ^= h;
        CHECK(hash == ref.hash);
    }
}
