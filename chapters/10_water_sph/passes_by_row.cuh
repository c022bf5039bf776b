/// @file
/// The two passes as one writes them first: each row of cells is a loop of its own, over vectors kept as
/// float4 or as columns. What study `speed` compares the chapter's passes with.
#pragma once
#include "10_water_sph/sph.cuh"

namespace sph {

/// Vectors as an array of float4. The columns of a grid::Columns are read the same way: x[k], y[k], z[k].
struct Float4s {
    struct Component {
        const float* first;
        __host__ __device__ float operator[](std::ptrdiff_t k) const { return first[4 * k]; }
    } x, y, z;

    explicit Float4s(const float4* v) : x{&v->x}, y{&v->y}, z{&v->z} {}
    __host__ __device__ glm::vec3 operator[](std::uint32_t k) const { return {x[k], y[k], z[k]}; }
};

//! [density_by_row_kernel]
/// density_kernel, with a sum for each row. @tparam Vectors  Float4s or grid::Columns<const float>
template <class Vectors>
__global__ void density_by_row_kernel(float* density, float* pressure_term, Vectors position,
                                      grid::CellRanges ranges, grid::CellGrid cells, Fluid fluid, Box box,
                                      std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float h = fluid.support_m, per_h_squared = 1.0f / (h * h);
    float sum = 0;
    for_each_image(box, position[i], h, [&](glm::vec3 image, glm::vec3) {
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::ptrdiff_t first = ranges.cell_first[first_cell], end = ranges.cell_last[last_cell];
            float row = 0;
#pragma omp simd reduction(+ : row)
            for (std::ptrdiff_t k = first; k < end; ++k) {
                const float dx = image.x - position.x[k], dy = image.y - position.y[k],
                            dz = image.z - position.z[k];
                row += poly6((dx * dx + dy * dy + dz * dz) * per_h_squared);
            }
            sum += row;
        });
    });
    density[i] = fluid.mass_kg * sum / (h * h * h);
    pressure_term[i] = pressure_of<EquationOfState::linear>(fluid, density[i]) / (density[i] * density[i]);
}
//! [density_by_row_kernel]

/// force_kernel<true>, with sums for each row.
template <class Vectors>
__global__ void force_by_row_kernel(float4* acceleration, Vectors position, Vectors velocity,
                                    const float* density, const float* pressure_term, grid::CellRanges ranges,
                                    grid::CellGrid cells, Fluid fluid, Box box, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float h = fluid.support_m, per_h = 1.0f / h, own_term = pressure_term[i];
    const float friction = fluid.viscosity_m2_per_s * fluid.rest_density_kg_per_m3 * per_h / density[i];
    glm::vec3 sum(0);
    for_each_image(box, position[i], h, [&](glm::vec3 image, glm::vec3 sign) {
        const glm::vec3 v = sign * velocity[i];
        grid::for_each_row(cells, image, [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            const std::ptrdiff_t first = ranges.cell_first[first_cell], end = ranges.cell_last[last_cell];
            float ax = 0, ay = 0, az = 0;
#pragma omp simd reduction(+ : ax, ay, az)
            for (std::ptrdiff_t k = first; k < end; ++k) {
                const float dx = image.x - position.x[k], dy = image.y - position.y[k],
                            dz = image.z - position.z[k];
                const float r = sqrtf(dx * dx + dy * dy + dz * dz), q = r * per_h;
                const float per_r = r > 0.0f ? 1.0f / r : 0.0f;
                const float push = (own_term + pressure_term[k]) * spiky_slope(q) * per_r;
                const float drag = friction * viscosity_laplacian(q) / density[k];
                ax += push * dx + drag * (velocity.x[k] - v.x);
                ay += push * dy + drag * (velocity.y[k] - v.y);
                az += push * dz + drag * (velocity.z[k] - v.z);
            }
            sum += sign * glm::vec3(ax, ay, az);
        });
    });
    const glm::vec3 a = fluid.mass_kg * per_h * per_h * per_h * per_h * sum;
    const float3 g = fluid.gravity_m_per_s2;
    acceleration[i] = make_float4(a.x + g.x, a.y + g.y, a.z + g.z, 0.0f);
}

}  // namespace sph
