/// @file
/// The OS threads that run blocks.
#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/grid.h"

namespace cudasim {

/// Workers for one grid at a time: the calling thread and `size() - 1` others, which sleep in between.
class WorkerPool {
  public:
    static WorkerPool& instance();
    /// All blocks of the grid, on at most `workers` workers. Returns when they are done.
    void run(Grid& grid, unsigned workers);
    ~WorkerPool();

  private:
    explicit WorkerPool(unsigned helpers);
    void help(unsigned number);

    std::mutex mutex_;
    std::condition_variable work_there_, work_done_;
    Grid* grid_ = nullptr;
    unsigned long ticket_ = 0;  ///< counts grids, so that a helper knows a new one from the one it just did
    unsigned wanted_ = 0;       ///< helpers that take part in this grid: those with smaller numbers
    unsigned busy_ = 0;         ///< of those, not done yet
    bool stop_ = false;
    std::vector<std::thread> helpers_;
};

}  // namespace cudasim
