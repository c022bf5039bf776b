/// \file
/// The value of everything an exercise has not written yet.
#pragma once

namespace course {

/// What an exercise's stub returns: as int and as float exactly the same number, impossible as a cell, a
/// count, a density or a coordinate of the course, so that no check passes by luck.
constexpr int kTodo = -999999;

}  // namespace course
