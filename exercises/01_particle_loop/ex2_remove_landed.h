// Exercise 01.2: droplets that are gone.
//
// The fountain starts every droplet again, so its arrays are always full. A shower does not: a droplet that
// went through the floor is gone, and nobody wants to move it any longer. Keep the living ones together at
// the front.
#pragma once
#include "01_particle_loop/particle_loop.h"
#include "common/todo.h"

namespace particle_loop {

// Removes those of the first `count` droplets that are below the floor, y < 0, and returns how many are left;
// they are then the first ones. Their order does not matter, so a hole can be filled without moving all the
// others. What lies behind `count` is not looked at and stays as it is.
inline int remove_landed(ParticleArrays& particles, int count) {
    // TODO(1.2): fill each hole with the last living droplet. One pass, no second array. About 7 lines.
    (void)particles, (void)count;
    return course::kTodo;
}

}  // namespace particle_loop
