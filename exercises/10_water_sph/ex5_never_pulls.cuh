// Exercise 10.5: water pushes and never pulls.
//
// Position based fluids correct the places of particles again and again, by a multiplier for each: its share
// of pressure. A particle whose density is too high needs a larger one, at most as much as
//
//     (rho - rho0) / response,        response = -d rho / d multiplier, which is above 0
//
// and one whose density is too low has too large a multiplier, or has none at all and is at the surface.
#pragma once
#include "10_water_sph/pbf.cuh"
#include "common/todo.h"

namespace sph {

// What one correction makes of a multiplier.
struct Correction {
    float multiplier;  // the new one
    float change;      // new - old: what particles are moved by now
};

// The next correction of a particle that has this multiplier by all corrections before. Its neighbours
// correct themselves at the same time, and that helps it too: it takes kPbfRelaxation of what it would need
// alone.
inline __host__ __device__ Correction corrected(float multiplier, float density, float rest_density,
                                                float response) {
    // TODO(10.5): the sum of all changes may never be below 0. A single change may. About 4 lines.
    (void)multiplier, (void)density, (void)rest_density, (void)response;
    return {course::kTodo, course::kTodo};
}

}  // namespace sph
