/// @file
/// The sanitizers' reports name kernel, block and thread, too.
#pragma once

namespace cudasim {

/// Nothing in builds without AddressSanitizer. Calling it also links the hooks that the others find by name.
void install_sanitizer_hooks();

}  // namespace cudasim
