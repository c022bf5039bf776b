#include "runtime/counting.h"
#include "runtime/poison.h"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#endif

namespace cudasim {

void poison_shared(void* begin, std::size_t bytes) {
    char* first = static_cast<char*>(begin);
#if defined(__SANITIZE_ADDRESS__)
    __asan_unpoison_memory_region(first, bytes);
    __asan_poison_memory_region(first - kRedZone, kRedZone);
    __asan_poison_memory_region(first + bytes, kRedZone);
#endif
    fill_with_poison(first, bytes);
    note_shared_memory(first, bytes);
}

}  // namespace cudasim
