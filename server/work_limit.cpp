#include "server/work_limit.h"

#include <chrono>
#include <pthread.h>

namespace weft::server {
namespace {

constexpr auto kWatchPause = std::chrono::milliseconds(5);

double read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace

void WorkLimit::begin(double share) {
  share_ = share;
  clockid_t clock = CLOCK_MONOTONIC;
  if (!clock_ && pthread_getcpuclockid(pthread_self(), &clock) == 0) thread_clock_ = clock;
  begun_ = now();
  working_.store(true, std::memory_order_release);
}

double WorkLimit::now() const {
  return clock_ ? clock_() : read_clock(thread_clock_);
}

double WorkLimit::spent() const {
  return working_.load(std::memory_order_acquire) ? now() - begun_ : 0;
}

bool WorkLimit::is_over() const {
  return seconds_ > 0 && spent() > seconds_ * share_;
}

LimitWatch::LimitWatch()
    : thread_([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          {
            const std::lock_guard lock(mutex_);
            for (WorkLimit* const limit : limits_) limit->watch();
          }
          std::this_thread::sleep_for(kWatchPause);
        }
      }) {}

void LimitWatch::add(WorkLimit& limit) {
  const std::lock_guard lock(mutex_);
  limits_.push_back(&limit);
}

void LimitWatch::remove(WorkLimit& limit) {
  const std::lock_guard lock(mutex_);
  std::erase(limits_, &limit);
}

double thread_cpu_seconds() {
  return read_clock(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace weft::server
