#include "runtime/order.h"

#include <algorithm>
#include <numeric>

namespace cudasim {

std::uint64_t Shuffler::below(std::uint64_t limit) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) % limit;
}

std::uint64_t block_at(std::uint64_t turn, std::uint64_t blocks, Order order) {
    if (order.kind == Order::kForward || blocks == 1) return turn;
    if (order.kind == Order::kReverse) return blocks - 1 - turn;
    // A shuffle that needs no memory: steps of a size that has no factor in common with the number of blocks.
    Shuffler random(order.seed);
    const std::uint64_t start = random.below(blocks);
    std::uint64_t step = 1 + random.below(blocks - 1);
    while (std::gcd(step, blocks) != 1) step = step % (blocks - 1) + 1;
    return static_cast<std::uint64_t>((start + static_cast<unsigned __int128>(turn) * step) % blocks);
}

void order_threads(std::vector<unsigned>& threads_by_turn, unsigned threads, Order order,
                   std::uint64_t block) {
    threads_by_turn.resize(threads);
    std::iota(threads_by_turn.begin(), threads_by_turn.end(), 0u);
    if (order.kind == Order::kReverse) std::reverse(threads_by_turn.begin(), threads_by_turn.end());
    if (order.kind == Order::kShuffled)
        Shuffler(order.seed * 0x100000001b3u + block).shuffle(threads_by_turn);
}

}  // namespace cudasim
