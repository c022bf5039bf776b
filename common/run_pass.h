/// @file
/// How a time step runs its passes, so that whoever wants to know what each of them takes can bring a clock.
#pragma once

namespace course {

/// Runs a pass. Anything that can be called like this can take its place.
struct RunPass {
    template <class Pass>
    void operator()(const char* /*name*/, Pass pass) const {
        pass();
    }
};

}  // namespace course
