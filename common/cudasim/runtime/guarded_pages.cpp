#include "runtime/guarded_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <utility>

namespace cudasim {

std::size_t page_bytes() {
    static const std::size_t bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return bytes;
}

GuardedPages::GuardedPages(std::size_t bytes, Guard guard) : guard_(guard) {
    const std::size_t page = page_bytes();
    const std::size_t size = (bytes + page - 1) / page * page;
    void* pages = mmap(nullptr, size + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) return;
    char* first = static_cast<char*>(pages);
    // It may fail where a process has very many mappings. The memory is good all the same, only unguarded.
    mprotect(guard == Guard::kBelow ? first : first + size, page, PROT_NONE);
#if defined(MADV_HUGEPAGE)
    constexpr std::size_t kLarge = std::size_t{4} << 20;
    if (size >= kLarge) madvise(first, size, MADV_HUGEPAGE);  // fewer page faults and fewer misses of the TLB
#endif
    begin_ = guard == Guard::kBelow ? first + page : first;
    size_ = size;
}

GuardedPages::GuardedPages(GuardedPages&& other) noexcept {
    *this = std::move(other);
}

GuardedPages& GuardedPages::operator=(GuardedPages&& other) noexcept {
    std::swap(begin_, other.begin_);
    std::swap(size_, other.size_);
    std::swap(guard_, other.guard_);
    return *this;
}

GuardedPages::~GuardedPages() {
    if (!begin_) return;
    munmap(guard_ == Guard::kBelow ? begin_ - page_bytes() : begin_, size_ + page_bytes());
}

bool GuardedPages::guards(const void* address) const {
    const char* guard = guard_ == Guard::kBelow ? begin_ - page_bytes() : begin_ + size_;
    const char* byte = static_cast<const char*>(address);
    return begin_ && byte >= guard && byte < guard + page_bytes();
}

}  // namespace cudasim
