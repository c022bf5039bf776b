// Where threads wait for each other: the barriers and warp operations that kernels call.
#include <cstring>

#include "runtime/report.h"
#include "runtime/worker.h"

namespace cudasim {
namespace {

bool same_text(const char* a, const char* b) {
    return a == b || std::strcmp(a, b) == 0;
}

// A kernel's barriers outside of a kernel: there is no block to wait for.
void require_kernel(const char* name) {
    if (running_launch) return;
    say(std::string(name) + " was called by host code: only kernels have threads to wait for");
    std::abort();
}

}  // namespace

Votes wait_for_block(bool predicate, const char* name, const char* file, int line) {
    require_kernel(name);
    return Worker::mine().wait_for_block(predicate, {name, file, line, 0});
}

WarpExchange wait_for_warp(unsigned mask, std::uint64_t value, bool predicate, const char* name,
                           const char* file, int line) {
    require_kernel(name);
    return Worker::mine().wait_for_warp(value, predicate, {name, file, line, mask});
}

void* dynamic_shared() {
    require_kernel("extern __shared__");
    return Worker::mine().dynamic_shared();
}

void* Worker::dynamic_shared() const {
    // It ends where the guard page begins, as far as its alignment (16 bytes) lets it.
    return dynamic_shared_.end() - (grid_->request.shared_bytes + 15) / 16 * 16;
}

/// Lets the threads go on, in the order in which they came.
void Worker::make_ready(std::vector<Fiber*>& waiting) {
    ready_.insert(ready_.end(), waiting.begin(), waiting.end());
    waiting.clear();
    if (grid_->order.kind != Order::kShuffled) return;
    ready_.erase(ready_.begin(), ready_.begin() + static_cast<std::ptrdiff_t>(ready_begin_));
    ready_begin_ = 0;
    random_.shuffle(ready_);
}

Votes Worker::wait_for_block(bool predicate, const WaitPlace& place) {
    votes_.count += predicate;
    votes_.all &= predicate;
    if (!at_barrier_.empty()) {
        const WaitPlace& first = at_barrier_.front()->place;
        if (first.line != place.line || !same_text(first.file, place.file)) different_barriers_ = true;
    }
    at_barrier_.push_back(current_);
    // Threads at different lines are not let go: that is reported when nobody can go on.
    if (at_barrier_.size() == block_.size && !different_barriers_) {
        votes_cast_ = votes_;
        votes_ = {0, true};
        ++counts.barriers;
        make_ready(at_barrier_);
    }
    suspend(place);
    return votes_cast_;
}

WarpExchange Worker::wait_for_warp(std::uint64_t value, bool predicate, const WaitPlace& place) {
    const unsigned thread = thread_number(), warp = thread / 32, lane = thread % 32;
    if (!(place.mask >> lane & 1u)) {
        abort_block(std::string("wrong mask: ") + place.name + " at " + text_of(place.file, place.line) +
                    ": the mask does not contain the calling thread's own lane " + std::to_string(lane) +
                    "\nin " + running_thread_text());
        throw BlockAborted{};
    }
    // The last warp of a block may have fewer than 32 lanes.
    const unsigned lanes_left = block_.size - warp * 32;
    const unsigned existing = lanes_left < 32 ? (1u << lanes_left) - 1 : 0xffffffffu;

    WarpGroup& group = group_of(warp, place.mask & existing);
    if (group.arrived == 0) group.name = place.name;
    if (!same_text(group.name, place.name)) group.different_operations = true;
    const unsigned turn = group.turn;
    group.values[turn][lane] = value;
    group.arrived |= 1u << lane;
    group.votes |= static_cast<unsigned>(predicate) << lane;
    group.waiting.push_back(current_);
    if (group.arrived == group.mask && !group.different_operations) complete(group);

    suspend(place);
    const WarpGroup& done = group_of(warp, place.mask & existing);  // others may have moved it meanwhile
    return {done.values[turn], done.lanes[turn], done.votes_cast[turn]};
}

WarpGroup& Worker::group_of(unsigned warp, unsigned mask) {
    std::vector<WarpGroup>& groups = warps_[warp];
    for (WarpGroup& group : groups)
        if (group.mask == mask) return group;
    warps_used_ = true;
    groups.emplace_back(mask);
    return groups.back();
}

/// Hands out the values that have arrived and lets their lanes go on.
void Worker::complete(WarpGroup& group) {
    for (unsigned lane = 0; lane < 32; ++lane)
        if (!(group.arrived >> lane & 1u))
            group.values[group.turn][lane] = std::uint64_t{kPoison} << 32 | kPoison;
    group.lanes[group.turn] = group.arrived;
    group.votes_cast[group.turn] = group.votes;
    group.turn ^= 1u;
    group.arrived = group.votes = 0;
    ++counts.warp_operations;
    make_ready(group.waiting);
}

}  // namespace cudasim
