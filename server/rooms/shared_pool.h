#pragma once

#include <functional>
#include <mutex>
#include <utility>

#include "core/executor.h"
#include "server/thread_priority.h"

namespace weft::server {

/// Pools of threads that serve one room at a time each. The physics of a room that has its turn on
/// a prompt thread uses the prompt one while no other room has a turn, and one thread else. A room
/// on a patient thread uses the patient one, whose threads hold up no other. No bit of the motion
/// depends on that.
class SharedPool : public Executor {
 public:
  /// @param prompt, patient  each called from one thread at a time
  /// @param alone            whether at most one room has a turn; callable from any thread
  SharedPool(Executor& prompt, Executor& patient, std::function<bool()> alone)
      : prompt_{prompt}, patient_{patient}, alone_(std::move(alone)) {}

  void run(int chunks, void (*work)(void* context, int chunk), void* context) override {
    Pool& pool = is_patient() ? patient_ : prompt_;
    const bool wanted = chunks > 1 && (&pool == &patient_ || alone_());
    std::unique_lock lock(pool.free, std::defer_lock);
    if (wanted && lock.try_lock()) return pool.threads.run(chunks, work, context);
    for (int chunk = 0; chunk < chunks; ++chunk) work(context, chunk);
  }

 private:
  struct Pool {
    Executor& threads;
    std::mutex free = {};
  };

  Pool prompt_, patient_;
  std::function<bool()> alone_;
};

}  // namespace weft::server
