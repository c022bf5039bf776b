// Exercise 06.3: a camera that fits.
//
// How far away must a camera stand so that a box just fits into the picture? Too near cuts it off, too far
// wastes pixels. The direction is given, and the camera looks at the middle of the box.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "06_gl_interop/look.h"
#include "common/camera.h"
#include "common/todo.h"

namespace interop {

// The smallest distance from the middle of the box at which all eight corners are in the picture.
// `camera` gives the field of view and the direction in which its eye is from its target; `aspect` is width /
// height.
inline float fitting_distance_m(const Box& box, const course::Camera& camera, float aspect) {
    const float tan_up = std::tan(camera.field_of_view_rad / 2), tan_right = aspect * tan_up;
    const glm::mat3 turn(
        camera.view());  // world directions to the camera's: x right, y up, z towards the eye
    float distance_m = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 place(corner & 1 ? box.high_m.x : box.low_m.x,
                              corner & 2 ? box.high_m.y : box.low_m.y,
                              corner & 4 ? box.high_m.z : box.low_m.z);
        // TODO(6.3): the distance at which this corner lies on the picture's edge, sideways or up and down,
        // whichever needs more. A corner that is nearer to the eye than the middle needs more. About 3 lines.
        (void)place, (void)tan_right, (void)turn;
        distance_m = course::kTodo;
    }
    return distance_m;
}

}  // namespace interop
