#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>

// How long work is ended from outside: a signal that any thread may raise, and points in every loop
// that can be long which look at it. Nothing in core reads a clock or counts; when to stop is the
// owner's decision.

namespace weft {

/// Thrown by `stop_point` where the work in hand shall end. What was being changed is in no defined
/// state; its owner sets it back.
struct Stopped : std::runtime_error {
  Stopped() : std::runtime_error("the work was ended from outside") {}
};

/// Ends work on one thread.
class StopSignal {
 public:
  /// Makes the coming stop points ask `attend`. From any thread.
  void raise() { raised_.store(true, std::memory_order_release); }
  void lower() { raised_.store(false, std::memory_order_release); }
  bool raised() const { return raised_.load(std::memory_order_acquire); }

  /// Asked on the working thread while the signal is raised; true ends the work. It may lower the
  /// signal, and must not touch what is being worked on. Set before the signal is used.
  std::function<bool()> attend = [] { return true; };

 private:
  std::atomic<bool> raised_ = false;
};

namespace detail {
inline constinit thread_local StopSignal* present_signal = nullptr;
void ask(StopSignal& signal);
}  // namespace detail

/// Makes a signal the one of this thread while it lives; null: nothing ends the work meanwhile.
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

/// The signal of this thread; null if there is none.
inline StopSignal* current_stop_signal() {
  return detail::present_signal;
}

/// A place at which long work may end; costs a load. Throws Stopped.
inline void stop_point() {
  StopSignal* const signal = detail::present_signal;
  if (signal && signal->raised()) detail::ask(*signal);
}

/// The same for the `k`th turn of a loop whose turns are short: looks at every 256th.
inline void stop_point(std::size_t k) {
  if (k % 256 == 0) stop_point();
}

}  // namespace weft
