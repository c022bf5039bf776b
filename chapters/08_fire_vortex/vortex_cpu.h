/// @file
/// The CPU references: written to be read, in double, and every vorton with every point.
#pragma once
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "08_fire_vortex/blob.cuh"

namespace vortex {

/// Velocity (xyz) and buoyancy (w) at a point, from all vortons.
inline glm::dvec4 field_at_cpu(const std::vector<float4>& position, const std::vector<float4>& strength,
                               glm::dvec3 x_m, double core_m) {
    glm::dvec4 sum(0);
    for (std::size_t k = 0; k < position.size(); ++k) {
        const glm::dvec3 away = x_m - glm::dvec3(xyz(position[k]));
        const double s = glm::dot(away, away) + core_m * core_m;
        const double density = 15 / (8 * kPi) * std::pow(core_m, 4) / std::pow(s, 3.5);
        sum +=
            glm::dvec4(induced_velocity(glm::dvec3(xyz(strength[k])), away, core_m), strength[k].w * density);
    }
    return sum;
}

/// The same at the centres of all cells.
inline std::vector<float4> field_cpu(const std::vector<float4>& position, const std::vector<float4>& strength,
                                     const grid::CellGrid& cells, double core_m) {
    std::vector<float4> field;
    for (int z = 0; z < cells.size.z; ++z)
        for (int y = 0; y < cells.size.y; ++y)
            for (int x = 0; x < cells.size.x; ++x) {
                const glm::dvec3 centre =
                    glm::dvec3(cells.origin_m) + (glm::dvec3(x, y, z) + 0.5) / double(cells.cells_per_m);
                const glm::dvec4 f = field_at_cpu(position, strength, centre, core_m);
                field.push_back(make_float4(float(f.x), float(f.y), float(f.z), float(f.w)));
            }
    return field;
}

}  // namespace vortex
