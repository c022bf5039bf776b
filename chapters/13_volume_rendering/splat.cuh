/// @file
/// From particles to a grid: each one spreads its soot and its heat over the cells around it. Sums are of
/// integers, so that nothing is lost and the order of the particles, which is a matter of luck, does not
/// show.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <string>
#include <vector>

#include "05_spatial_grid/cell_grid.cuh"
#include "05_spatial_grid/counting_sort.cuh"
#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "common/errors.h"

namespace volume {

using grid::CellGrid;

/// What a particle of one kind carries; each value goes linearly from its birth to its death.
struct Cargo {
    float radius_m[2]{0.04f, 0.04f};
    float soot_kg[2]{0, 0};
    float heat_K_m3[2]{0, 0};  ///< temperature above the air's, times the volume of the particle's hot gas
    float fade_in = 0.1f;      ///< part of the life in which soot and heat appear...
    float fade_out = 0.2f;     ///< ...and in which they go
};
constexpr int kMaxCargos = 4;

/// The cargo of all kinds; those of chapter 07's fire, in its order.
struct Cargos {
    int count = 0;
    Cargo cargo[kMaxCargos];
    std::uint32_t first[kMaxCargos]{};  ///< particle number at which kind k begins
};

/// One unit of the integer sums: small enough that its rounding is never seen.
struct Quantum {
    double soot_kg = 1e-15, heat_K_m3 = 1e-9;
};

/// What one particle puts into the grid.
struct Deposit {
    glm::vec3 centre_m{0};
    float radius_m = 0;
    unsigned long long soot = 0, heat = 0;  ///< in quanta
};

//! [deposit]
/// @param position xyz in m, w the age in s; @param life_s as in chapter 07
/// @returns a deposit of nothing for particles that are not alive, or whose numbers are not finite
__host__ __device__ inline Deposit deposit_of(const Cargos& cargos, std::uint32_t id, float4 position,
                                              float life_s, Quantum quantum) {
    Deposit d;
    const float age_s = position.w;
    if (!grid::is_finite(grid::xyz(position)) || !(age_s >= 0 && age_s < life_s)) return d;
    int k = 0;
    while (k + 1 < cargos.count && id >= cargos.first[k + 1]) ++k;
    const Cargo& cargo = cargos.cargo[k];
    const float burnt = age_s / life_s;
    const auto now = [&](const float(&value)[2]) { return value[0] + burnt * (value[1] - value[0]); };
    float there = 1;
    if (burnt < cargo.fade_in) there = burnt / cargo.fade_in;
    if (1 - burnt < cargo.fade_out) there *= (1 - burnt) / cargo.fade_out;
    d.centre_m = grid::xyz(position);
    d.radius_m = now(cargo.radius_m);
    d.soot = (unsigned long long)(double(there * now(cargo.soot_kg)) / quantum.soot_kg + 0.5);
    d.heat = (unsigned long long)(double(there * now(cargo.heat_K_m3)) / quantum.heat_K_m3 + 0.5);
    return d;
}
//! [deposit]

constexpr int kMaxSpread = 32;  ///< cells along an axis that one particle reaches

//! [axis_weights]
/// How a particle spreads along one axis: weights of successive cells, together 1.
struct AxisWeights {
    int first = 0, count = 0;
    float weight[kMaxSpread];
};

/// A soft hump, (1 - u^2)^2, over the cells whose centres are nearer than the radius. The radius is at least
/// a cell: a particle smaller than that is shared by two cells, and does not jump from one to the next. At
/// the grid's rim the cells that are there get all of it.
__host__ __device__ inline AxisWeights axis_weights(float place_cells, float radius_cells, int cells) {
    AxisWeights w;
    const float radius = radius_cells > 1 ? radius_cells : 1.0f, centre = place_cells - 0.5f;
    int low = int(std::ceil(centre - radius)), high = int(std::floor(centre + radius));
    if (low < 0) low = 0;
    if (high > cells - 1) high = cells - 1;
    if (high - low >= kMaxSpread) high = low + kMaxSpread - 1;
    float sum = 0;
    w.first = low;
    for (int c = low; c <= high; ++c) {
        const float u = (float(c) - centre) / radius, hump = 1 - u * u;
        w.weight[w.count] = hump > 0 ? hump * hump : 0.0f;
        sum += w.weight[w.count++];
    }
    for (int k = 0; k < w.count; ++k) w.weight[k] /= sum;
    return w;
}
//! [axis_weights]

/// Is the particle's centre inside the grid? What is outside is not splatted: no picture shows it.
__host__ __device__ inline bool inside(const CellGrid& cells, glm::vec3 x_m) {
    const glm::vec3 place = (x_m - cells.origin_m) * cells.cells_per_m, end(cells.size);
    return place.x >= 0 && place.y >= 0 && place.z >= 0 && place.x < end.x && place.y < end.y &&
           place.z < end.z;
}

//! [spread]
/// Calls add(cell, soot, heat) for the cells around a deposit. The shares are rounded to whole quanta; the
/// last cell gets what is left, so that together they are what the particle carries, to the last quantum.
template <class Add>
__host__ __device__ inline void spread(const CellGrid& cells, const Deposit& d, const Add& add) {
    const glm::vec3 place = (d.centre_m - cells.origin_m) * cells.cells_per_m;
    const float radius = d.radius_m * cells.cells_per_m;
    const AxisWeights wx = axis_weights(place.x, radius, cells.size.x);
    const AxisWeights wy = axis_weights(place.y, radius, cells.size.y);
    const AxisWeights wz = axis_weights(place.z, radius, cells.size.z);
    // Shares are cut between running sums: share k is cut(k + 1) - cut(k), and the last cut is the whole.
    double before = 0;
    unsigned long long soot_before = 0, heat_before = 0;
    for (int k = 0; k < wz.count; ++k)
        for (int j = 0; j < wy.count; ++j) {
            const float row = wz.weight[k] * wy.weight[j];
            const std::uint32_t first = grid::cell_number(cells, {wx.first, wy.first + j, wz.first + k});
            for (int i = 0; i < wx.count; ++i) {
                before += double(row * wx.weight[i]);
                const bool last = i + 1 == wx.count && j + 1 == wy.count && k + 1 == wz.count;
                const double part = last || before > 1 ? 1.0 : before;
                const auto soot = (unsigned long long)(part * double(d.soot));
                const auto heat = (unsigned long long)(part * double(d.heat));
                add(first + i, soot - soot_before, heat - heat_before);
                soot_before = soot;
                heat_before = heat;
            }
        }
}
//! [spread]

//! [splat_kernel]
/// One thread per particle. Sums of integers are the same in any order, so atomics are deterministic here.
inline __global__ void splat_kernel(unsigned long long* soot, unsigned long long* heat,
                                    const float4* position, const float4* velocity, std::uint32_t n,
                                    Cargos cargos, CellGrid cells, Quantum quantum) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const Deposit d = deposit_of(cargos, i, position[i], velocity[i].w, quantum);
    if ((d.soot == 0 && d.heat == 0) || !inside(cells, d.centre_m)) return;
    spread(cells, d, [&](std::uint32_t cell, unsigned long long some_soot, unsigned long long some_heat) {
        if (some_soot > 0) atomicAdd(&soot[cell], some_soot);
        if (some_heat > 0) atomicAdd(&heat[cell], some_heat);
    });
}
//! [splat_kernel]

/// How much light soot takes and how hot gas gets: from sums to what the march reads.
struct Gas {
    float extinction_m2_per_kg =
        8700;  ///< of soot: near this value for most fuels (Mulholland and Croarkin, 2000)
    float air_K = 300;
    float flame_K = 2000;  ///< as hot as this flame gets, where nothing but hot gas is
};

//! [field]
/// Extinction (1/m) and temperature (K) of a cell. Hot gas mixes with the air there is: with much air it
/// hardly warms it, and no amount of it gets hotter than the flame.
__host__ __device__ inline float2 field_value(const Gas& gas, double soot_kg, double heat_K_m3,
                                              double volume_m3) {
    const float rise = gas.flame_K - gas.air_K;
    const float unmixed = float(heat_K_m3 / volume_m3);
    return make_float2(gas.extinction_m2_per_kg * float(soot_kg / volume_m3),
                       gas.air_K + rise * (1 - std::exp(-unmixed / rise)));
}

/// One thread per cell.
inline __global__ void field_kernel(float2* field, const unsigned long long* soot,
                                    const unsigned long long* heat, std::uint32_t cell_count, Gas gas,
                                    Quantum quantum, double volume_m3) {
    const std::uint32_t c = blockIdx.x * blockDim.x + threadIdx.x;
    if (c >= cell_count) return;
    field[c] =
        field_value(gas, double(soot[c]) * quantum.soot_kg, double(heat[c]) * quantum.heat_K_m3, volume_m3);
}
//! [field]

// ------------------------------------------------------------------------------------------- on the host

/// A grid of cubic cells over a box. @throws BadInput if there are too many, or the box makes no sense
inline CellGrid grid_over(glm::vec3 low_m, glm::vec3 high_m, float cell_m) {
    const glm::dvec3 extent = glm::dvec3(high_m) - glm::dvec3(low_m);
    if (!(cell_m > 0) || !(extent.x > 0 && extent.y > 0 && extent.z > 0) ||
        !(extent.x + extent.y + extent.z < 1e30))
        throw course::BadInput("a volume needs a box with an inside, and cells larger than 0");
    const glm::dvec3 size = glm::ceil(extent / double(cell_m) - 1e-6);
    if (!(size.x * size.y * size.z <= double(1u << 28)))
        throw course::BadInput("cells of " + std::to_string(cell_m) +
                               " m make more than 268,435,456 of them: take larger ones");
    return {low_m, float(1.0 / double(cell_m)), glm::max(glm::ivec3(size), glm::ivec3(1))};
}

/// Sums of soot and heat in quanta, cell by cell: what the device and the reference both make.
struct Sums {
    std::vector<unsigned long long> soot, heat;
};

/// Adds without atomics: for one thread.
struct AddAlone {
    unsigned long long *soot, *heat;
    __host__ __device__ void operator()(std::uint32_t cell, unsigned long long some_soot,
                                        unsigned long long some_heat) const {
        soot[cell] += some_soot;
        heat[cell] += some_heat;
    }
};

/// CPU reference of splat_kernel: one loop.
inline Sums splat_cpu(const std::vector<float4>& position, const std::vector<float4>& velocity,
                      const Cargos& cargos, const CellGrid& cells, Quantum quantum) {
    Sums sums{std::vector<unsigned long long>(cells.cell_count()),
              std::vector<unsigned long long>(cells.cell_count())};
    for (std::uint32_t i = 0; i < position.size(); ++i) {
        const Deposit d = deposit_of(cargos, i, position[i], velocity[i].w, quantum);
        if (inside(cells, d.centre_m)) spread(cells, d, AddAlone{sums.soot.data(), sums.heat.data()});
    }
    return sums;
}

//! [Splatter]
/// A grid on the device that particles are splatted into, again and again.
class Splatter {
  public:
    Splatter(const CellGrid& cells, const Gas& gas, Quantum quantum = {})
        : cells_(cells),
          gas_(gas),
          quantum_(quantum),
          soot_(cells.cell_count()),
          heat_(cells.cell_count()),
          field_(cells.cell_count()) {}

    /// @throws course::BadInput if a particle reaches over too many cells, or carries what makes no sense
    void splat(const float4* position, const float4* velocity, std::uint32_t n, const Cargos& cargos) {
        check(cargos);
        CUDA_CHECK(cudaMemset(soot_.data(), 0, soot_.bytes()));
        CUDA_CHECK(cudaMemset(heat_.data(), 0, heat_.bytes()));
        if (n > 0) {
            splat_kernel<<<grid::blocks_for(n, kThreads), kThreads>>>(soot_.data(), heat_.data(), position,
                                                                      velocity, n, cargos, cells_, quantum_);
            CUDA_CHECK(cudaGetLastError());
        }
        const double edge_m = 1.0 / double(cells_.cells_per_m);
        field_kernel<<<grid::blocks_for(cells_.cell_count(), kThreads), kThreads>>>(
            field_.data(), soot_.data(), heat_.data(), cells_.cell_count(), gas_, quantum_,
            edge_m * edge_m * edge_m);
        CUDA_CHECK(cudaGetLastError());
    }

    const CellGrid& cells() const { return cells_; }
    const float2* field() const { return field_.data(); }
    Sums sums() const { return {soot_.download(), heat_.download()}; }
    std::vector<float2> download() const { return field_.download(); }
    /// Device memory of a cell: two sums and the field.
    static constexpr std::size_t kBytesPerCell = 2 * sizeof(unsigned long long) + sizeof(float2);
    static constexpr std::uint32_t kThreads = 128;

  private:
    void check(const Cargos& cargos) const {
        const float cells_per_m = cells_.cells_per_m;
        for (int k = 0; k < cargos.count; ++k)
            for (int end = 0; end < 2; ++end) {
                const Cargo& cargo = cargos.cargo[k];
                const float radius_m = cargo.radius_m[end];
                if (!(radius_m >= 0 && 2 * radius_m * cells_per_m + 1 <= float(kMaxSpread)))
                    throw course::BadInput("a particle of radius " + std::to_string(radius_m) +
                                           " m reaches over " + std::to_string(kMaxSpread) + " cells of " +
                                           std::to_string(1 / cells_per_m) + " m or more: take larger cells");
                // 2^24 particles with so much of it each still fit into a 64-bit sum.
                const double soot = double(cargo.soot_kg[end]) / quantum_.soot_kg;
                const double heat = double(cargo.heat_K_m3[end]) / quantum_.heat_K_m3;
                if (!(soot >= 0 && soot <= 1e12 && heat >= 0 && heat <= 1e12))
                    throw course::BadInput(
                        "a particle carries soot from 0 to 1 g, and heat from 0 to 1000 K m^3");
            }
    }

    CellGrid cells_;
    Gas gas_;
    Quantum quantum_;
    course::DeviceBuffer<unsigned long long> soot_, heat_;
    course::DeviceBuffer<float2> field_;
};
//! [Splatter]

}  // namespace volume
