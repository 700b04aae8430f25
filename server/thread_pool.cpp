#include "server/thread_pool.h"

namespace weft::server {
namespace {

/// Polls before blocking: some hundred microseconds.
constexpr int kLooks = 20000;

template <class Predicate>
void look_out_for(Predicate&& happened) {
  for (int k = 0; k < kLooks && !happened(); ++k) {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
}

// A ticket: the number of the job in 32 bits, then the first chunk left and the end of the chunks
// left in 16 bits each.
constexpr std::uint64_t make_ticket(std::uint32_t job, int chunks) {
  return std::uint64_t{job} << 32 | static_cast<std::uint64_t>(chunks);
}
constexpr std::uint64_t kOneFromTheFront = 1 << 16, kOneFromTheEnd = 1;
constexpr int first_of(std::uint64_t ticket) {
  return static_cast<int>(ticket >> 16 & 0xffff);
}
constexpr int end_of(std::uint64_t ticket) {
  return static_cast<int>(ticket & 0xffff);
}

}  // namespace

ThreadPool::ThreadPool(int threads) {
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { serve(); });
}

ThreadPool::~ThreadPool() {
  stopping_ = true;
  ++posted_;
  posted_.notify_all();
}

void ThreadPool::run(int chunks, void (*work)(void* context, int chunk), void* context) {
  if (chunks < 1) return;
  work_.store(work, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  open_.store(chunks, std::memory_order_relaxed);
  const std::uint32_t job = posted_.load(std::memory_order_relaxed) + 1;
  ticket_.store(make_ticket(job, chunks), std::memory_order_release);
  posted_.store(job);
  if (chunks > 1) posted_.notify_all();
  take_chunks(true);
  look_out_for([this] { return open_ == 0; });
  for (int left = open_; left > 0; left = open_) open_.wait(left);
}

void ThreadPool::serve() {
  for (std::uint32_t seen = 0; !stopping_;) {
    take_chunks(false);
    look_out_for([&] { return posted_ != seen; });
    posted_.wait(seen);
    seen = posted_;
  }
}

void ThreadPool::take_chunks(bool from_the_front) {
  std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
  while (first_of(ticket) < end_of(ticket)) {
    const auto work = work_.load(std::memory_order_relaxed);
    void* const context = context_.load(std::memory_order_relaxed);
    const std::uint64_t rest = from_the_front ? ticket + kOneFromTheFront : ticket - kOneFromTheEnd;
    if (!ticket_.compare_exchange_weak(ticket, rest, std::memory_order_acq_rel)) continue;
    work(context, from_the_front ? first_of(ticket) : end_of(rest));
    if (open_.fetch_sub(1) == 1) open_.notify_one();
    ticket = ticket_.load(std::memory_order_acquire);
  }
}

}  // namespace weft::server
