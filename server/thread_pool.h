#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/executor.h"

namespace weft::server {

/// Threads that work through the chunks of the physics together with the caller. Which thread takes
/// which chunk is left open; results do not depend on it. Who has nothing to do looks out for more
/// for a moment before he sleeps: a tick has hundreds of jobs of some microseconds, and to be woken
/// takes longer. The caller waits for nobody who has not begun: he takes the chunks himself.
class ThreadPool : public Executor {
 public:
  /// @param threads  in all, with the caller's; at least 1
  explicit ThreadPool(int threads);
  ~ThreadPool() override;

  /// To be called from one thread at a time.
  /// @param chunks  at most 65,535
  void run(int chunks, void (*work)(void* context, int chunk), void* context) override;

 private:
  void serve();
  void take_chunks(bool from_the_front);

  // Written while no chunk of a job is left to be taken, read by who sees one that is.
  std::atomic<void (*)(void*, int)> work_ = nullptr;
  std::atomic<void*> context_ = nullptr;
  /// Number of the job and which of its chunks are left: in one, so that who takes a chunk knows
  /// that the job is still the one whose work he has read. The caller takes the first of them and
  /// the others the last, so that what lies in a chunk stays in the caches of the same thread from
  /// job to job.
  std::atomic<std::uint64_t> ticket_ = 0;
  std::atomic<int> open_ = 0;              // chunks of the job that are not done yet
  std::atomic<std::uint32_t> posted_ = 0;  // jobs so far
  std::atomic<bool> stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace weft::server
