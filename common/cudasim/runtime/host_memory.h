/// @file
/// How much memory this machine has.
#pragma once
#include <cstddef>

namespace cudasim {

std::size_t total_host_memory();
/// What can be allocated and used now without the system running out.
std::size_t available_host_memory();

}  // namespace cudasim
