#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/executor.h"

namespace weft::server {

/// Threads that work through the chunks of the physics together with the caller. Which thread runs
/// which chunk is left open; results do not depend on it. Idle workers spin briefly before they
/// block: a tick has hundreds of jobs of some microseconds, and waking a thread takes longer. The
/// caller works too, and waits only for chunks already taken.
class ThreadPool : public Executor {
 public:
  /// @param threads  in total, including the caller's; at least 1
  explicit ThreadPool(int threads);
  ~ThreadPool() override;

  /// Call from one thread at a time.
  /// @param chunks  at most 65,535
  void run(int chunks, void (*work)(void* context, int chunk), void* context) override;

 private:
  void serve();
  void take_chunks(bool from_the_front);

  // Written while no chunk of a job is left, read by a thread that sees one.
  std::atomic<void (*)(void*, int)> work_ = nullptr;
  std::atomic<void*> context_ = nullptr;
  /// Number of the job and its chunks left, in one word, so that a thread that takes a chunk knows
  /// that the job is still the one whose work it has read. The caller takes chunks from the front
  /// and the workers from the end, so that a chunk's data stays in the caches of the same thread
  /// from job to job.
  std::atomic<std::uint64_t> ticket_ = 0;
  std::atomic<int> open_ = 0;              // chunks of the job not yet done
  std::atomic<std::uint32_t> posted_ = 0;  // jobs so far
  std::atomic<bool> stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace weft::server
