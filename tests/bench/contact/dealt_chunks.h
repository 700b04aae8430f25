#pragma once

#include <algorithm>
#include <chrono>

#include "core/executor.h"

// What two threads would take, measured on one.

namespace weft::bench {

inline double wall_milliseconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

/// Runs all chunks on the caller's thread, times each, and deals them out to two threads, each to
/// the one that is free first. So the critical path of a tick is its time less what the less busy
/// thread of each job takes off the caller, and needs no second processor to be measured.
class DealtChunks : public Executor {
 public:
  void run(int chunks, void (*work)(void* context, int chunk), void* context) override {
    double busy[2] = {0, 0};
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const double start = wall_milliseconds();
      work(context, chunk);
      busy[busy[1] < busy[0] ? 1 : 0] += wall_milliseconds() - start;
    }
    saved_ += std::min(busy[0], busy[1]);
  }
  /// What the second thread has taken off the caller since the last call [ms].
  double take_saved() {
    const double saved = saved_;
    saved_ = 0;
    return saved;
  }

 private:
  double saved_ = 0;
};

}  // namespace weft::bench
