#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/constants.h"
#include "server/room/budget_keeper.h"
#include "server/room/tick_pacer.h"

namespace weft::server {

/// The latest durations of ticks.
class TickTimes {
 public:
  /// @param seconds  at least 0
  void add(double seconds) {
    if (ring_.size() < kTickTimes) ring_.resize(ring_.size() + 1);
    ring_[next_++ % ring_.size()] = seconds;
    if (next_ == kTickTimes) next_ = 0;
  }
  void clear() {
    ring_.clear();
    next_ = 0;
  }
  /// [s]; nothing without a tick.
  std::optional<double> median() const {
    if (ring_.empty()) return std::nullopt;
    std::vector<double> times = ring_;
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
  }

 private:
  std::vector<double> ring_;
  std::size_t next_ = 0;
};

/// Decides when viewers are told that time passes too slowly: after some patience, and then not at
/// once again.
class SlowMotion {
 public:
  /// @param factor  simulated per real time
  /// @param wanted  the same
  /// @returns whether to tell it now
  bool look(double factor, double wanted, double now) {
    if (factor >= kSlow * wanted) {
      since_ = -1;
      return false;
    }
    if (since_ < 0) since_ = now;
    if (now - since_ < kSlowPatience || now < next_notice_) return false;
    next_notice_ = now + kSlowNoticePause;
    return true;
  }

 private:
  double since_ = -1;  ///< -1: it is not slow [s]
  double next_notice_ = 0;
};

/// How a room's time passes: whether ticks follow the clock, at which speed, and how well they keep
/// up. All times are in seconds of the room's clock.
class RoomClock {
 public:
  RoomClock(bool paused, double now) : paused_(paused) { meter_.restart(now); }

  bool paused() const { return paused_; }
  std::uint32_t steps_left() const { return steps_left_; }
  /// Whether ticks follow the clock: it is not paused, or some steps were asked for.
  bool runs() const { return !paused_ || steps_left_ > 0; }

  void pause() {
    paused_ = true;
    steps_left_ = 0;
  }
  void resume(double now) {
    if (paused_) meter_.restart(now);
    paused_ = false;
    steps_left_ = 0;
  }
  /// While it is paused.
  void add_steps(std::uint32_t count, double now) {
    if (steps_left_ == 0) meter_.restart(now);
    steps_left_ += count;
  }
  void drop_steps() { steps_left_ = 0; }
  /// A tick of the clock is done.
  /// @returns whether it was the last of the steps that were asked for
  bool take_step() { return paused_ && steps_left_ > 0 && --steps_left_ == 0; }

  double wanted_speed() const { return wanted_speed_; }
  /// Simulated per real time: the wanted speed, reduced if a time budget requires it.
  double speed() const { return wanted_speed_ * budget_.setting().pace; }
  void set_speed(double speed) { wanted_speed_ = speed; }

  /// Another scene begins: its ticks, its budget, and springs as stiff as it says.
  void begin_scene(const BudgetDef& budget) {
    times_.clear();
    wanted_softness_ = 1;
    budget_.restart(budget, {});
  }
  double wanted_softness() const { return wanted_softness_; }
  void set_softness(double softness) { wanted_softness_ = softness; }
  /// Springs are what they were at another time.
  /// @param present  as the budget had left them
  void restore_softness(double wanted, double present) {
    wanted_softness_ = wanted;
    budget_.restart(budget_.budget(), {budget_.setting().pace, present}, wanted);
  }
  /// Holds to a budget from now on, without the restrictions of the previous one.
  void set_budget(const BudgetDef& budget) {
    budget_.restart(budget, {1, wanted_softness_}, wanted_softness_);
  }
  BudgetKeeper& budget() { return budget_; }
  const BudgetKeeper& budget() const { return budget_; }

  /// Judges the real-time factor anew.
  void restart_meter(double now) { meter_.restart(now); }
  /// A tick of the clock has let so much time pass.
  void note_passed(double simulated, double now) { meter_.add(simulated, now); }
  double real_time_factor(double now) const { return meter_.factor(now, speed()); }
  /// @returns whether viewers should be told that time passes slowly
  bool is_slow(double now) { return slow_.look(real_time_factor(now), speed(), now); }

  /// A tick of any kind took so long and is done.
  void note_tick(double seconds) { times_.add(seconds); }
  void note_end_of_tick(double now) { last_tick_done_ = now; }
  double last_tick_done() const { return last_tick_done_; }
  std::optional<double> median_tick() const { return times_.median(); }

 private:
  bool paused_;
  std::uint32_t steps_left_ = 0;
  double wanted_speed_ = 1, wanted_softness_ = 1;
  BudgetKeeper budget_;
  RealTimeMeter meter_;
  TickTimes times_;
  SlowMotion slow_;
  double last_tick_done_ = 0;
};

}  // namespace weft::server
