#pragma once

namespace weft::server {

/// Decides when the next tick is due. A few late ticks are caught up; beyond that the backlog is
/// dropped, simulated time slows down, and the loop never spirals.
class TickPacer {
 public:
  static constexpr int kMostLateTicks = 4;

  /// The next tick is due now.
  void restart(double now) { next_ = now; }

  /// Whether a tick is due; if so, the next one is due one interval later.
  /// @param interval  real time between ticks [s]
  bool take_due(double now, double interval) {
    if (now < next_) return false;
    const double oldest = now - kMostLateTicks * interval;
    if (next_ < oldest) next_ = oldest;
    next_ += interval;
    return true;
  }

  double next() const { return next_; }

 private:
  double next_ = 0;
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
