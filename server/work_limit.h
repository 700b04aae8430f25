#pragma once

#include <atomic>
#include <ctime>
#include <mutex>
#include <thread>
#include <vector>

#include "core/stop_signal.h"
#include "server/clock.h"

namespace weft::server {

/// Bounds the CPU time of one piece of work, such as a tick: time in which the thread waits or
/// other programs run does not count, so a busy machine ends nothing. Only the working thread is
/// measured; helping threads do not count.
class WorkLimit {
 public:
  /// @param seconds  most CPU time of one piece of work [s]; 0: no bound
  /// @param clock    CPU time [s], for tests; null: that of the working thread
  explicit WorkLimit(double seconds, Clock clock = {})
      : seconds_(seconds), clock_(std::move(clock)) {
    signal_.attend = [this] {
      signal_.lower();
      return is_over();
    };
  }

  double seconds() const { return seconds_; }
  /// Raised when the bound is exceeded. The owner may raise it for other reasons and attend to it;
  /// `is_over` tells these apart.
  StopSignal& signal() { return signal_; }

  /// Bounds the work on this thread during its lifetime.
  class Scope {
   public:
    /// @param share  of the bound that this work may take [1], 0 to 1
    explicit Scope(WorkLimit& limit, double share = 1) : limit_(limit), stop_(&limit.signal_) {
      limit.begin(share);
    }
    ~Scope() { limit_.end(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    WorkLimit& limit_;
    StopScope stop_;
  };

  /// Whether the current work has exceeded its bound. Callable from any thread.
  bool is_over() const;
  /// CPU time of the current work so far [s]; 0 if there is none. Callable from any thread.
  double spent() const;

  /// Raises the signal, as something is to be attended to. Callable from any thread.
  void call() {
    called_ = true;  // before the signal, so that a thread that sees that finds this
    signal_.raise();
  }
  /// Whether it was called since the last look. By it the owner tells a call from a signal that it
  /// has raised itself.
  bool take_call() { return called_.exchange(false); }
  /// Calls if the bound is exceeded. Callable from any thread.
  void watch() {
    if (is_over()) call();
  }

 private:
  void begin(double share);
  void end() { working_.store(false, std::memory_order_release); }
  double now() const;

  double seconds_;
  Clock clock_;
  StopSignal signal_;
  std::atomic<clockid_t> thread_clock_ = CLOCK_MONOTONIC;  ///< of the working thread
  std::atomic<double> begun_ = 0;
  std::atomic<double> share_ = 1;  ///< of the bound, for the current work
  std::atomic<bool> working_ = false;
  std::atomic<bool> called_ = false;
};

/// A thread that watches limits.
class LimitWatch {
 public:
  LimitWatch();
  explicit LimitWatch(WorkLimit& limit) : LimitWatch() { add(limit); }

  /// From now until `remove`, before which the limit must not be destroyed.
  void add(WorkLimit& limit);
  void remove(WorkLimit& limit);

 private:
  std::mutex mutex_;
  std::vector<WorkLimit*> limits_;
  std::jthread thread_;
};

/// CPU time of the calling thread [s].
double thread_cpu_seconds();

}  // namespace weft::server
