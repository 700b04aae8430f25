#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "core/executor.h"

namespace weft::server {

/// Threads that work through the chunks of the physics together with the caller. Which thread takes
/// which chunk is left open; results do not depend on it. Who has nothing to do looks out for more
/// for a moment before he sleeps: a tick has many jobs, and to be woken takes as long as some.
class ThreadPool : public Executor {
 public:
  /// @param threads  in all, with the caller's; at least 1
  explicit ThreadPool(int threads);
  ~ThreadPool() override;

  void run(int chunks, void (*work)(void* context, int chunk), void* context) override;

 private:
  struct Job {
    int chunks = 0;
    void (*work)(void*, int) = nullptr;
    void* context = nullptr;
  };

  void serve();
  void take_chunks(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable started_, finished_;
  Job job_;
  int next_chunk_ = 0;                     // of the job
  std::atomic<int> open_ = 0;              // chunks not done yet
  std::atomic<std::uint32_t> posted_ = 0;  // jobs so far
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace weft::server
