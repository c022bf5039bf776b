// When no thread of the block can go on: either lanes have ended that others need not wait for, or the
// threads have gone different ways and wait for each other for ever, which on a GPU hangs or gives wrong
// results.
#include <algorithm>
#include <tuple>

#include "runtime/report.h"
#include "runtime/worker.h"

namespace cudasim {
namespace {

unsigned number_of(const Fiber& fiber) {
    const uint3 t = fiber.thread_index;
    return t.x + blockDim.x * (t.y + blockDim.y * t.z);
}

/// Threads that wait at one place.
struct Crowd {
    WaitPlace place;
    unsigned threads = 0, first_thread = 0;
};

void add(std::vector<Crowd>& crowds, const Fiber& fiber) {
    const auto key = [](const WaitPlace& p) {
        return std::tuple(std::string(p.file), p.line, p.mask, p.name);
    };
    const unsigned number = number_of(fiber);
    for (Crowd& crowd : crowds)
        if (key(crowd.place) == key(fiber.place)) {
            ++crowd.threads;
            crowd.first_thread = std::min(crowd.first_thread, number);
            return;
        }
    crowds.push_back({fiber.place, 1, number});
}

std::string line_about(const Crowd& crowd) {
    char mask[32] = "";
    if (crowd.place.mask) std::snprintf(mask, sizeof mask, " with mask 0x%08x", crowd.place.mask);
    return "\n" + std::to_string(crowd.threads) + " wait in " + crowd.place.name + mask + " at " +
           text_of(crowd.place.file, crowd.place.line) + ", first thread " +
           text_of(thread_index_of(crowd.first_thread));
}

}  // namespace

void Worker::resolve_stall() {
    if (complete_groups_whose_lanes_ended()) return;
    abort_block(stall_text());
}

/// A warp operation waits for those lanes of its mask that have not ended.
bool Worker::complete_groups_whose_lanes_ended() {
    std::vector<unsigned> waiting_lanes(warps_.size(), 0);
    const auto note = [&](const Fiber* fiber) {
        const unsigned number = number_of(*fiber);
        waiting_lanes[number / 32] |= 1u << number % 32;
    };
    for (const Fiber* fiber : at_barrier_) note(fiber);
    for (const auto& groups : warps_)
        for (const WarpGroup& group : groups)
            for (const Fiber* fiber : group.waiting) note(fiber);

    bool completed = false;
    for (std::size_t warp = 0; warp < warps_.size(); ++warp)
        for (WarpGroup& group : warps_[warp]) {
            const unsigned missing = group.mask & waiting_lanes[warp] & ~group.arrived;
            if (group.arrived == 0 || missing != 0 || group.different_operations) continue;
            complete(group);
            completed = true;
        }
    return completed;
}

std::string Worker::stall_text() const {
    std::vector<Crowd> crowds;
    std::vector<bool> waits(block_.size, false);
    const auto note = [&](const Fiber* fiber) {
        add(crowds, *fiber);
        waits[number_of(*fiber)] = true;
    };
    for (const Fiber* fiber : at_barrier_) note(fiber);
    for (const auto& groups : warps_)
        for (const WarpGroup& group : groups)
            for (const Fiber* fiber : group.waiting) note(fiber);

    std::string text = "barrier divergence in " + text_of(*running_launch) + ", block " + text_of(blockIdx) +
                       ": its " + std::to_string(block_.size) + " threads do not meet";
    for (const Crowd& crowd : crowds) text += line_about(crowd);
    const auto ended = std::count(waits.begin(), waits.end(), false);
    const auto first_ended = std::find(waits.begin(), waits.end(), false) - waits.begin();
    if (ended)
        text += "\n" + std::to_string(ended) + " have ended, first thread " +
                text_of(thread_index_of(static_cast<unsigned>(first_ended)));
    return text;
}

/// Gives the block up: all threads that wait are woken to be unwound. The first worker to do so says why.
void Worker::abort_block(const std::string& why) {
    if (!grid_->failed.exchange(true)) say(why);
    aborting_ = true;
    make_ready(at_barrier_);
    different_barriers_ = false;
    votes_ = {0, true};
    for (auto& groups : warps_) {
        for (WarpGroup& group : groups) make_ready(group.waiting);
        groups.clear();
    }
}

}  // namespace cudasim
