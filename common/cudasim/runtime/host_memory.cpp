#include "runtime/host_memory.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace cudasim {
namespace {

/// The number behind `word` in a text file (the first number if `word` is empty); `fallback` if there is
/// none.
std::size_t number_in(const char* path, const char* word, std::size_t fallback) {
    std::FILE* file = std::fopen(path, "r");
    if (!file) return fallback;
    std::size_t number = fallback;
    char line[128];
    while (std::fgets(line, sizeof line, file)) {
        const std::size_t length = std::strlen(word);
        if (std::strncmp(line, word, length) != 0) continue;
        char* end = nullptr;
        const unsigned long long parsed = std::strtoull(line + length, &end, 10);
        if (end != line + length) number = static_cast<std::size_t>(parsed);
        break;
    }
    std::fclose(file);
    return number;
}

std::size_t memory_of_machine() {
    return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// What a container may use (control groups, version 2): often less than the machine has.
std::size_t limit_of_container() {
    return number_in("/sys/fs/cgroup/memory.max", "", SIZE_MAX);
}

std::size_t used_by_container() {
    const std::size_t used = number_in("/sys/fs/cgroup/memory.current", "", 0);
    const std::size_t file_cache = number_in("/sys/fs/cgroup/memory.stat", "inactive_file ", 0);
    return used - std::min(used, file_cache);  // the cache gives way when memory is wanted
}

}  // namespace

std::size_t total_host_memory() {
    static const std::size_t total = std::min(memory_of_machine(), limit_of_container());
    return total;
}

std::size_t available_host_memory() {
    const std::size_t kilobytes = number_in("/proc/meminfo", "MemAvailable:", memory_of_machine() / 1024);
    const std::size_t limit = limit_of_container();
    if (limit == SIZE_MAX) return kilobytes * 1024;
    return std::min(kilobytes * 1024, limit - std::min(limit, used_by_container()));
}

}  // namespace cudasim
