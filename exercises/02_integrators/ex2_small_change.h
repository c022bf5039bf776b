// Exercise 02.2: a float that does not forget small change.
//
// A float has 24 bits. Adding 0.001 to 900 drops most of them: a million times 0.001f makes 991, and that is
// the floor that every method of this chapter meets in float. But what an addition dropped can be computed,
// exactly, by three more additions, and paid back with the next. (W. Kahan, 1965.)
#pragma once
#include "common/todo.h"

namespace integrators {

// A number that grows by small steps.
struct SmallChange {
    float value = 0;
    float owed = 0;  // what was dropped so far, and has to be added yet

    void add(float change) {
        // TODO(2.2): add the change and what is owed; then find out what this addition dropped, and owe that.
        // About 4 lines.
        (void)change;
        value = course::kTodo;
    }
};

// An oscillator, x'' = -omega^2 x, by leapfrog: kick half a step, drift, kick half a step.
struct RememberingOscillator {
    SmallChange x, v;
};

inline void step_remembering(RememberingOscillator& s, float omega_per_s, float dt_s) {
    // TODO(2.2): leapfrog, where each of the three updates is an add(). About 4 lines.
    (void)omega_per_s, (void)dt_s;
    s.x.value = s.v.value = course::kTodo;
}

}  // namespace integrators
