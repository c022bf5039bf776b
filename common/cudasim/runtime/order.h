/// @file
/// The order in which blocks and threads start.
#pragma once
#include <cstdint>
#include <vector>

#include "cudasim.h"

namespace cudasim {

/// Small generator of pseudo-random numbers (splitmix64): the same everywhere for the same seed.
class Shuffler {
  public:
    explicit Shuffler(std::uint64_t seed) : state_(seed) {}
    std::uint64_t below(std::uint64_t limit);
    template <class T>
    void shuffle(std::vector<T>& items) {
        for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
    }

  private:
    std::uint64_t state_;
};

/// Number of the block whose turn it is, out of `blocks`.
std::uint64_t block_at(std::uint64_t turn, std::uint64_t blocks, Order order);

/// Thread numbers by turn for a block of `threads`.
void order_threads(std::vector<unsigned>& threads_by_turn, unsigned threads, Order order,
                   std::uint64_t block);

}  // namespace cudasim
