/// @file
/// What tests can ask the CUDA simulator: which kernels ran, how much memory is allocated, and whether a
/// kernel's result depends on the order of its threads. Simulator builds only (`#ifdef __CUDASIM__`).
#pragma once
#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Runs CUDA kernels on the CPU. Tests see what was launched and allocated; chapters know nothing of it.
namespace cudasim {

/// What a launch did, counted one by one. Loads, stores and atomics are seen in targets that CMake builds
/// with COUNT_ACCESSES (course_target()) and are 0 elsewhere; barriers and warp operations are counted
/// always.
struct Counts {
    std::uint64_t global_loads = 0, global_stores = 0;
    std::uint64_t global_bytes = 0;  ///< of these loads and stores
    std::uint64_t shared_loads = 0, shared_stores = 0;
    std::uint64_t global_atomics = 0, shared_atomics = 0;
    std::uint64_t barriers = 0;         ///< of blocks: one when all threads of a block have met
    std::uint64_t warp_operations = 0;  ///< of warps: one when all lanes of a warp have met

    Counts& operator+=(const Counts& other);
};

/// One kernel launch.
struct Launch {
    std::string kernel;  ///< text at the launch, for instance "forces_kernel<true>"
    dim3 grid, block;
    std::size_t shared_bytes;  ///< dynamic shared memory
    Counts counts{};
};

/// Notes launches and allocations while it lives.
class Recording {
  public:
    Recording();
    ~Recording();
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    /// Launches in their order; those that failed are left out.
    const std::vector<Launch>& launches() const { return launches_; }
    /// Launches of kernels whose text starts with `kernel_prefix`.
    std::size_t count(const std::string& kernel_prefix) const;
    /// cudaMalloc calls since construction, freed since or not.
    std::size_t allocations() const { return allocations_; }
    /// Bytes those calls asked for.
    std::size_t bytes() const { return bytes_; }

    /// Of all launches together.
    Counts counts() const;

    void note_launch(const Launch& launch) { launches_.push_back(launch); }
    void note_counts(const Counts& counts) { launches_.back().counts = counts; }
    void note_allocation(std::size_t bytes);

  private:
    std::vector<Launch> launches_;
    std::size_t allocations_ = 0, bytes_ = 0;
};

/// Device memory allocated now.
std::size_t live_bytes();
std::size_t live_allocations();

/// Order in which the threads of a block, and the blocks of a grid, start. On a GPU there is none to rely on.
struct Order {
    enum Kind { kForward, kReverse, kShuffled };
    Kind kind = kForward;
    unsigned seed = 1;  ///< for kShuffled: the same seed gives the same order
};

/// Launches while it lives run in this order. From the environment:
/// CUDASIM_ORDER=forward|reverse|shuffled[:seed].
class OrderScope {
  public:
    explicit OrderScope(Order order);
    ~OrderScope();
    OrderScope(const OrderScope&) = delete;
    OrderScope& operator=(const OrderScope&) = delete;

  private:
    Order before_;
};

/// Launches while it lives use at most this many workers. From the environment: CUDASIM_THREADS=n.
class WorkerScope {
  public:
    explicit WorkerScope(unsigned workers);
    ~WorkerScope();
    WorkerScope(const WorkerScope&) = delete;
    WorkerScope& operator=(const WorkerScope&) = delete;

  private:
    unsigned before_;
};

/// Runs each kernel that `work` launches three times on the same memory: in forward, reverse and shuffled
/// order, on one worker, so that the outcome is always the same. Empty if no result depended on the order,
/// else a text that names the kernels and the first value that differs. The program goes on with the forward
/// result. It finds missing barriers and unprotected writes to one place. It does not find a `counter += 1`
/// without atomicAdd, since simulated threads change places only where they wait: ThreadSanitizer does,
/// between blocks. From the environment, for a whole program: CUDASIM_RACECHECK=1.
std::string find_races(const std::function<void()>& work);

}  // namespace cudasim
