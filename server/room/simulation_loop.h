#pragma once

#include <algorithm>
#include <utility>

#include "core/stop_signal.h"
#include "server/clock.h"
#include "server/room/tick_pacer.h"

namespace weft::server {

/// The turns of a room at its rate by a given clock: commands between ticks, at most one tick a
/// turn, then announcements. A room that cannot keep up runs in slow motion and still takes
/// commands between any two ticks.
///
/// Input that arrives during a tick is handled at the tick's next stop point, if the inbox raises
/// the room's stop signal.
///
/// @tparam Room   take, take_meanwhile, gives_up, stop_signal, advancing, advance_until,
/// advance_waits, ticking, tick_interval, tick, finish_turn, next_wake
/// @tparam Inbox  take_all, stopped
template <class Room, class Inbox>
class SimulationLoop {
 public:
  SimulationLoop(Room& room, Inbox& inbox, Clock clock)
      : room_(room), inbox_(inbox), clock_(std::move(clock)) {
    if (StopSignal* const signal = room_.stop_signal()) {
      signal->attend = [this, signal] {
        signal->lower();
        return attend();
      };
    }
  }

  /// One turn; returns when the next one is due unless input arrives before.
  double turn() {
    for (auto& item : inbox_.take_all()) room_.take(std::move(item));
    const double now = clock_();
    ticked_ = false;
    if (room_.advancing()) {
      // In slices, so that joins, the loss of its viewer and the server's end are noticed.
      room_.advance_until(now + kAdvanceSlice);
      was_ticking_ = false;
      room_.finish_turn();
      if (room_.advancing()) return room_.advance_waits() ? now + kAdvancePause : now;
      // Once it has ended, a turn at once would find nothing to do, after each advance of a script.
      return room_.ticking() ? now : room_.next_wake();
    }
    const bool ticking = room_.ticking();
    if (ticking && !was_ticking_) pacer_.restart(now);
    was_ticking_ = ticking;
    pacer_.set_interval(room_.tick_interval(), now);
    late_ = now - pacer_.next();
    ticked_ = ticking && pacer_.take_due(now);
    if (ticked_) room_.tick();
    room_.finish_turn();
    pacer_.set_interval(room_.tick_interval(), now);  // commands that had to wait may have set it
    return room_.ticking() ? std::min(room_.next_wake(), pacer_.next()) : room_.next_wake();
  }

  /// Whether the last turn passed a tick by the clock, and how long after it was due that began
  /// [s].
  bool ticked() const { return ticked_; }
  double late() const { return late_; }

 private:
  /// During a tick: handles what has arrived.
  /// @returns whether to give up the tick
  bool attend() {
    if (inbox_.stopped()) return true;
    for (auto& item : inbox_.take_all()) room_.take_meanwhile(std::move(item));
    return room_.gives_up();
  }

  static constexpr double kAdvanceSlice = 0.01;   // [s]
  static constexpr double kAdvancePause = 0.001;  // while its viewer takes no frames [s]

  Room& room_;
  Inbox& inbox_;
  Clock clock_;
  TickPacer pacer_;
  bool was_ticking_ = false, ticked_ = false;
  double late_ = 0;
};

}  // namespace weft::server
