#include "runtime/worker_pool.h"

#include <algorithm>

#include "runtime/faults.h"
#include "runtime/settings.h"
#include "runtime/worker.h"

namespace cudasim {

WorkerPool& WorkerPool::instance() {
    static WorkerPool pool(settings().workers - 1);
    return pool;
}

WorkerPool::WorkerPool(unsigned helpers) {
    for (unsigned number = 0; number < helpers; ++number)
        helpers_.emplace_back([this, number] { help(number); });
}

WorkerPool::~WorkerPool() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    work_there_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
}

void WorkerPool::run(Grid& grid, unsigned workers) {
    // Waking a helper takes longer than running one block.
    const auto useful = static_cast<unsigned>(std::min<std::uint64_t>(workers, grid.blocks));
    const unsigned wanted = std::min(useful - 1, static_cast<unsigned>(helpers_.size()));
    if (wanted > 0) {
        {
            const std::lock_guard lock(mutex_);
            grid_ = &grid;
            wanted_ = busy_ = wanted;
            ++ticket_;
        }
        work_there_.notify_all();
    }
    Worker::mine().run(grid);
    if (wanted > 0) {
        std::unique_lock lock(mutex_);
        work_done_.wait(lock, [&] { return busy_ == 0; });
    }
}

void WorkerPool::help(unsigned number) {
    const AlternateStack stack_for_fault_reports;
    unsigned long done = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
        work_there_.wait(lock, [&] { return stop_ || (ticket_ != done && number < wanted_); });
        if (stop_) return;
        done = ticket_;
        Grid& grid = *grid_;
        lock.unlock();
        Worker::mine().run(grid);
        lock.lock();
        if (--busy_ == 0) work_done_.notify_one();
    }
}

}  // namespace cudasim
