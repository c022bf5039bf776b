#include "runtime/race_check.h"

#include <algorithm>
#include <cstring>
#include <map>

#include "runtime/allocations.h"
#include "runtime/report.h"
#include "runtime/settings.h"

namespace cudasim {
namespace {

/// What find_races() collects; nullptr outside of it.
std::string* findings = nullptr;

/// A copy of all memory that kernels may write.
class Snapshot {
  public:
    Snapshot() {
        for (const auto& [begin, allocation] : Allocations::all().by_address())
            copies_[&allocation].assign(begin, begin + allocation.bytes);
    }
    void restore() const {
        for (const auto& [allocation, copy] : copies_) std::copy(copy.begin(), copy.end(), allocation->begin);
    }
    /// The first place where memory is not what it was: empty text if there is none.
    std::string difference(const char* order) const {
        for (const auto& [allocation, copy] : copies_) {
            const auto differing = std::mismatch(copy.begin(), copy.end(), allocation->begin).first;
            if (differing == copy.end()) continue;
            const auto word = static_cast<std::size_t>(differing - copy.begin()) / 4;
            return "word " + std::to_string(word) + " (4 bytes each) of " + text_of(*allocation) + " is " +
                   value(copy.data(), word, copy.size()) + " in forward order, " +
                   value(allocation->begin, word, copy.size()) + " in " + order + " order";
        }
        return "";
    }

  private:
    /// "1.5 (as an int 1069547520)"
    static std::string value(const char* memory, std::size_t word, std::size_t bytes) {
        unsigned bits = 0;
        std::memcpy(&bits, memory + word * 4, std::min<std::size_t>(4, bytes - word * 4));
        char text[64];
        std::snprintf(text, sizeof text, "%g (as an int %d)", static_cast<double>(__uint_as_float(bits)),
                      static_cast<int>(bits));
        return text;
    }

    std::map<const Allocation*, std::vector<char>> copies_;
};

void report(const LaunchRequest& request, const std::string& difference) {
    const std::string text =
        "the result of " + text_of(request) + " depends on the order of its threads\n" + difference +
        "\nthreads race for this value: a barrier or an atomic is missing, or an atomic is "
        "used whose outcome depends on the order";
    if (findings)
        *findings += (findings->empty() ? "" : "\n") + text;
    else
        say(text);
}

}  // namespace

bool checks_races() {
    return findings || settings().race_check;
}

bool run_in_all_orders(const LaunchRequest& request) {
    const Snapshot before;
    if (!run_in_order(request, {Order::kForward, 1}, 1)) return false;
    const Snapshot forward;
    const std::pair<Order, const char*> others[] = {{{Order::kReverse, 1}, "reverse"},
                                                    {{Order::kShuffled, 1}, "shuffled"}};
    std::string difference;
    for (const auto& [order, name] : others) {
        before.restore();
        if (!run_in_order(request, order, 1)) return false;
        if (difference.empty()) difference = forward.difference(name);
    }
    forward.restore();
    if (!difference.empty()) report(request, difference);
    return true;
}

std::string find_races(const std::function<void()>& work) {
    std::string found;
    std::string* const outer = findings;
    findings = &found;
    try {
        work();
    } catch (...) {
        findings = outer;
        throw;
    }
    findings = outer;
    return found;
}

}  // namespace cudasim
