#pragma once

#include <algorithm>

namespace weft::server {

/// Decides when the next tick is due. A few late ticks are caught up; beyond that the backlog is
/// dropped, simulated time slows down, and the loop never spirals.
class TickPacer {
 public:
  static constexpr int kMostLateTicks = 4;

  /// The next tick is due now.
  void restart(double now) { next_ = now; }

  /// Ticks have this much real time between them from now on [s]. What is left of the wait for the
  /// next one passes at the new speed.
  void set_interval(double interval, double now) {
    if (interval == interval_) return;
    if (next_ > now && interval_ > 0) next_ = now + (next_ - now) * (interval / interval_);
    interval_ = interval;
  }

  /// Whether a tick is due; if so, the next one is due one interval later.
  bool take_due(double now) {
    if (now < next_) return false;
    next_ = std::max(next_, now - kMostLateTicks * interval_) + interval_;
    return true;
  }

  double next() const { return next_; }

 private:
  double next_ = 0, interval_ = 0;
};

/// Simulated per real time, over the last one to two seconds.
class RealTimeMeter {
 public:
  void restart(double now) {
    before_ = current_ = 0;
    before_start_ = current_start_ = now;
    started_ = false;
  }

  /// A tick is done. Time counts from the first one, which therefore adds nothing itself.
  void add(double simulated, double now) {
    if (!started_) {
      restart(now);
      started_ = true;
      return;
    }
    current_ += simulated;
    if (now - current_start_ < kPeriod) return;
    before_ = current_;
    before_start_ = current_start_;
    current_ = 0;
    current_start_ = now;
  }

  /// @param expected  returned while there is too little to judge by
  double factor(double now, double expected) const {
    const double elapsed = now - before_start_;
    return !started_ || elapsed < kPeriod / 2 ? expected : (before_ + current_) / elapsed;
  }

 private:
  static constexpr double kPeriod = 1;  // [s]

  double before_ = 0, current_ = 0;  // simulated in the period before and in this one [s]
  double before_start_ = 0, current_start_ = 0;
  bool started_ = false;
};

}  // namespace weft::server
