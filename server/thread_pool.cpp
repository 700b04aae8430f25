#include "server/thread_pool.h"

namespace weft::server {
namespace {

/// Looks out for something so many times, some tens of microseconds.
constexpr int kLooks = 1500;

template <class Predicate>
void look_out_for(Predicate&& happened) {
  for (int k = 0; k < kLooks && !happened(); ++k) {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { serve(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  started_.notify_all();
}

void ThreadPool::run(int chunks, void (*work)(void* context, int chunk), void* context) {
  std::unique_lock lock(mutex_);
  job_ = {chunks, work, context};
  next_chunk_ = 0;
  open_ = chunks;
  ++posted_;
  if (chunks > 1) started_.notify_all();
  take_chunks(lock);
  if (open_ > 0) {
    lock.unlock();
    look_out_for([this] { return open_ == 0; });
    lock.lock();
  }
  finished_.wait(lock, [this] { return open_ == 0; });
  job_ = {};
}

void ThreadPool::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    started_.wait(lock, [this] { return stopping_ || next_chunk_ < job_.chunks; });
    if (stopping_) return;
    take_chunks(lock);
    const std::uint32_t seen = posted_;
    lock.unlock();
    look_out_for([&] { return posted_ != seen; });
    lock.lock();
  }
}

void ThreadPool::take_chunks(std::unique_lock<std::mutex>& lock) {
  while (next_chunk_ < job_.chunks) {
    const Job job = job_;
    const int chunk = next_chunk_++;
    lock.unlock();
    job.work(job.context, chunk);
    lock.lock();
    if (--open_ == 0) finished_.notify_one();
  }
}

}  // namespace weft::server
