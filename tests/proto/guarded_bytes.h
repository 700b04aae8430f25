#pragma once

#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <sys/mman.h>
#include <unistd.h>

namespace weft::test {

/// A copy of bytes that ends where an unreadable page begins: a decoder that reads one byte too far
/// dies at once, in any build.
class GuardedBytes {
 public:
  explicit GuardedBytes(std::span<const std::byte> content) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t readable = (content.size() / page + 1) * page;
    whole_ = readable + page;
    base_ = mmap(nullptr, whole_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (base_ == MAP_FAILED) throw std::bad_alloc();
    std::byte* end = static_cast<std::byte*>(base_) + readable;
    mprotect(end, page, PROT_NONE);
    std::byte* start = end - content.size();
    if (!content.empty()) std::memcpy(start, content.data(), content.size());
    view_ = {start, content.size()};
  }
  ~GuardedBytes() { munmap(base_, whole_); }
  GuardedBytes(const GuardedBytes&) = delete;
  GuardedBytes& operator=(const GuardedBytes&) = delete;

  std::span<const std::byte> view() const { return view_; }

 private:
  void* base_ = nullptr;
  std::size_t whole_ = 0;
  std::span<const std::byte> view_;
};

}  // namespace weft::test
