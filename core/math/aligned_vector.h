#pragma once

#include <cassert>
#include <cstddef>
#include <limits>
#include <new>
#include <vector>

// A vector whose storage starts at a cache line.

namespace weft {

/// Aligns arrays to cache lines, so that no vector in them straddles two.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kCacheLine{64};

  CacheLineAllocator() = default;
  template <class Other>
  CacheLineAllocator(const CacheLineAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    assert(count <= std::numeric_limits<std::size_t>::max() / sizeof(T));
    return static_cast<T*>(::operator new(count * sizeof(T), kCacheLine));
  }
  void deallocate(T* at, std::size_t) { ::operator delete(at, kCacheLine); }
  bool operator==(const CacheLineAllocator&) const = default;
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}  // namespace weft
