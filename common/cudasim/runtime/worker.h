/// @file
/// A worker: one OS thread that runs blocks, one at a time, and switches between a block's threads.
///
/// A fiber runs threads of the block in a plain loop. When one of them has to wait (barrier, warp operation),
/// it stays where it is, with its fiber, and the loop goes on in another fiber. So a kernel without barriers
/// costs what a loop costs, and one with barriers needs at most a fiber for each thread of a block.
#pragma once
#include <memory>
#include <vector>

#include "runtime/fiber.h"
#include "runtime/grid.h"
#include "runtime/guarded_pages.h"
#include "runtime/order.h"
#include "runtime/warp_group.h"

namespace cudasim {

/// Thrown into every waiting thread of a block that is given up, so that what the thread owns is destroyed.
struct BlockAborted {};

class Worker {
  public:
    /// The calling OS thread's.
    static Worker& mine();

    /// Runs blocks of the grid until there are none left.
    void run(Grid& grid);

    // Called by the threads of the block (waiting.cpp).
    Votes wait_for_block(bool predicate, const WaitPlace& place);
    WarpExchange wait_for_warp(std::uint64_t value, bool predicate, const WaitPlace& place);
    void* dynamic_shared() const;

    /// Had the running thread to wait before? Then threadIdx is certainly stored.
    bool running_thread_waited() const { return current_->waited; }
    /// Is `address` just below the running thread's stack, where deep recursion ends?
    bool is_stack_overflow(const void* address) const { return current_->stack.guards(address); }
    /// Does `address` lie behind the end of the dynamic shared memory?
    bool is_behind_shared(const void* address) const { return dynamic_shared_.guards(address); }

    Counts counts;  ///< of the grid it runs

  private:
    Worker();

    // Blocks and fibers (worker.cpp)
    bool begin_next_block();
    bool has_fresh_threads() const { return !aborting_ && block_.next < block_.size; }
    [[noreturn]] static void fiber_main(boost::context::detail::transfer_t transfer);
    void run_threads(Fiber& me);
    void switch_to(Fiber& to);
    void suspend(const WaitPlace& place);
    Fiber& next_fiber();
    Fiber& idle_fiber();

    // Waiting threads (waiting.cpp)
    void make_ready(std::vector<Fiber*>& waiting);
    WarpGroup& group_of(unsigned warp, unsigned mask);
    void complete(WarpGroup& group);

    // When nobody can go on (stall.cpp)
    void resolve_stall();
    bool complete_groups_whose_lanes_ended();
    std::string stall_text() const;
    void abort_block(const std::string& why);

    Grid* grid_ = nullptr;
    std::uint64_t turn_ = 0, turns_end_ = 0;  ///< blocks taken from the grid and not yet run

    RunningBlock block_;
    std::vector<unsigned> threads_by_turn_;
    unsigned waiting_threads_ = 0;  ///< threads that had to wait and have not ended
    bool aborting_ = false;
    Shuffler random_{1};
    GuardedPages dynamic_shared_;

    std::vector<Fiber*> at_barrier_;
    bool different_barriers_ = false;  ///< they wait at different lines
    Votes votes_{0, true}, votes_cast_{0, true};
    std::vector<std::vector<WarpGroup>> warps_;
    bool warps_used_ = false;

    std::vector<std::unique_ptr<Fiber>> fibers_;
    std::vector<Fiber*> idle_;   ///< run no thread
    std::vector<Fiber*> ready_;  ///< their thread need not wait any longer; from ready_begin_ on
    std::size_t ready_begin_ = 0;
    Fiber native_;  ///< the OS thread's stack, which runs no kernel
    Fiber* current_ = &native_;
};

}  // namespace cudasim
