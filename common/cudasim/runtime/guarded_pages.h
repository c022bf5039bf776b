/// @file
/// Memory with a page at one end that cannot be touched: who runs over the end is stopped there and then.
#pragma once
#include <cstddef>

namespace cudasim {

/// Move-only owner of whole pages.
class GuardedPages {
  public:
    enum class Guard { kBelow, kAbove };

    GuardedPages() = default;
    /// At least `bytes`; `begin()` is nullptr if the system has not that much.
    GuardedPages(std::size_t bytes, Guard guard);
    GuardedPages(GuardedPages&& other) noexcept;
    GuardedPages& operator=(GuardedPages&& other) noexcept;
    ~GuardedPages();

    char* begin() const { return begin_; }
    char* end() const { return begin_ + size_; }
    std::size_t size() const { return size_; }
    /// Is it in the page that cannot be touched?
    bool guards(const void* address) const;

  private:
    char* begin_ = nullptr;
    std::size_t size_ = 0;
    Guard guard_ = Guard::kBelow;
};

std::size_t page_bytes();

}  // namespace cudasim
