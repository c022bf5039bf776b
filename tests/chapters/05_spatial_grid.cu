// Chapter 05: the grid finds exactly the neighbours that brute force finds, in every awkward case.
#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "05_spatial_grid/costs.h"
#include "05_spatial_grid/studies.cuh"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

using grid::CellGrid;

/// Points of the reference table: coordinates are multiples of 2^-20, so every distance is exact.
std::vector<float4> philox_cloud(std::uint32_t n, std::uint32_t seed) {
    std::vector<float4> cloud;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto r = r123::Philox4x32()({{i, 0, 0, 0}}, {{seed, 0}});
        const float scale = 1.0f / (1 << 20);
        cloud.push_back(make_float4((r[0] >> 12) * scale, (r[1] >> 12) * scale, (r[2] >> 12) * scale, 0));
    }
    return cloud;
}

std::vector<float4> random_cloud(std::size_t n, glm::vec3 low, glm::vec3 high, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float4> cloud;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::vec3 u(unit(random), unit(random), unit(random));
        const glm::vec3 x = low + u * (high - low);
        cloud.push_back(make_float4(x.x, x.y, x.z, 0));
    }
    return cloud;
}

CellGrid grid_around(const std::vector<float4>& position, float radius) {
    const grid::Bounds box = grid::bounds_cpu(position);
    if (!(box.low_m.x <= box.high_m.x)) return {};
    return grid::make_grid(box.low_m, box.high_m, radius, grid::max_cells_for(position.size()));
}

struct Counts {
    // All in the input's order.
    std::vector<std::uint32_t> brute_force, sorted_grid, counting_sort, coherent, in_lanes;
};

/// The five methods on the same points.
Counts count_all(const std::vector<float4>& position, const CellGrid& cells, float radius) {
    const std::uint32_t n = std::uint32_t(position.size());
    Counts counts;
    if (n == 0) {  // building must work; there is nothing to launch after it
        grid::CountingSort(1, cells.cell_count()).build(nullptr, cells, 0);
        grid::SortedGrid(1, cells.cell_count()).build(nullptr, cells, 0);
        return counts;
    }
    const std::uint32_t threads = 128, blocks = grid::blocks_for(n, threads);
    course::DeviceBuffer<float4> x(position), sorted_x(n);
    course::DeviceBuffer<std::uint32_t> count(n);

    grid::neighbours_brute_force_kernel<<<blocks, threads>>>(count.data(), x.data(), radius, n);
    CUDA_CHECK(cudaGetLastError());
    counts.brute_force = count.download();

    grid::SortedGrid by_sort(n, cells.cell_count());
    by_sort.build(x.data(), cells, n);
    grid::neighbours_scattered_kernel<<<blocks, threads>>>(count.data(), x.data(), by_sort.order(),
                                                           by_sort.ranges(), cells, radius, n);
    CUDA_CHECK(cudaGetLastError());
    counts.sorted_grid = count.download();

    grid::CountingSort by_count(n, cells.cell_count());
    by_count.build(x.data(), cells, n);
    grid::neighbours_scattered_kernel<<<blocks, threads>>>(count.data(), x.data(), by_count.order(),
                                                           by_count.ranges(), cells, radius, n);
    CUDA_CHECK(cudaGetLastError());
    counts.counting_sort = count.download();

    grid::gather_kernel<<<blocks, threads>>>(sorted_x.data(), x.data(), by_count.order(), n);
    grid::neighbours_coherent_kernel<<<blocks, threads>>>(count.data(), sorted_x.data(), by_count.ranges(),
                                                          cells, radius, n);
    CUDA_CHECK(cudaGetLastError());
    course::DeviceBuffer<std::uint32_t> order(n);
    CUDA_CHECK(cudaMemcpy(order.data(), by_count.order(), order.bytes(), cudaMemcpyDeviceToDevice));
    const std::vector<std::uint32_t> particle_at = order.download();
    const auto by_particle = [&] {
        const std::vector<std::uint32_t> in_cell_order = count.download();
        std::vector<std::uint32_t> result(n);
        for (std::uint32_t place = 0; place < n; ++place) result[particle_at[place]] = in_cell_order[place];
        return result;
    };
    counts.coherent = by_particle();

    grid::ColumnBuffer columns(n);
    grid::gather_columns_kernel<<<blocks, threads>>>(columns.columns(), x.data(), by_count.order(), n);
    grid::neighbours_in_lanes_kernel<<<blocks, threads>>>(count.data(), std::as_const(columns).columns(),
                                                          by_count.ranges(), cells, radius, n);
    CUDA_CHECK(cudaGetLastError());
    counts.in_lanes = by_particle();
    return counts;
}

/// All five against the CPU reference, exactly: every method does the same fp32 arithmetic on a pair.
void check_against_reference(const std::vector<float4>& position, const CellGrid& cells, float radius) {
    const std::vector<std::uint32_t> expected = grid::count_neighbours_cpu(position, radius);
    const Counts counts = count_all(position, cells, radius);
    course::check_equal(counts.brute_force, expected, "neighbours by brute force");
    course::check_equal(counts.sorted_grid, expected, "neighbours by the sorted grid");
    course::check_equal(counts.counting_sort, expected, "neighbours by the counting sort");
    course::check_equal(counts.coherent, expected, "neighbours in cell order");
    course::check_equal(counts.in_lanes, expected, "neighbours in whole vectors");
}

std::uint64_t splitmix64(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// Exclusive or of a hash of each pair i < j: the same for the same set of pairs, in whatever order it is
/// found.
__global__ void pair_hash_kernel(unsigned long long* hash, const float4* sorted_position,
                                 const std::uint32_t* order, grid::CellRanges ranges, CellGrid cells,
                                 float radius, std::uint32_t n) {
    const std::uint32_t place = blockIdx.x * blockDim.x + threadIdx.x;
    if (place >= n) return;
    const glm::vec3 x = grid::xyz(sorted_position[place]);
    unsigned long long mine = 0;
    grid::for_each_row(cells, x, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
        for (std::uint32_t k = ranges.cell_first[first_cell]; k < ranges.cell_last[last_cell]; ++k)
            if (order[place] < order[k] && grid::is_near(x, grid::xyz(sorted_position[k]), radius * radius)) {
                std::uint64_t z = (std::uint64_t(order[place]) << 32) + order[k] + 0x9e3779b97f4a7c15u;
                z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
                z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
                mine ^= z ^ (z >> 31);
            }
    });
    hash[place] = mine;
}

}  // namespace

TEST_CASE("pair counts and hashes of the Philox clouds") {
    // Reference values: exact integer arithmetic over all pairs (tests/data/README.md,
    // philox_cloud_pair_counts).
    struct Reference {
        std::uint32_t n, seed;
        float cutoff;
        std::uint64_t pairs, hash;
        std::uint32_t most;
    };
    // max_neighbours of the table belongs to these clouds too.
    for (const Reference& ref : {Reference{1000, 1, 0.125f, 3648, 0xb1fe3a323c5641c7u, 17},
                                 Reference{10000, 2, 0.0625f, 47493, 0x46285c7862d4022bu, 25}}) {
        const std::vector<float4> cloud = philox_cloud(ref.n, ref.seed);
        const CellGrid cells = grid_around(cloud, ref.cutoff);
        const Counts counts = count_all(cloud, cells, ref.cutoff);
        for (const auto& count : {counts.brute_force, counts.sorted_grid, counts.counting_sort,
                                  counts.coherent, counts.in_lanes}) {
            std::uint64_t twice = 0;
            for (std::uint32_t c : count) twice += c;
            CHECK(twice == 2 * ref.pairs);
            CHECK(*std::max_element(count.begin(), count.end()) == ref.most);
        }
        course::DeviceBuffer<float4> x(cloud), sorted_x(ref.n);
        course::DeviceBuffer<unsigned long long> hashes(ref.n);
        grid::CountingSort sort(ref.n, cells.cell_count());
        sort.build(x.data(), cells, ref.n);
        const std::uint32_t blocks = grid::blocks_for(ref.n, 128);
        grid::gather_kernel<<<blocks, 128>>>(sorted_x.data(), x.data(), sort.order(), ref.n);
        pair_hash_kernel<<<blocks, 128>>>(hashes.data(), sorted_x.data(), sort.order(), sort.ranges(), cells,
                                          ref.cutoff, ref.n);
        CUDA_CHECK(cudaGetLastError());
        std::uint64_t hash = 0;
        for (unsigned long long h : hashes.download()) hash ^= h;
        CHECK(hash == ref.hash);
    }
    CHECK(splitmix64(0) == 0xe220a8397b1dcdafu);  // first output of the published generator, seed 0
}

TEST_CASE("every method agrees with the CPU at sizes around a block") {
    course::set_seed(11);
    for (std::size_t n : {1, 2, 31, 127, 128, 129, 1000, 3001}) {
        const std::vector<float4> cloud = random_cloud(n, {-1, -2, 0}, {1, 1, 0.5f}, 11);
        check_against_reference(cloud, grid_around(cloud, 0.2f), 0.2f);
    }
}

TEST_CASE("no particles") {
    const Counts counts = count_all({}, CellGrid{}, 1.0f);
    CHECK(counts.brute_force.empty());
    const grid::Bounds box = grid::find_bounds(nullptr, 0);
    CHECK(box.low_m.x > box.high_m.x);
}

TEST_CASE("4096 coincident particles: all pairs, and no time lost in sorting one cell") {
    const std::vector<float4> cloud(4096, make_float4(0.25f, -3.0f, 7.0f, 0));
    const CellGrid cells = grid_around(cloud, 0.1f);
    const Counts counts = count_all(cloud, cells, 0.1f);
    for (const auto& count :
         {counts.brute_force, counts.sorted_grid, counts.counting_sort, counts.coherent, counts.in_lanes}) {
        std::uint64_t pairs = 0;
        for (std::uint32_t c : count) pairs += c;
        CHECK(pairs / 2 == 8386560);  // n (n - 1) / 2
    }
}

TEST_CASE("all particles in one cell, all distinct") {
    course::set_seed(5);
    const std::vector<float4> cloud = random_cloud(2000, glm::vec3(0), glm::vec3(0.05f), 5);
    check_against_reference(cloud, CellGrid{}, 0.02f);
}

TEST_CASE("particles on cell faces are in exactly one cell") {
    std::vector<float4> cloud;
    for (int z = 0; z < 9; ++z)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 9; ++x) cloud.push_back(make_float4(0.125f * x, 0.125f * y, 0.125f * z, 0));
    const CellGrid cells{glm::vec3(0), 8.0f,
                         glm::ivec3(9)};  // edge 1/8: every coordinate is k * edge exactly
    check_against_reference(cloud, cells, 0.125f);
    check_against_reference(cloud, cells, 0.1250001f);
    grid::CountingSort sort(cloud.size(), cells.cell_count());
    course::DeviceBuffer<float4> x(cloud);
    sort.build(x.data(), cells, cloud.size());
    std::vector<std::uint32_t> ends(cells.cell_count());
    CUDA_CHECK(cudaMemcpy(ends.data(), sort.ranges().cell_last, ends.size() * 4, cudaMemcpyDeviceToHost));
    for (std::size_t c = 0; c < ends.size(); ++c) CHECK(ends[c] == c + 1);  // one particle in each
}

TEST_CASE("negative coordinates: moving the cloud changes nothing") {
    const std::vector<float4> cloud = philox_cloud(1000, 1);
    std::vector<float4> moved = cloud;
    for (float4& p : moved) p = make_float4(p.x - 1, p.y - 1, p.z - 1, 0);  // exact: multiples of 2^-20
    const auto here = count_all(cloud, grid_around(cloud, 0.125f), 0.125f).coherent;
    // A grid whose cell 0 starts at 0.0 in the middle of the moved cloud would clamp; this one starts below
    // it.
    const auto there =
        count_all(moved, grid::make_grid({-1.05f, -1.1f, -1.2f}, {0, 0, 0}, 0.125f, 10000), 0.125f);
    course::check_equal(there.coherent, here, "neighbours after the move");
    course::check_equal(there.brute_force, here, "neighbours after the move, brute force");
    CHECK(grid::cell_of({glm::vec3(-2), 1.0f, {4, 4, 4}}, {-1.3f, -0.3f, 0.3f}) == glm::ivec3(0, 1, 2));
}

TEST_CASE("outside the grid and just at its upper face") {
    course::set_seed(9);
    const std::vector<float4> cloud = random_cloud(1500, glm::vec3(-0.5f), glm::vec3(1.5f), 9);
    // The grid covers only [0, 1]^3; particles beyond it are clamped to its rim.
    check_against_reference(cloud, grid::make_grid(glm::vec3(0), glm::vec3(1), 0.15f, 4096), 0.15f);
    std::vector<float4> far = cloud;
    far[3] = make_float4(1e30f, 0, 0, 0);
    far[4] = make_float4(-3e38f, 3e38f, 0, 0);
    check_against_reference(far, grid::make_grid(glm::vec3(0), glm::vec3(1), 0.15f, 4096), 0.15f);
    check_against_reference(far, grid_around(far, 0.15f), 0.15f);  // cells grow until the grid fits
}

TEST_CASE("NaN and infinite positions go to the limbo and change no other particle") {
    const std::vector<float4> cloud = philox_cloud(1000, 1);
    std::vector<float4> broken = cloud;
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    broken.insert(broken.begin() + 10, make_float4(nan, 0.5f, 0.5f, 0));
    broken.push_back(make_float4(0.5f, -inf, 0.5f, 0));
    const CellGrid cells = grid_around(cloud, 0.125f);
    check_against_reference(broken, cells, 0.125f);
    auto clean = count_all(cloud, cells, 0.125f).in_lanes;  // the method that reads beyond its rows
    auto counts = count_all(broken, cells, 0.125f).in_lanes;
    CHECK(counts[10] == 0);
    CHECK(counts.back() == 0);
    counts.pop_back();
    counts.erase(counts.begin() + 10);
    course::check_equal(counts, clean, "neighbours of the finite particles");

    course::DeviceBuffer<float4> x(broken);
    const grid::Bounds box = grid::find_bounds(x.data(), broken.size());
    const grid::Bounds expected = grid::bounds_cpu(cloud);
    CHECK(box.low_m == expected.low_m);
    CHECK(box.high_m == expected.high_m);
    grid::CountingSort sort(broken.size(), cells.cell_count());
    sort.build(x.data(), cells, broken.size());
    std::uint32_t limbo[2];
    CUDA_CHECK(cudaMemcpy(limbo, sort.ranges().cell_first + cells.cell_count(), sizeof limbo,
                          cudaMemcpyDeviceToHost));
    CHECK(limbo[1] - limbo[0] == 2);  // reported: the program can say how many were lost
}

TEST_CASE("input order does not matter") {
    std::vector<float4> cloud = philox_cloud(1000, 1);
    const auto before = count_all(cloud, grid_around(cloud, 0.125f), 0.125f).coherent;
    std::vector<std::uint32_t> shuffled(1000);
    for (std::uint32_t i = 0; i < 1000; ++i) shuffled[i] = i;
    std::mt19937 random(3);
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    std::vector<float4> other(1000);
    for (std::uint32_t i = 0; i < 1000; ++i) other[i] = cloud[shuffled[i]];
    const auto after = count_all(other, grid_around(other, 0.125f), 0.125f).coherent;
    for (std::uint32_t i = 0; i < 1000; ++i) CHECK(after[i] == before[shuffled[i]]);
}

TEST_CASE("a box a million times longer than wide") {
    course::set_seed(21);
    std::vector<float4> cloud = random_cloud(3000, {0, 0, 0}, {1e6f, 1, 1}, 21);
    // Pairs across the whole length, half a unit apart: as far as the radius allows at 1e6 (ulp 1/16).
    for (int i = 0; i < 1000; ++i) cloud.push_back(make_float4(cloud[i].x + 0.5f, cloud[i].y, cloud[i].z, 0));
    const CellGrid cells = grid_around(cloud, 1.0f);
    CHECK(cells.size.y == 1);
    CHECK(double(cells.size.x) * cells.size.y * cells.size.z <= grid::max_cells_for(cloud.size()));
    check_against_reference(cloud, cells, 1.0f);
    // Without the limit the product of cells would need 64 bits: 1291^3 > 2^31.
    const CellGrid huge = grid::make_grid(glm::vec3(0), glm::vec3(1e6f), 1e-6f, 1u << 30);
    CHECK(double(huge.size.x) * huge.size.y * huge.size.z <= double(1u << 30));
}

TEST_CASE("the fp32 trap: with cell edge = radius two neighbours land two cells apart") {
    // Reference: 2_grid/fp32_cell_index_traps; these two pairs are missed by floor(x * (1 / r)).
    struct Trap {
        float x1, x2, radius;
    };
    for (const Trap& trap : {Trap{0.3839999735355377f, 0.3959999680519104f, 0.012f},
                             Trap{28.799997329711914f, 29.699996948242188f, 0.9f}}) {
        const auto naive = [&](float x) { return int(std::floor(x * (1.0f / trap.radius))); };
        CHECK(trap.x2 - trap.x1 < trap.radius);
        CHECK(naive(trap.x2) - naive(trap.x1) == 2);
        // Our edge: the pair is found, wherever the grid begins.
        for (float low : {0.0f, -1.0f, -7.3f}) {
            const CellGrid cells =
                grid::make_grid(glm::vec3(low), glm::vec3(50, 0.01f, 0.01f), trap.radius, 1 << 20);
            check_against_reference({make_float4(trap.x1, 0, 0, 0), make_float4(trap.x2, 0, 0, 0)}, cells,
                                    trap.radius);
        }
    }
}

TEST_CASE("the fp32 trap does not exist for our edge: half a million close pairs on long grids") {
    // Pairs at just under the radius, all along grids of up to 30,000 cells: adjacent cells at most.
    std::mt19937 random(17);
    std::uniform_real_distribution<float> unit(0, 1);
    for (float radius : {0.012f, 0.9f, 0.04f, 1.1f})
        for (float length : {100.0f, 30000.0f}) {
            const CellGrid cells =
                grid::make_grid(glm::vec3(0), glm::vec3(length * radius, 0, 0), radius, 1u << 20);
            int worst = 0;
            for (int k = 0; k < 60000; ++k) {
                const float a = unit(random) * (length - 1) * radius;
                float b = a + radius;
                while (!(b - a < radius)) b = std::nextafter(b, 0.0f);
                worst =
                    std::max(worst, grid::cell_of(cells, {b, 0, 0}).x - grid::cell_of(cells, {a, 0, 0}).x);
            }
            CHECK(worst == 1);
        }
}

TEST_CASE("none, one and two particles; two at the same place") {
    const Counts none = count_all({}, CellGrid{}, 1.0f);
    CHECK(none.coherent.empty());
    const float4 here = make_float4(3, -4, 5, 0), near = make_float4(3.05f, -4, 5, 0),
                 far = make_float4(9, 9, 9, 0);
    for (const std::vector<float4>& cloud :
         {std::vector<float4>{here}, {here, near}, {here, far}, {here, here}, {here, here, far, far, far}})
        check_against_reference(cloud, grid_around(cloud, 0.1f), 0.1f);
    // By hand, too: coincident particles are neighbours, and nobody is its own.
    CHECK(count_all({here, here}, grid_around({here, here}, 0.1f), 0.1f).coherent ==
          std::vector<std::uint32_t>{1, 1});
    CHECK(count_all({here, far}, grid_around({here, far}, 0.1f), 0.1f).coherent ==
          std::vector<std::uint32_t>{0, 0});
}

TEST_CASE("10 km from the origin: fewer digits, the same answer as all pairs") {
    course::set_seed(13);
    // Floats stand 1 mm apart there: points and distances are coarse, but coarse alike for every method.
    for (const glm::vec3 corner : {glm::vec3(1e4f), glm::vec3(-1e4f, 1e4f, 0), glm::vec3(1e6f)}) {
        const std::vector<float4> cloud = random_cloud(3000, corner, corner + 1.0f, 13);
        check_against_reference(cloud, grid_around(cloud, 0.125f), 0.125f);
    }
}

TEST_CASE("a box thinner than the radius: a sheet, a thread") {
    course::set_seed(14);
    for (const glm::vec3 size : {glm::vec3(3, 1e-3f, 3), glm::vec3(5, 1e-3f, 1e-4f), glm::vec3(1e-3f)}) {
        const std::vector<float4> cloud = random_cloud(2000, glm::vec3(0), size, 14);
        const CellGrid cells = grid_around(cloud, 0.1f);
        CHECK(cells.size.y == 1);
        check_against_reference(cloud, cells, 0.1f);
    }
}

TEST_CASE("the five methods of the program agree, and a wrong one is counted") {
    for (const std::uint32_t n : {1u, 2u, 129u, 3000u}) {
        const std::vector<float4> points = grid::random_cloud(n, 3);
        grid::Cloud cloud(points, grid::radius_for_30(n));
        const std::vector<std::uint32_t> expected = grid::count_neighbours_cpu(points, cloud.radius_m);
        for (const grid::Method& method : grid::methods(cloud)) {
            method.build();
            method.query();
            course::check_equal(method.counts(), expected, "neighbours by " + method.name);
        }
    }
    CHECK(grid::different_counts({1, 2, 3}, {1, 2, 3}) == 0);
    CHECK(grid::different_counts({1, 2, 3}, {2, 2}) == 1);  // the third was not asked
    // Brute force: all particles where that is bearable, else whole blocks.
    CHECK(grid::asked_of_brute_force(1) == 1);
    CHECK(grid::asked_of_brute_force(1u << 15) == 1u << 15);
    CHECK(grid::asked_of_brute_force(1u << 18) == 1u << 12);
}

TEST_CASE("crowding: all in one cell, and evenly spread") {
    const float radius_m = grid::radius_for_30(500);
    for (const grid::Crowd& crowd : grid::crowds(500, 1, radius_m)) {
        grid::Cloud cloud(crowd.position, radius_m);
        const auto neighbours = grid::count_neighbours_cpu(crowd.position, radius_m);
        const grid::Crowding c = grid::crowding_of(crowd.position, cloud.cells, neighbours);
        CHECK(c.candidates_each >= c.neighbours_each + 1);  // candidates are neighbours, itself, and others
        if (crowd.name == "one cell") {
            CHECK(c.fullest == 500);
            CHECK(c.candidates_each == doctest::Approx(500));  // a sum of 500 shares, each rounded
        } else {
            CHECK(c.fullest < 500);
        }
    }
}

TEST_CASE("the sorted order repeats exactly, however the threads are timed") {
    course::set_seed(31);
    const auto cloud = random_cloud(20000, glm::vec3(0), glm::vec3(1), 31);
    course::DeviceBuffer<float4> x(cloud);
    const CellGrid cells = grid_around(cloud, 0.2f);  // few cells, many particles in each: much contention
    std::vector<std::uint32_t> first;
    for (int run = 0; run < 10; ++run) {
        grid::CountingSort sort(cloud.size(), cells.cell_count());
        sort.build(x.data(), cells, cloud.size());
        std::vector<std::uint32_t> order(cloud.size());
        CUDA_CHECK(cudaMemcpy(order.data(), sort.order(), order.size() * 4, cudaMemcpyDeviceToHost));
        if (run == 0) first = order;
        CHECK(order == first);
    }
    // And it is the order a stable sort gives.
    grid::SortedGrid stable(cloud.size(), cells.cell_count());
    stable.build(x.data(), cells, cloud.size());
    std::vector<std::uint32_t> order(cloud.size());
    CUDA_CHECK(cudaMemcpy(order.data(), stable.order(), order.size() * 4, cudaMemcpyDeviceToHost));
    CHECK(order == first);
}

TEST_CASE("what --explain says is what happens: launches and bytes of each method") {
    course::require_simulator();
#ifdef __CUDASIM__
    const std::uint32_t n = 3000, threads = 128, blocks = grid::blocks_for(n, threads);
    const auto cloud = random_cloud(n, glm::vec3(0), glm::vec3(1), 2);
    const float radius = 0.05f;
    const CellGrid cells = grid_around(cloud, radius);
    const std::vector<grid::Cost> costs = grid::costs(n, cells.cell_count());
    std::vector<std::string> kernels;
    // Everything a method allocates, from the positions on, is allocated while its recording lives.
    const auto check_cost = [&](const grid::Cost& cost, const auto& run) {
        INFO(cost.method);
        const cudasim::Recording log;
        run();
        std::vector<std::string> launched, promised = cost.build;
        for (const cudasim::Launch& launch : log.launches()) launched.push_back(launch.kernel);
        promised.insert(promised.end(), cost.query.begin(), cost.query.end());
        promised.erase(std::remove(promised.begin(), promised.end(), grid::kThrustSort), promised.end());
        CHECK(launched == promised);
        CHECK(log.bytes() == cost.bytes);
    };
    using namespace grid;  // the log has the kernels' names as they are written at the launch
    check_cost(costs[0], [&] {
        course::DeviceBuffer<float4> x(cloud);
        course::DeviceBuffer<std::uint32_t> count(n);
        neighbours_brute_force_kernel<<<blocks, threads>>>(count.data(), x.data(), radius, n);
    });
    check_cost(costs[1], [&] {
        course::DeviceBuffer<float4> x(cloud);
        course::DeviceBuffer<std::uint32_t> count(n);
        SortedGrid sort(n, cells.cell_count());
        sort.build(x.data(), cells, n);
        neighbours_scattered_kernel<<<blocks, threads>>>(count.data(), x.data(), sort.order(), sort.ranges(),
                                                         cells, radius, n);
    });
    for (const int method : {2, 3, 4})
        check_cost(costs[method], [&] {
            course::DeviceBuffer<float4> x(cloud);
            course::DeviceBuffer<std::uint32_t> count(n);
            CountingSort sort(n, cells.cell_count());
            sort.build(x.data(), cells, n);
            if (method == 2) {
                neighbours_scattered_kernel<<<blocks, threads>>>(count.data(), x.data(), sort.order(),
                                                                 sort.ranges(), cells, radius, n);
                return;
            }
            if (method == 4) {
                ColumnBuffer columns(n);
                gather_columns_kernel<<<blocks, threads>>>(columns.columns(), x.data(), sort.order(), n);
                neighbours_in_lanes_kernel<<<blocks, threads>>>(
                    count.data(), std::as_const(columns).columns(), sort.ranges(), cells, radius, n);
                return;
            }
            course::DeviceBuffer<float4> sorted_x(n);
            gather_kernel<<<blocks, threads>>>(sorted_x.data(), x.data(), sort.order(), n);
            neighbours_coherent_kernel<<<blocks, threads>>>(count.data(), sorted_x.data(), sort.ranges(),
                                                            cells, radius, n);
        });
#endif
}

TEST_CASE("a method that misses a neighbour stops the program") {
    CHECK_NOTHROW(
        grid::check_same({1, 2, 3}, {1, 2}, "the grid"));  // brute force was not asked for the third
    CHECK_THROWS_WITH_AS(grid::check_same({1, 2, 4}, {1, 2, 3}, "the grid"),
                         "the grid finds 4 neighbours of particle 2, brute force 3", std::runtime_error);
}

TEST_CASE("the program: bad input ends with exit code 2 and a sentence; extremes work") {
    const std::filesystem::path out = std::filesystem::temp_directory_path() / "course_test_05";
    const auto run = [&](const std::string& arguments) {
        return course::run_program("ch05_spatial_grid", arguments + " --out " + out.string());
    };
    const struct {
        const char *arguments, *sentence;
    } bad[] = {{"--particles 0", "--particles must be"},
               {"--particles 16777217", "--particles must be from 1 to 16777216"},
               {"--window", "--window: this chapter draws pictures only"}};
    for (const auto& c : bad) {
        const course::ProgramRun ended = run(c.arguments);
        CHECK_MESSAGE(ended.exit_code == 2, c.arguments);
        CHECK_MESSAGE(ended.output.find(c.sentence) != std::string::npos, ended.output);
    }
    std::filesystem::remove_all(out);
    const course::ProgramRun explained = run("--explain --particles 1");
    CHECK_MESSAGE(explained.exit_code == 0, explained.output);
    CHECK(explained.output.find("sort_cells_kernel") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(out));  // explaining makes nothing
    for (const char* arguments :
         {"--particles 1 --width 16 --height 16", "--particles 2", "--particles 20000"}) {
        const course::ProgramRun ended = run(arguments);
        CHECK_MESSAGE(ended.exit_code == 0, ended.output);
        CHECK(ended.output.find("the error is 0") != std::string::npos);
        for (const char* file : {"search.png", "result.json"})
            CHECK_MESSAGE(std::filesystem::file_size(out / file) > 0, file);
    }
    std::filesystem::remove_all(out);
}

TEST_CASE("the studies run and find no wrong count") {
    const course::TemporaryFolder folder;
    for (const char* study : {"neighbours", "occupancy"}) {
        const course::ProgramRun ended =
            course::run_program("ch05_spatial_grid",
                                std::string("--quick --study ") + study + " --out " + folder.path().string());
        CHECK_MESSAGE(ended.exit_code == 0, ended.output);
        std::ifstream csv(folder.path() / (std::string("study_") + study + ".csv"));
        std::string line;
        int rows = 0;
        for (std::getline(csv, line); std::getline(csv, line); ++rows)
            CHECK_MESSAGE(line.find(",0,particles whose number") != std::string::npos, line);
        CHECK(rows >= 3 * 9);  // three clouds or more, nine rows each
    }
}
