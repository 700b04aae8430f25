#pragma once

#include <algorithm>
#include <utility>

#include "core/stop_signal.h"
#include "server/clock.h"
#include "server/tick_pacer.h"

namespace weft::server {

/// Runs a room at its rate by a given clock: commands between ticks, at most one tick a turn, then
/// what is to be told. A room that cannot keep up runs in slow motion and still hears commands
/// between any two ticks.
///
/// What comes while a tick passes is heard at its next stop point, if the inbox raises the room's
/// stop signal.
///
/// @tparam Room   take, take_meanwhile, gives_up, stop_signal, advancing, advance_until,
/// advance_waits, ticking, tick_interval, tick, finish_turn, next_wake
/// @tparam Inbox  take_all, wait, stopped
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

  /// Until the inbox is stopped.
  void run() {
    while (!inbox_.stopped()) {
      const double wake = turn();
      if (wake > clock_()) inbox_.wait(wake);
    }
  }

  /// One turn; returns when the next one is due unless something arrives before.
  double turn() {
    for (auto& item : inbox_.take_all()) room_.take(std::move(item));
    const double now = clock_();
    if (room_.advancing()) {
      // In slices, so that joins, the end of its viewer and the end of the server are heard.
      room_.advance_until(now + kAdvanceSlice);
      was_ticking_ = false;
      room_.finish_turn();
      return room_.advance_waits() ? now + kAdvancePause : now;
    }
    const bool ticking = room_.ticking();
    if (ticking && !was_ticking_) pacer_.restart(now);
    was_ticking_ = ticking;
    if (ticking && pacer_.take_due(now, room_.tick_interval())) room_.tick();
    room_.finish_turn();
    return room_.ticking() ? std::min(room_.next_wake(), pacer_.next()) : room_.next_wake();
  }

 private:
  /// In the midst of a tick: hears what has come.
  /// @returns whether the tick shall be given up
  bool attend() {
    if (inbox_.stopped()) return true;
    for (auto& item : inbox_.take_all()) room_.take_meanwhile(std::move(item));
    return room_.gives_up();
  }

  static constexpr double kAdvanceSlice = 0.01;   // [s]
  static constexpr double kAdvancePause = 0.001;  // while its viewer does not take its frames [s]

  Room& room_;
  Inbox& inbox_;
  Clock clock_;
  TickPacer pacer_;
  bool was_ticking_ = false;
};

}  // namespace weft::server
