/// @file
/// How crowded particles are, at any moment of any model: counted on the device with chapter 05's grid,
/// which is built for this alone.
#pragma once
#include "04_parallel_patterns/reduce.cuh"
#include "05_spatial_grid/neighbours.cuh"

namespace compared {

/// A sum and a largest, for chapter 04's tree.
struct SumAndLargest {
    struct Value {
        unsigned long long sum;
        std::uint32_t largest;
    };
    static __host__ __device__ Value nothing() { return {0, 0}; }
    static __host__ __device__ Value combine(Value a, Value b) {
        return {a.sum + b.sum, a.largest > b.largest ? a.largest : b.largest};
    }
};

struct CountsOfNeighbours {
    const std::uint32_t* count;
    __device__ SumAndLargest::Value operator[](std::uint32_t i) const { return {count[i], count[i]}; }
};

struct CountsOfCells {
    grid::CellRanges ranges;
    __device__ SumAndLargest::Value operator[](std::uint32_t cell) const {
        const std::uint32_t count = ranges.cell_last[cell] - ranges.cell_first[cell];
        return {count, count};
    }
};

/// What was counted.
struct Crowd {
    double mean_neighbours = 0;
    std::uint32_t most_neighbours = 0, fullest_cell = 0;
};

/// Counts neighbours closer than a radius, again and again, in memory made once.
class CrowdCounter {
  public:
    /// @param low_m, high_m  box in which the particles stay; one beyond it counts for the nearest cell
    CrowdCounter(std::uint32_t max_particles, glm::vec3 low_m, glm::vec3 high_m, float radius_m)
        : radius_m_(radius_m),
          cells_(grid::make_grid(low_m, high_m, radius_m, grid::max_cells_for(max_particles))),
          sort_(max_particles, cells_.cell_count()),
          sorted_(max_particles),
          count_(max_particles),
          of_particles_(max_particles),
          of_cells_(cells_.cell_count()) {}

    Crowd operator()(const float4* position, std::uint32_t n) {
        const std::uint32_t threads = 128, blocks = grid::blocks_for(n, threads);
        sort_.build(position, cells_, n);
        grid::gather_kernel<<<blocks, threads>>>(sorted_.data(), position, sort_.order(), n);
        CUDA_CHECK(cudaGetLastError());
        grid::neighbours_coherent_kernel<<<blocks, threads>>>(count_.data(), sorted_.data(), sort_.ranges(),
                                                              cells_, radius_m_, n);
        CUDA_CHECK(cudaGetLastError());
        of_particles_(CountsOfNeighbours{count_.data()}, n);
        of_cells_(CountsOfCells{sort_.ranges()}, cells_.cell_count());
        const auto neighbours = of_particles_.download();
        return {double(neighbours.sum) / n, neighbours.largest, of_cells_.download().largest};
    }

  private:
    float radius_m_;
    grid::CellGrid cells_;
    grid::CountingSort sort_;
    course::DeviceBuffer<float4> sorted_;
    course::DeviceBuffer<std::uint32_t> count_;
    patterns::TreeReduction<SumAndLargest> of_particles_, of_cells_;
};

}  // namespace compared
