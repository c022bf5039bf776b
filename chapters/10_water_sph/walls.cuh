/// @file
/// Walls as mirrors. Beyond a wall a particle would miss half of its neighbours; a mirror gives them back,
/// with the same density and pressure and with the velocity reversed across the wall, so that water slides
/// along it freely and nothing flows through it.
#pragma once
#include <cuda_runtime.h>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace sph {

/// Axis-parallel box that holds the water, in metres. At least one support radius wide along each axis: in a
/// narrower one mirrors would have to show mirrors.
struct Box {
    float3 low_m, high_m;
};

//! [for_each_image]
/// Calls visit(image, sign) for the point itself (sign = 1, 1, 1) and for its images in the walls nearer than
/// `reach`; in an edge that is one image more, in a corner four more. sign is -1 along the mirrored axes.
///
/// The mirrored neighbours of x are as far from x as the true neighbours are from the image of x. So a sum
/// over mirrored neighbours is the ordinary sum, done at the image: no mirrored particle is ever stored.
template <class Visit>
__host__ __device__ __forceinline__ void for_each_image(const Box& box, glm::vec3 x, float reach,
                                                        Visit visit) {
    const glm::vec3 low(box.low_m.x, box.low_m.y, box.low_m.z),
        high(box.high_m.x, box.high_m.y, box.high_m.z);
    const glm::vec3 to_low = x - low, to_high = high - x;
    const auto mirrors = [&](int axis) { return to_low[axis] < reach || to_high[axis] < reach; };
    // Far from every wall, as most particles are, there is nothing but the point itself.
    const int walls = mirrors(0) || mirrors(1) || mirrors(2) ? 1 : 0;
    for (int z = -walls; z <= walls; ++z)
        for (int y = -walls; y <= walls; ++y)
            for (int x_wall = -walls; x_wall <= walls; ++x_wall) {
                const glm::ivec3 wall(x_wall, y, z);  // -1: lower wall, 1: upper wall, 0: not mirrored
                glm::vec3 image = x, sign(1);
                bool in_reach = true;
                for (int axis = 0; axis < 3; ++axis) {
                    if (wall[axis] == 0) continue;
                    const float distance = wall[axis] < 0 ? to_low[axis] : to_high[axis];
                    in_reach = in_reach && distance < reach;
                    image[axis] += 2 * wall[axis] * distance;
                    sign[axis] = -1;
                }
                if (in_reach) visit(image, sign);
            }
}
//! [for_each_image]

}  // namespace sph
