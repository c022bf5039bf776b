/// @file
/// The list of all memory that kernels may use.
#pragma once
#include <cuda_runtime.h>

#include <map>
#include <string>

#include "runtime/guarded_pages.h"

namespace cudasim {

/// One piece of memory that kernels may use.
struct Allocation {
    char* begin = nullptr;
    std::size_t bytes = 0;
    MemoryKind kind = MemoryKind::kDevice;
    const char* file = "";  ///< where it was made
    int line = 0;
    GuardedPages pages;  ///< holds device memory in builds without a sanitizer

    char* end() const { return begin + bytes; }
    bool on_device() const { return kind != MemoryKind::kPinnedHost; }
};

/// All of it. Not locked: host functions take a HostCall (host_call.h) first.
class Allocations {
  public:
    static Allocations& all();

    void add(Allocation allocation);
    /// Memory that belongs to somebody else: a symbol, or a mapped graphics buffer.
    void add_foreign(void* begin, std::size_t bytes, MemoryKind kind);
    void remove(const Allocation& allocation);

    /// The one that `address` lies in or just behind, as the end of a range does. nullptr if there is none.
    const Allocation* find(const void* address) const;
    /// The one that holds a byte at `address`.
    const Allocation* holder_of(const void* address) const;
    /// The one that begins there.
    const Allocation* find_begin(const void* address) const;
    /// The one that ends less than `distance` bytes before `address`.
    const Allocation* find_before(const void* address, std::size_t distance) const;

    const std::map<const char*, Allocation>& by_address() const { return by_address_; }
    std::size_t live_bytes() const { return live_bytes_; }  ///< from cudaMalloc
    std::size_t live_count() const { return live_count_; }

  private:
    std::map<const char*, Allocation> by_address_;
    std::size_t live_bytes_ = 0, live_count_ = 0;
};

/// Memory for cudaMalloc; `begin` is nullptr if there is not that much.
Allocation make_allocation(std::size_t bytes, MemoryKind kind, const char* file, int line);
/// Gives it back to the system.
void free_allocation(const Allocation& allocation);
/// Of cudaMalloc.
void free_all_device_memory();

/// Lets host code touch one allocation (nullptr: none) while it lives; see HostAccess, which does so for all.
class AccessTo {
  public:
    explicit AccessTo(const Allocation* allocation);
    ~AccessTo();
    AccessTo(const AccessTo&) = delete;
    AccessTo& operator=(const AccessTo&) = delete;

  private:
    const Allocation* allocation_;
};

/// "the 4000 bytes allocated at main.cu:12"
std::string text_of(const Allocation& allocation);

}  // namespace cudasim
