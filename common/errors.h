/// @file
/// The two ways a program of the course ends early on purpose. `Program::run` turns them into one clear
/// sentence and an exit code.
#pragma once
#include <stdexcept>
#include <string>

/// What the chapters stand on and never teach: options, errors, device memory, pictures, OpenGL.
namespace course {

/// What the user asked for can't be done: exit code 2.
struct BadInput : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The simulation left the range in which its numbers mean anything: exit code 3.
struct Unstable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace course
