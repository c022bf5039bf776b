/// @file
/// Where the field is sampled: nodes of a cubic lattice, eight to the edge of a brick, eight bricks to the
/// edge of a region.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace surface {

//! [Lattice]
constexpr int kBrick = 8;                    ///< nodes along the edge of a brick
constexpr int kBrickRows = kBrick * kBrick;  ///< rows of nodes in a brick, each along x
constexpr int kBrickNodes = kBrick * kBrickRows;
constexpr int kRegion = 8;  ///< bricks along the edge of a region
constexpr int kRegionBricks = kRegion * kRegion * kRegion;
constexpr std::uint32_t kNone = 0xffffffffu;  ///< number of a brick that does not exist

/// Node (0, 0, 0) is at the origin. The lattice says where bricks could be; bricks.cuh, which of them are.
struct Lattice {
    glm::vec3 origin_m{0};
    float spacing_m = 1;  ///< of the nodes
    glm::ivec3 bricks{1};

    __host__ __device__ glm::ivec3 regions() const { return (bricks + (kRegion - 1)) / kRegion; }
    __host__ __device__ glm::vec3 place_m(glm::vec3 node) const { return origin_m + spacing_m * node; }
};
//! [Lattice]

/// Number of an item in a box of `size`, x fastest, and back.
inline __host__ __device__ std::uint32_t number_of(glm::ivec3 item, glm::ivec3 size) {
    return (std::uint32_t(item.z) * size.y + item.y) * size.x + item.x;
}
inline __host__ __device__ glm::ivec3 item_of(std::uint32_t number, glm::ivec3 size) {
    return {int(number % size.x), int(number / size.x % size.y), int(number / size.x / size.y)};
}

/// A box of bricks or regions, both corners included.
struct BrickBox {
    glm::ivec3 low, high;
};

//! [bricks_around]
/// The bricks that a particle at x_m needs: those with a node nearer than its reach, and those with a
/// neighbour of such a node, since a cell with one node inside wants all eight.
inline __host__ __device__ BrickBox bricks_around(const Lattice& lattice, glm::vec3 x_m, float reach_m) {
    const glm::vec3 at = (x_m - lattice.origin_m) / lattice.spacing_m;
    const float reach = reach_m / lattice.spacing_m;
    const glm::vec3 low = glm::floor(at - reach), high = glm::ceil(at + reach),
                    end(lattice.bricks * kBrick - 1);
    return {glm::ivec3(glm::clamp(low, glm::vec3(0), end)) / kBrick,
            glm::ivec3(glm::clamp(high, glm::vec3(0), end)) / kBrick};
}
//! [bricks_around]

template <class Visit>
inline __host__ __device__ void for_each(const BrickBox& box, Visit visit) {
    for (int z = box.low.z; z <= box.high.z; ++z)
        for (int y = box.low.y; y <= box.high.y; ++y)
            for (int x = box.low.x; x <= box.high.x; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace surface
