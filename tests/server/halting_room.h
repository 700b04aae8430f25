#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/fakes.h"

// Rooms whose ticks end at a chosen stop point, and jobs that a test runs when it wants.

namespace weft::server {

/// A limit whose CPU time is set by hand and passes with each look at it.
struct HandLimit {
  double now = 0, step = 0;
  WorkLimit limit{2, [this] { return now += step; }};
};

/// A room whose ticks end at a chosen stop point, as if they had taken too long.
struct HaltingRoom {
  explicit HaltingRoom(bool paused = false, RoomOptions options = {}) {
    options.limit = &hand.limit;
    room = std::make_unique<TestRoom>(paused, std::vector<std::pair<std::string, std::string>>{},
                                      options);
    hand.limit.signal().attend = [this] {
      if (seen++ == stop) hand.now += takes;
      if (at_stop) at_stop();
      return room->room->gives_up();
    };
    hand.limit.signal().raise();
  }
  Room& get() { return *room->room; }
  /// Ends the coming tick at its stop point of this number.
  void halt_at(int number) {
    seen = 0;
    stop = number;
  }

  HandLimit hand;
  int seen = 0, stop = -1;
  double takes = 3;               ///< CPU time at the chosen stop point [s]
  std::function<void()> at_stop;  ///< done at each stop point
  std::unique_ptr<TestRoom> room;
};

/// Jobs that are done when a test says so.
struct Jobs {
  std::vector<std::function<void()>> list;
  void run_all() {
    for (auto& job : std::exchange(list, {})) job();
  }
};

inline RoomOptions with_jobs(Jobs& jobs) {
  RoomOptions options;
  options.beside = [&jobs](std::function<void()> job) { jobs.list.push_back(std::move(job)); };
  return options;
}

}  // namespace weft::server
