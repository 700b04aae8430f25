#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/fakes.h"

// Rooms whose ticks end at a chosen stop point, jobs that a test runs when it wants, and logs that
// are replayed.

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

inline std::string hash_of(const Room& room) {
  return proto::hash_text(room.world().hash());
}

/// The same commands in a room of its own, on other threads.
inline std::string replayed(const Room& original, std::uint64_t ticks, Executor* executor) {
  RecordingOutput output;
  FakeClock clock;
  Metrics metrics;
  RoomOptions options;
  options.scene = "small";
  options.paused = true;
  Room replay(options, small_scene, output, clock.clock(), metrics, executor);
  replay.take({1, 0, Join{}});
  for (const LogEntry& entry : original.log().entries()) {
    while (replay.world().tick() < entry.tick) replay.tick();
    replay.take({1, 1, proto::Request{std::nullopt, entry.command}});
  }
  while (replay.world().tick() < ticks) replay.tick();
  return hash_of(replay);
}

}  // namespace weft::server
