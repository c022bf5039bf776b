#include "runtime/worker.h"

#include <algorithm>

#include "runtime/report.h"

namespace cudasim {
namespace {

// A plain pointer: reading it takes one instruction.
thread_local Worker* this_worker = nullptr;

}  // namespace

Worker& Worker::mine() {
    if (!this_worker) {
        static thread_local std::unique_ptr<Worker> worker(new Worker);
        this_worker = worker.get();
    }
    return *this_worker;
}

Worker::Worker() : dynamic_shared_(kSharedLimit, GuardedPages::Guard::kAbove) {}

void Worker::run(Grid& grid) {
    grid_ = &grid;
    running_launch = &grid.request;
    gridDim = grid.request.grid;
    blockDim = grid.request.block;
    block_.size = blockDim.x * blockDim.y * blockDim.z;
    turn_ = turns_end_ = 0;
    counts = {};
    warps_.resize(std::max<std::size_t>(warps_.size(), (block_.size + 31) / 32));
#if defined(__AVX__)
    // A switch costs five times as much while the upper halves of vector registers hold something.
    __builtin_ia32_vzeroupper();
#endif
    if (begin_next_block()) switch_to(idle_fiber());  // comes back when there are no more blocks
    running_launch = nullptr;
    const std::lock_guard lock(grid.counts_mutex);
    grid.counts += counts;
}

bool Worker::begin_next_block() {
    if (grid_->failed.load(std::memory_order_relaxed)) return false;
    if (turn_ == turns_end_) {
        turn_ = grid_->next_turn.fetch_add(grid_->chunk, std::memory_order_relaxed);
        turns_end_ = std::min(grid_->blocks, turn_ + grid_->chunk);
        if (turn_ >= grid_->blocks) return false;
    }
    const std::uint64_t number = block_at(turn_++, grid_->blocks, grid_->order);
    const dim3 size = grid_->request.grid;
    // Most grids have one dimension: spare them the divisions.
    const std::uint64_t row = number < size.x ? 0 : number / size.x;
    blockIdx = {static_cast<unsigned>(number - row * size.x), static_cast<unsigned>(row ? row % size.y : 0),
                static_cast<unsigned>(row ? row / size.y : 0)};
    ++block_serial;
    block_.next = 0;
    block_.order = nullptr;
    aborting_ = false;
    if (grid_->order.kind != Order::kForward) {
        order_threads(threads_by_turn_, block_.size, grid_->order, number);
        block_.order = threads_by_turn_.data();
        random_ = Shuffler(grid_->order.seed + number);
    }
    if (warps_used_) {
        for (auto& groups : warps_) groups.clear();
        warps_used_ = false;
    }
    if (grid_->request.shared_bytes) poison_shared(dynamic_shared(), grid_->request.shared_bytes);
    return true;
}

void Worker::fiber_main(boost::context::detail::transfer_t transfer) {
    Worker& worker = *this_worker;
    Fiber& me = *worker.current_;
    arrive_in_fiber(me, transfer);
    for (;;) worker.run_threads(me);
}

/// Runs fresh threads until there is something better to do, then gives way. Who takes this fiber from idle_
/// wants it to run fresh threads again.
void Worker::run_threads(Fiber& me) {
    me.waited = false;
    try {
        grid_->request.run_threads(block_, me.waited, grid_->request.call);
    } catch (const BlockAborted&) {
    }
    if (me.waited) --waiting_threads_;

    const bool somebody_ready = ready_begin_ < ready_.size();
    const bool block_done = waiting_threads_ == 0 && !has_fresh_threads();
    if (has_fresh_threads() && !somebody_ready) return;
    if (block_done && begin_next_block()) return;
    Fiber& next = block_done ? native_ : next_fiber();
    idle_.push_back(&me);
    switch_to(next);
}

void Worker::switch_to(Fiber& to) {
    Fiber& me = *current_;
    if (&to == &me) return;
    me.thread_index = threadIdx;
    current_ = &to;
    switch_fiber(me, to);
    threadIdx = me.thread_index;
}

/// Lets others run until somebody has put this fiber into ready_ and it is its turn.
void Worker::suspend(const WaitPlace& place) {
    Fiber& me = *current_;
    me.place = place;
    me.thread_index = threadIdx;
    if (!me.waited) {
        me.waited = true;
        ++waiting_threads_;
        if (!block_.order) block_.next = thread_number() + 1;  // give back the rest of the row
    }
    switch_to(next_fiber());
    if (aborting_) throw BlockAborted{};
}

/// Threads that can go on come first: a warp then finishes its work before the next one starts.
Fiber& Worker::next_fiber() {
    if (ready_begin_ == ready_.size()) {
        if (has_fresh_threads()) return idle_fiber();
        resolve_stall();
    }
    Fiber& next = *ready_[ready_begin_++];
    if (ready_begin_ == ready_.size()) {
        ready_.clear();
        ready_begin_ = 0;
    }
    return next;
}

Fiber& Worker::idle_fiber() {
    if (idle_.empty()) {
        fibers_.push_back(std::make_unique<Fiber>(&fiber_main, static_cast<unsigned>(fibers_.size())));
        return *fibers_.back();
    }
    Fiber& fiber = *idle_.back();
    idle_.pop_back();
    return fiber;
}

}  // namespace cudasim
