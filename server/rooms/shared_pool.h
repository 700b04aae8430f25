#pragma once

#include <functional>
#include <mutex>
#include <utility>

#include "core/executor.h"

namespace weft::server {

/// A pool of threads that serves one room at a time: the physics of a room uses it while no other
/// room has a turn, unless it gives way to others, and one thread else. No bit of the motion
/// depends on that.
class SharedPool : public Executor {
 public:
  /// @param pool  called from one thread at a time
  /// @param open  whether the caller's room may use it now; callable from any thread
  SharedPool(Executor& pool, std::function<bool()> open) : pool_(pool), open_(std::move(open)) {}

  void run(int chunks, void (*work)(void* context, int chunk), void* context) override {
    std::unique_lock lock(free_, std::defer_lock);
    if (chunks > 1 && open_() && lock.try_lock()) return pool_.run(chunks, work, context);
    for (int chunk = 0; chunk < chunks; ++chunk) work(context, chunk);
  }

 private:
  Executor& pool_;
  std::function<bool()> open_;
  std::mutex free_;
};

}  // namespace weft::server
