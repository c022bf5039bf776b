// What cuda_gl_interop.h needs of the runtime. The OpenGL calls are all there: the runtime does not link
// OpenGL.
#include "cudasim/graphics_memory.h"

#include "runtime/allocations.h"
#include "runtime/host_call.h"
#include "runtime/poison.h"
#include "runtime/report.h"

namespace cudasim {

void add_graphics_memory(void* begin, std::size_t bytes, bool discard) {
    const HostCall call("cudaGraphicsMapResources");
    if (discard) fill_with_poison(begin, bytes);
    Allocations::all().add_foreign(begin, bytes, MemoryKind::kGraphics);
}

void remove_graphics_memory(void* begin) {
    const HostCall call("cudaGraphicsUnmapResources");
    if (const Allocation* found = Allocations::all().find_begin(begin)) Allocations::all().remove(*found);
}

cudaError_t refuse_graphics(cudaError_t error, const char* call, const char* why) {
    say(std::string(call) + ": " + why);
    return set_last_error(error);
}

}  // namespace cudasim
