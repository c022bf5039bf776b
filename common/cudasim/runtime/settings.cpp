#include "runtime/settings.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

namespace cudasim {
namespace {

[[noreturn]] void reject(const char* name, const char* value, const char* expected) {
    std::fprintf(stderr, "cudasim: %s is '%s', but it must be %s\n", name, value, expected);
    std::fflush(nullptr);
    std::_Exit(2);  // without destructors: they would ask for the settings again
}

unsigned number(const char* name, unsigned fallback, unsigned least, const char* expected) {
    const char* value = std::getenv(name);
    if (!value || !*value) return fallback;
    char* end = nullptr;
    const long parsed = std::strtol(value, &end, 10);
    if (*end || parsed < static_cast<long>(least) || parsed > 1024) reject(name, value, expected);
    return static_cast<unsigned>(parsed);
}

Order order_from_environment() {
    constexpr const char* kName = "CUDASIM_ORDER";
    constexpr const char* kExpected = "forward, reverse, shuffled or shuffled:seed";
    const char* value = std::getenv(kName);
    if (!value || !*value || !std::strcmp(value, "forward")) return {Order::kForward, 1};
    if (!std::strcmp(value, "reverse")) return {Order::kReverse, 1};
    if (!std::strcmp(value, "shuffled")) return {Order::kShuffled, 1};
    if (std::strncmp(value, "shuffled:", 9) || !value[9]) reject(kName, value, kExpected);
    char* end = nullptr;
    const unsigned long seed = std::strtoul(value + 9, &end, 10);
    if (*end) reject(kName, value, kExpected);
    return {Order::kShuffled, static_cast<unsigned>(seed)};
}

// More do not help kernels of the course's size, and each wants a stack for each thread of a block: the
// number of memory mappings of a process is limited (65530 by default on Linux).
constexpr unsigned kUsualWorkers = 16;

unsigned default_workers() {
    return std::clamp(std::thread::hardware_concurrency(), 1u, kUsualWorkers);
}

}  // namespace

Settings& settings() {
    static Settings settings = {
        number("CUDASIM_THREADS", default_workers(), 1, "a number from 1 to 1024"),
        order_from_environment(),
        number("CUDASIM_RACECHECK", 0, 0, "0 or 1") != 0,
        static_cast<int>(number("CUDASIM_LEAK_EXIT", 0, 0, "an exit code from 0 to 255")),
    };
    return settings;
}

OrderScope::OrderScope(Order order) : before_(settings().order) {
    settings().order = order;
}
OrderScope::~OrderScope() {
    settings().order = before_;
}
WorkerScope::WorkerScope(unsigned workers) : before_(settings().workers) {
    settings().workers = workers < before_ ? workers : before_;
}
WorkerScope::~WorkerScope() {
    settings().workers = before_;
}

}  // namespace cudasim
