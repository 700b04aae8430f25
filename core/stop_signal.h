#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>

// Ends long work from outside: any thread may raise the signal, and every potentially long loop
// checks it at its stop points. Nothing in core reads a clock or counts; the owner decides when to
// stop.

namespace weft {

/// Thrown by `stop_point` to end the current work. The data being changed is left undefined; its
/// owner restores it.
struct Stopped : std::runtime_error {
  Stopped() : std::runtime_error("the work was ended from outside") {}
};

/// Ends work on one thread.
class StopSignal {
 public:
  /// Makes the coming stop points call `attend`. Callable from any thread.
  void raise() { raised_.store(true, std::memory_order_release); }
  void lower() { raised_.store(false, std::memory_order_release); }
  bool raised() const { return raised_.load(std::memory_order_acquire); }

  /// Called on the working thread while the signal is raised; true ends the work. It may lower the
  /// signal, and must not touch the data being worked on. Set it before the signal is used.
  std::function<bool()> attend = [] { return true; };

 private:
  std::atomic<bool> raised_ = false;
};

namespace detail {
inline constinit thread_local StopSignal* present_signal = nullptr;
void ask(StopSignal& signal);
}  // namespace detail

/// Makes a signal that of this thread during its lifetime; null: nothing ends the work meanwhile.
class StopScope {
 public:
  explicit StopScope(StopSignal* signal) : outer_(detail::present_signal) {
    detail::present_signal = signal;
  }
  ~StopScope() { detail::present_signal = outer_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  StopSignal* outer_;
};

/// The signal of this thread; null without one.
inline StopSignal* current_stop_signal() {
  return detail::present_signal;
}

/// A point where long work may end; costs one load. Throws Stopped.
inline void stop_point() {
  StopSignal* const signal = detail::present_signal;
  if (signal && signal->raised()) detail::ask(*signal);
}

/// The same for the `k`th iteration of a tight loop: checks every 256th.
inline void stop_point(std::size_t k) {
  if (k % 256 == 0) stop_point();
}

}  // namespace weft
