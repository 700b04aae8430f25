#pragma once

#include <atomic>
#include <ctime>
#include <thread>

#include "core/stop_signal.h"
#include "server/clock.h"

namespace weft::server {

/// Bounds the CPU time of one piece of work, such as a tick: time that passes while the thread
/// waits or other programs run does not count, and so a busy machine ends nothing. The time is that
/// of the thread that works; what other threads do for it meanwhile is not counted.
class WorkLimit {
 public:
  /// @param seconds  of CPU that one piece of work may take [s]; 0: no bound
  /// @param clock    CPU time [s], for tests; null: that of the thread that works
  explicit WorkLimit(double seconds, Clock clock = {})
      : seconds_(seconds), clock_(std::move(clock)) {
    signal_.attend = [this] {
      signal_.lower();
      return is_over();
    };
  }

  double seconds() const { return seconds_; }
  /// Raised when the bound is passed. The owner may raise it for reasons of its own and attend to
  /// it in another way; then `is_over` tells of this one.
  StopSignal& signal() { return signal_; }

  /// Bounds what is done on this thread while it lives.
  class Scope {
   public:
    explicit Scope(WorkLimit& limit) : limit_(limit), stop_(&limit.signal_) { limit.begin(); }
    ~Scope() { limit_.end(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    WorkLimit& limit_;
    StopScope stop_;
  };

  /// Whether the work in hand has taken more than it may. From any thread.
  bool is_over() const;
  /// For how long the work in hand has been going on [s of CPU]; 0 where there is none. From any
  /// thread.
  double spent() const;

  /// Raises the signal if the bound is passed. From any thread.
  void watch() {
    if (is_over()) signal_.raise();
  }

 private:
  void begin();
  void end() { working_.store(false, std::memory_order_release); }
  double now() const;

  double seconds_;
  Clock clock_;
  StopSignal signal_;
  std::atomic<clockid_t> thread_clock_ = CLOCK_MONOTONIC;  ///< of the thread that works
  std::atomic<double> begun_ = 0;
  std::atomic<bool> working_ = false;
};

/// A thread that watches a limit.
class LimitWatch {
 public:
  explicit LimitWatch(WorkLimit& limit);

 private:
  std::jthread thread_;
};

/// CPU time of the calling thread [s].
double thread_cpu_seconds();

}  // namespace weft::server
