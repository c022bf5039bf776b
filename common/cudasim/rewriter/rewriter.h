/// @file
/// Turns CUDA C++ into C++: launches, shared memory, and includes of files that are not rewritten.
#pragma once
#include <string>

namespace cudasim {

/// The C++ for the CUDA source text of the file `path`. Line numbers stay, and compiler messages name `path`.
/// What cannot be understood becomes an `#error` at its line, so that only who compiles it stumbles.
std::string rewrite(const std::string& source, const std::string& path);

}  // namespace cudasim
