/// @file
/// Where the grid breaks: the same number of particles, ever more crowded.
#pragma once
#include <string>
#include <vector>

#include "05_spatial_grid/cloud.h"
#include "05_spatial_grid/methods.cuh"

namespace grid {

struct Crowd {
    std::string name;
    std::vector<float4> position;
};

/// Clouds of n points: even, drawn towards a corner (each coordinate u becomes u^2 and u^4), and all within
/// half a radius, so that one cell holds them.
inline std::vector<Crowd> crowds(std::uint32_t n, std::uint64_t seed, float radius_m) {
    const std::vector<float4> even = random_cloud(n, seed);
    Crowd second{"u^2", even}, fourth{"u^4", even}, one_cell{"one cell", even};
    for (float4& p : second.position) p = make_float4(p.x * p.x, p.y * p.y, p.z * p.z, 0);
    fourth.position = second.position;
    for (float4& p : fourth.position) p = make_float4(p.x * p.x, p.y * p.y, p.z * p.z, 0);
    for (float4& p : one_cell.position) {
        const float scale = 0.5f * radius_m;
        p = make_float4(scale * p.x, scale * p.y, scale * p.z, 0);
    }
    return {{"even", even}, second, fourth, one_cell};
}

struct Crowding {
    std::uint32_t fullest = 0;  ///< particles in the fullest cell
    double candidates_each = 0, neighbours_each = 0;
};

/// How crowded the grid's cells are, counted on the host.
inline Crowding crowding_of(const std::vector<float4>& points, const CellGrid& cells,
                            const std::vector<std::uint32_t>& neighbours) {
    std::vector<std::uint32_t> first(cells.cell_count() + 2, 0);
    for (const float4& p : points) ++first[cell_or_limbo(cells, p)];
    Crowding result;
    result.fullest = *std::max_element(first.begin(), first.end() - 2);
    patterns::exclusive_scan_cpu(first);
    const double n = double(points.size());
    for (const float4& p : points)
        for_each_row(cells, xyz(p), [&](std::uint32_t first_cell, std::uint32_t last_cell) {
            result.candidates_each += double(first[last_cell + 1] - first[first_cell]) / n;
        });
    for (const std::uint32_t count : neighbours) result.neighbours_each += double(count) / n;
    return result;
}

}  // namespace grid
