/// @file
/// Position based fluids: no equation of state. Where a step would press particles together, pressures are
/// looked for that keep them apart: Macklin and Müller, "Position Based Fluids" (ACM TOG 32(4), 2013), with
/// the accumulated multipliers of Macklin, Müller and Chentanez, "XPBD" (MIG 2016).
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <glm/geometric.hpp>

#include "04_parallel_patterns/reduce.cuh"
#include "10_water_sph/sph.cuh"

namespace sph {

/// How hard position based fluids try. Each has the value that trials found to be good.
struct PbfChoice {
    float tolerance = 0.01f;   ///< of the compression, rho / rho0 - 1 where above 0, mean over all particles
    int max_corrections = 50;  ///< of a step; then the tolerance is missed, and the step says so
    float kept = 0.7f;         ///< part of the last step's pressure that the next step starts from
};

/// Part of Newton's step that a correction takes: each particle corrects as if its neighbours stood still,
/// and they don't. 1 shakes, 0.5 holds.
constexpr float kPbfRelaxation = 0.5f;

//! [spiky_gradient_norm]
/// Sum over the neighbours in a cubic lattice of (h^4 dW/dr)^2, W spiky. A particle at the surface has fewer
/// neighbours and a smaller sum, which would make its corrections larger than those of the water it rests
/// on; half of the lattice's sum is the least that is used.
inline float spiky_gradient_norm(double support_in_spacings) {
    const int reach = int(support_in_spacings);
    double sum = 0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z) {
                const double slope = spiky_slope(std::sqrt(x * x + y * y + z * z) / support_in_spacings);
                if (x != 0 || y != 0 || z != 0) sum += slope * slope;
            }
    return float(sum);
}
//! [spiky_gradient_norm]

/// Keeps a point in the box; the velocity loses its component into the wall that stopped it.
inline __host__ __device__ void stop_at_walls(const Box& box, glm::vec3& x, glm::vec3& v) {
    const glm::vec3 low(box.low_m.x, box.low_m.y, box.low_m.z),
        high(box.high_m.x, box.high_m.y, box.high_m.z);
    for (int axis = 0; axis < 3; ++axis) {
        if (x[axis] < low[axis]) {
            x[axis] = low[axis];
            v[axis] = 0;
        }
        if (x[axis] > high[axis]) {
            x[axis] = high[axis];
            v[axis] = 0;
        }
    }
}

/// Where particle i goes: into the columns that neighbours will read, and into the array of float4 that the
/// next sort, and everybody else, reads.
inline __host__ __device__ void set_place(grid::Columns<float> next, float4* position, std::uint32_t i,
                                          glm::vec3 x) {
    next.x[i] = x.x;
    next.y[i] = x.y;
    next.z[i] = x.z;
    position[i] = make_float4(x.x, x.y, x.z, 0.0f);
}

//! [predict_kernel]
/// One thread per particle: where would it go by its velocity, gravity, viscosity, and the part `kept` of the
/// last step's pressures? gravity_dt_s: the time that accelerations act, from the middle of the last step to
/// the middle of this one.
/// @param before    places of all
/// @param moves     velocities of all, which are not read, and need not exist, without viscosity
/// @param velocity  of this particle: changed
template <bool kViscous>
__global__ void predict_kernel(grid::Columns<float> next, float4* position, float4* velocity,
                               grid::Columns<const float> before, grid::Columns<const float> moves,
                               const float* multiplier, float kept, float dt_s, float gravity_dt_s,
                               grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid, Box box,
                               std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    glm::vec3 x = before[i], v = grid::xyz(velocity[i]);
    const float rho0 = fluid.rest_density_kg_per_m3;
    const float h = fluid.support_m, per_h = 1.0f / h, own = multiplier[i], kept_per_dt = kept / dt_s;
    const float friction = gravity_dt_s * fluid.viscosity_m2_per_s * rho0 * per_h;
    glm::vec3 sum(0);        // of both terms, but for the factor they share: mass / (rho0^2 h^4)
    if (grid::is_finite(x))  // else it sits in the limbo; the check of the state will report it
        for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3 sign) {
            const glm::vec3 image_v = sign * v;
            grid::LaneSum<float> sum_x, sum_y, sum_z;
            grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
                const std::uint32_t first = ranges.cell_first[first_cell];
                const std::uint32_t count = ranges.cell_last[last_cell] - first;
                grid::for_each_in_lanes(first, count, [&](int lane, std::ptrdiff_t k, bool mine) {
                    const float dx = image.x - before.x[k], dy = image.y - before.y[k],
                                dz = image.z - before.z[k];
                    const float r = sqrtf(dx * dx + dy * dy + dz * dz), q = r * per_h;
                    const float per_r = r > 0.0f ? 1.0f / r : 0.0f;
                    const float push = kept_per_dt * (own + multiplier[k]) * spiky_slope(q) * per_r;
                    float ax = push * dx, ay = push * dy, az = push * dz;
                    if constexpr (kViscous) {
                        const float drag = friction * viscosity_laplacian(q);
                        ax += drag * (moves.x[k] - image_v.x);
                        ay += drag * (moves.y[k] - image_v.y);
                        az += drag * (moves.z[k] - image_v.z);
                    }
                    sum_x.lane[lane] += mine ? ax : 0.0f;
                    sum_y.lane[lane] += mine ? ay : 0.0f;
                    sum_z.lane[lane] += mine ? az : 0.0f;
                });
            });
            sum += sign * glm::vec3(sum_x.total(), sum_y.total(), sum_z.total());
        });
    const float3 g = fluid.gravity_m_per_s2;
    v += gravity_dt_s * glm::vec3(g.x, g.y, g.z) +
         fluid.mass_kg / (rho0 * rho0) * per_h * per_h * per_h * per_h * sum;
    x += dt_s * v;
    stop_at_walls(box, x, v);
    set_place(next, position, i, x);
    velocity[i] = make_float4(v.x, v.y, v.z, 0.0f);
}
//! [predict_kernel]

//! [constraint_kernel]
/// One thread per particle, at the places where the particles would go: density there, and by how much this
/// particle's multiplier has to change for the density to come to rest. Neighbours are looked for in the
/// cells of the step's start: one that has come from farther is missed until the next step.
inline __global__ void constraint_kernel(float* density, float* multiplier, float* change, float kept,
                                         grid::Columns<const float> position, float least_norm,
                                         grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid, Box box,
                                         std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = position[i];
    if (!grid::is_finite(x)) {
        density[i] = x.x - x.x;
        multiplier[i] = change[i] = 0;
        return;
    }
    const float h = fluid.support_m, per_h = 1.0f / h;
    float sum = 0, squares = 0;  // of h^3 W; of (h^4 grad W)^2
    glm::vec3 gradient(0);
    for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3 sign) {
        grid::LaneSum<float> weights, slopes_squared, gradient_x, gradient_y, gradient_z;
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::uint32_t first = ranges.cell_first[first_cell];
            const std::uint32_t count = ranges.cell_last[last_cell] - first;
            grid::for_each_in_lanes(first, count, [&](int lane, std::ptrdiff_t k, bool mine) {
                const float dx = image.x - position.x[k], dy = image.y - position.y[k],
                            dz = image.z - position.z[k];
                const float r = sqrtf(dx * dx + dy * dy + dz * dz), q = r * per_h;
                const float per_r = r > 0.0f ? 1.0f / r : 0.0f;
                const float slope = r > 0.0f ? spiky_slope(q) : 0.0f, slope_per_r = slope * per_r;
                const float weight = poly6(q * q);
                weights.lane[lane] += mine ? weight : 0.0f;
                slopes_squared.lane[lane] += mine ? slope * slope : 0.0f;
                gradient_x.lane[lane] += mine ? slope_per_r * dx : 0.0f;
                gradient_y.lane[lane] += mine ? slope_per_r * dy : 0.0f;
                gradient_z.lane[lane] += mine ? slope_per_r * dz : 0.0f;
            });
        });
        sum += weights.total();
        squares += slopes_squared.total();
        gradient += sign * glm::vec3(gradient_x.total(), gradient_y.total(), gradient_z.total());
    });
    const float m = fluid.mass_kg, rho0 = fluid.rest_density_kg_per_m3;
    const float per_h4 = per_h * per_h * per_h * per_h;
    const float rho = m * sum * per_h * per_h * per_h;
    const float norm = fmaxf(least_norm, glm::dot(gradient, gradient) + squares);
    const float response = m / rho0 * per_h4 * (m / rho0 * per_h4) * norm;  // d rho / d multiplier
    // Water pushes and never pulls: what is taken back is at most what was given.
    const float start = kept * multiplier[i];
    change[i] = fmaxf(-start, kPbfRelaxation * (rho - rho0) / response);
    multiplier[i] = start + change[i];
    density[i] = rho;
}
//! [constraint_kernel]

//! [shift_kernel]
/// One thread per particle: moves it by the changes of the multipliers, its own and its neighbours'. The pair
/// terms are those of force_kernel, as symmetric, so momentum stays. per_dt_per_s: 1 / dt, and 0 when places
/// are to be put right without giving anybody velocity.
inline __global__ void shift_kernel(grid::Columns<float> next, float4* position, float4* velocity,
                                    grid::Columns<const float> before, const float* change,
                                    float per_dt_per_s, grid::CellRanges ranges, grid::CellGrid cells,
                                    Fluid fluid, Box box, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    glm::vec3 x = before[i], v = grid::xyz(velocity[i]);
    const float h = fluid.support_m, per_h = 1.0f / h, own = change[i];
    glm::vec3 push_sum(0);
    if (grid::is_finite(x))
        for_each_image(box, x, h, [&](glm::vec3 image, glm::vec3 sign) {
            grid::LaneSum<float> sum_x, sum_y, sum_z;
            grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
                const std::uint32_t first = ranges.cell_first[first_cell];
                const std::uint32_t count = ranges.cell_last[last_cell] - first;
                grid::for_each_in_lanes(first, count, [&](int lane, std::ptrdiff_t k, bool mine) {
                    const float dx = image.x - before.x[k], dy = image.y - before.y[k],
                                dz = image.z - before.z[k];
                    const float r = sqrtf(dx * dx + dy * dy + dz * dz);
                    const float per_r = r > 0.0f ? 1.0f / r : 0.0f;
                    const float push = (own + change[k]) * spiky_slope(r * per_h) * per_r;
                    sum_x.lane[lane] += mine ? push * dx : 0.0f;
                    sum_y.lane[lane] += mine ? push * dy : 0.0f;
                    sum_z.lane[lane] += mine ? push * dz : 0.0f;
                });
            });
            push_sum += sign * glm::vec3(sum_x.total(), sum_y.total(), sum_z.total());
        });
    const float m = fluid.mass_kg, rho0 = fluid.rest_density_kg_per_m3;
    const glm::vec3 shift = m / (rho0 * rho0) * per_h * per_h * per_h * per_h * push_sum;
    x += shift;
    v += per_dt_per_s * shift;
    stop_at_walls(box, x, v);
    set_place(next, position, i, x);
    velocity[i] = make_float4(v.x, v.y, v.z, 0.0f);
}
//! [shift_kernel]

//! [PbfSumming]
/// What a step has to know of all particles.
struct PbfSummary {
    double compression_sum;  ///< of rho / rho0 - 1 where above 0
    float highest_compression;
};

/// Two summaries as one, for chapter 04's tree. Sums are in double and in a fixed order, so that every run
/// takes the same number of corrections.
struct PbfSumming {
    using Value = PbfSummary;
    static __host__ __device__ PbfSummary nothing() { return {0, 0}; }
    static __host__ __device__ PbfSummary combine(const PbfSummary& a, const PbfSummary& b) {
        return {a.compression_sum + b.compression_sum, fmaxf(a.highest_compression, b.highest_compression)};
    }
};

/// The particles as an array of summaries of one particle each, none of which is ever stored.
struct PbfSummariesOfOne {
    const float* density;
    float rest_density_kg_per_m3;

    __device__ PbfSummary operator[](std::uint32_t i) const {
        const float compression = fmaxf(density[i] / rest_density_kg_per_m3 - 1, 0.0f);
        return {compression, compression};
    }
};
//! [PbfSumming]

}  // namespace sph
