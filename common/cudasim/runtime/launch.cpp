// What happens at `kernel<<<grid, block, shared>>>(arguments)`.
#include "cudasim/host_access.h"
#include "runtime/allocations.h"
#include "runtime/errors.h"
#include "runtime/faults.h"
#include "runtime/host_call.h"
#include "runtime/limits.h"
#include "runtime/race_check.h"
#include "runtime/recording.h"
#include "runtime/report.h"
#include "runtime/settings.h"
#include "runtime/worker_pool.h"

namespace cudasim {
namespace {

/// Empty, or what no GPU could launch.
std::string check_size(const char* what, dim3 size, dim3 largest) {
    if (size.x == 0 || size.y == 0 || size.z == 0)
        return std::string("the ") + what + " " + text_of(uint3(size)) + " is empty";
    if (size.x > largest.x || size.y > largest.y || size.z > largest.z)
        return std::string("the ") + what + " " + text_of(uint3(size)) + " is larger than " +
               text_of(uint3(largest));
    return "";
}

std::string check_configuration(const LaunchRequest& request) {
    for (const std::string& why :
         {check_size("grid", request.grid, kMaxGrid), check_size("block", request.block, kMaxBlock)})
        if (!why.empty()) return why;
    const std::uint64_t threads = std::uint64_t{request.block.x} * request.block.y * request.block.z;
    if (threads > kMaxThreadsPerBlock)
        return std::to_string(threads) + " threads in a block, but the limit is " +
               std::to_string(kMaxThreadsPerBlock);
    return "";
}

void refuse(const LaunchRequest& request, cudaError_t error, const std::string& why) {
    say("cannot launch " + text_of(request) + ": " + why);
    set_launch_error(request, error);
}

}  // namespace

bool run_in_order(const LaunchRequest& request, Order order, unsigned workers) {
    Grid grid(request, order, workers);
    WorkerPool::instance().run(grid, workers);
    note_counts(grid.counts);
    return !grid.failed;
}

void run_grid(const LaunchRequest& request) {
    const HostCall call("a kernel launch");
    const std::string why = check_configuration(request);
    if (!why.empty()) return refuse(request, cudaErrorInvalidConfiguration, why);
    if (request.shared_bytes > kSharedLimit)  // CUDA has another code for this
        return refuse(request, cudaErrorInvalidValue,
                      std::to_string(request.shared_bytes) +
                          " bytes of dynamic shared memory, but the limit is " +
                          std::to_string(kSharedLimit));
    note_launch(request);
    const HostAccess for_the_kernel;
    report_faults();
    const bool good = checks_races() ? run_in_all_orders(request)
                                     : run_in_order(request, settings().order, settings().workers);
    if (!good) set_launch_error(request, cudaErrorLaunchFailure);
}

bool check_argument(const LaunchRequest& request, int number, const void* pointer) {
    if (!pointer) return true;
    const HostCall call("a kernel launch");
    if (Allocations::all().find(pointer)) return true;
    refuse(request, cudaErrorIllegalAddress,
           "argument " + std::to_string(number) +
               " points to no device memory: it is host memory, or was freed\n"
               "a kernel works on what cudaMalloc made and cudaMemcpy filled");
    return false;
}

}  // namespace cudasim
