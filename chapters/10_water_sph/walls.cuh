/// @file
/// Walls as mirrors. Beyond a wall a particle would miss half of its neighbours; a mirror gives them back,
/// with the same density and pressure and with the velocity reversed across the wall, so that water slides
/// along it freely and nothing flows through it.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace sph {

//! [Wall]
/// What the two ends of an axis are.
enum class Wall : std::uint8_t {
    slip,      ///< a mirror: water glides along it, as at the scale of a tank
    no_slip,   ///< a mirror in which everything moves the other way: on average nothing moves at the wall, as
               ///< honey does not
    periodic,  ///< no wall: what leaves through one end comes in through the other
};

/// Axis-parallel box that holds the water, in metres. At least one support radius wide along each axis: in a
/// narrower one images would have to have images.
struct Box {
    float3 low_m, high_m;
    Wall wall[3] = {Wall::slip, Wall::slip, Wall::slip};
};
//! [Wall]

//! [for_each_image]
/// Calls visit(image, sign) for the point itself (sign = 1, 1, 1) and for its images in the walls nearer than
/// `reach`; in an edge that is one image more, in a corner four more. sign is -1 along the mirrored axes.
/// Where an axis is periodic, the image is the point moved by the width of the box.
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
                const glm::ivec3 wall(x_wall, y, z);  // -1: lower wall, 1: upper wall, 0: no image
                glm::vec3 image = x, sign(1);
                bool in_reach = true;
                for (int axis = 0; axis < 3; ++axis) {
                    if (wall[axis] == 0) continue;
                    const float distance = wall[axis] < 0 ? to_low[axis] : to_high[axis];
                    in_reach = in_reach && distance < reach;
                    if (box.wall[axis] == Wall::periodic) {  // near the lower end: seen beyond the upper one
                        image[axis] -= wall[axis] * (high[axis] - low[axis]);
                    } else {
                        image[axis] += 2 * wall[axis] * distance;
                        sign[axis] = -1;
                    }
                }
                if (in_reach) visit(image, sign);
            }
}
//! [for_each_image]

//! [velocity_sign]
/// How an image moves: the factors on the particle's velocity, from the `sign` of for_each_image. A mirror
/// turns the velocity across it around; one without slip turns around the others as well.
inline __host__ __device__ glm::vec3 velocity_sign(const Box& box, glm::vec3 sign) {
    glm::vec3 factor = sign;
    for (int axis = 0; axis < 3; ++axis)
        if (box.wall[axis] == Wall::no_slip && sign[axis] < 0) {
            factor = -factor;
            factor[axis] = -factor[axis];
        }
    return factor;
}
//! [velocity_sign]

//! [keep_inside]
/// What happens to a particle that a step has carried out of the box. Through a periodic end it comes in at
/// the other. At a wall it has met its own image: it ends where the image would be, as far inside as it got
/// outside, and loses the velocity into the wall. Stopping it *on* the wall would be a trap: there it and its
/// image are at one place, forces along the normal cancel, and it never comes off again.
inline __host__ __device__ void keep_inside(const Box& box, glm::vec3& x, glm::vec3& v) {
    const glm::vec3 low(box.low_m.x, box.low_m.y, box.low_m.z),
        high(box.high_m.x, box.high_m.y, box.high_m.z);
    for (int axis = 0; axis < 3; ++axis) {
        const float width = high[axis] - low[axis];
        if (x[axis] >= low[axis] && x[axis] <= high[axis]) continue;
        if (box.wall[axis] == Wall::periodic) {
            x[axis] -= width * floorf((x[axis] - low[axis]) / width);
        } else {
            x[axis] = 2 * (x[axis] < low[axis] ? low[axis] : high[axis]) - x[axis];
            v[axis] = 0;
        }
        // A step longer than the box, or a rounding: at least it stays inside. (NaN stays NaN.)
        if (x[axis] < low[axis]) x[axis] = low[axis];
        if (x[axis] > high[axis]) x[axis] = high[axis];
    }
}
//! [keep_inside]

}  // namespace sph
