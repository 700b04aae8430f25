#include <functional>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

// How many frames a room makes and how often it tells what has changed, whatever its viewers send.

namespace weft::server {
namespace {

using nlohmann::json;

constexpr double kTick = 1.0 / 60;  // of the test's scenes [s]

proto::Frame decoded(const std::string& bytes) {
  return *proto::decode_frame(std::as_bytes(std::span(bytes)));
}

/// A message that a viewer sends again and again, the k-th time.
struct Flood {
  const char* name;
  std::function<std::string(int)> text;
};

const std::vector<Flood> kFloods = {
    {"moves of a hand",
     [](int k) {
       return R"({"op":"drag","phase":"move","target":[0,1,)" + std::to_string(k % 7) + "]}";
     }},
    {"settings", [](int k) { return R"({"op":"set","drag":)" + std::to_string(1 + k % 3) + "}"; }},
    {"pins", [](int) { return std::string(R"({"op":"pin","particle":30})"); }},
    {"names", [](int k) { return R"({"op":"hello","name":"n)" + std::to_string(k) + R"("})"; }},
    {"cameras",
     [](int k) {
       return R"({"op":"camera","position":[0,1,)" + std::to_string(3 + k) +
              R"(],"target":[0,0,0]})";
     }},
    {"queries", [](int) { return std::string(R"({"op":"query","id":7,"what":"energies"})"); }},
};

/// Messages that tell all viewers how something is, and notices.
std::size_t tellings(const RecordingOutput& output, const std::string& op) {
  return static_cast<std::size_t>(
      std::count_if(output.sent.begin(), output.sent.end(), [&op](const auto& message) {
        return message.first == 0 && json::parse(message.second)["op"] == op;
      }));
}

/// A room with the viewers 1 and 2, of which 1 has a hand in the cloth.
struct SharedRoom : TestRoom {
  explicit SharedRoom(bool paused) : TestRoom(paused) {
    join(1);
    join(2);
    tell(1, R"({"op":"drag","phase":"start","particle":38})");
    settle();
  }

  /// Until all is told.
  void settle() {
    clock.now += 1;
    if (room->ticking()) room->tick();
    room->finish_turn();
    clock.now += kTick;
    output.sent.clear();
    output.frames.clear();
    output.offered.clear();
  }

  /// One message, after which the room finishes its turn as it does when one comes alone.
  void turn(const std::string& text) {
    tell(1, text);
    room->finish_turn();
  }
};

TEST_CASE("while ticks pass each makes one frame, whatever commands come between them") {
  for (const Flood& flood : kFloods) {
    INFO(flood.name);
    SharedRoom t(false);
    const std::uint64_t first = t.room->world().tick();
    for (int k = 0; k < 60 * 16; ++k) {
      t.turn(flood.text(k));
      t.clock.now += kTick / 16;
      if (k % 16 != 15) continue;
      t.room->tick();
      t.room->finish_turn();
    }
    CHECK(t.output.frames_for(2) == 60);
    for (std::size_t i = 0; i < t.output.frames.size(); ++i)
      CHECK(decoded(t.output.frames[i]).header.tick == first + i + 1);
    for (const char* op : {"state", "roster", "pins", "grabs", "notice"})
      CHECK(tellings(t.output, op) <= 61);
  }
}

TEST_CASE("in slow motion, too, each tick makes one frame") {
  SharedRoom t(false);
  t.tell(1, R"({"op":"speed","speed":0.01})");
  t.settle();
  for (int k = 0; k < 10; ++k) {
    for (int i = 0; i < 20; ++i) {
      t.clock.now += t.room->tick_interval() / 20;
      t.turn(kFloods[0].text(i));
    }
    t.room->tick();
    t.room->finish_turn();
  }
  CHECK(t.output.frames_for(2) == 10);
}

TEST_CASE("while no ticks pass frames and tellings come at most once in a tick's time") {
  for (const Flood& flood : kFloods) {
    INFO(flood.name);
    SharedRoom t(true);
    for (int k = 0; k < 1000; ++k) {
      t.clock.now += 0.001;
      t.turn(flood.text(k));
    }
    CHECK(t.output.frames_for(2) <= 61);
    for (const char* op : {"state", "roster", "pins", "grabs", "notice"})
      CHECK(tellings(t.output, op) <= 61);
  }
}

TEST_CASE("while no ticks pass only what is shown makes a frame") {
  SharedRoom t(true);
  t.turn(R"({"op":"drag","phase":"move","target":[0,1,0.5]})");
  t.settle();
  const std::vector<std::string> without_effect = {
      R"({"op":"drag","phase":"move","target":[0,1,0.5]})",  // a hand that rests
      R"({"op":"hello","name":"Ada"})",
      R"({"op":"camera","position":[0,1,3],"target":[0,0,0]})",
      R"({"op":"set","drag":3})",
      R"({"op":"speed","speed":2})",
      R"({"op":"pause"})",
      R"({"op":"query","id":1,"what":"positions"})",
      R"({"op":"hash","id":2})",
      R"({"op":"pin","id":3,"particle":4000})"};  // refused
  for (const std::string& text : without_effect) {
    INFO(text);
    t.clock.now += 1;
    t.turn(text);
    t.room->take({1, ++t.number, Noted{}});  // and a view without effect
    t.room->finish_turn();
    CHECK(t.output.frames.empty());
  }
  t.clock.now += 1;
  t.turn(R"({"op":"drag","phase":"move","target":[0,1,0.6]})");
  CHECK(t.output.frames.size() == 1);
}

TEST_CASE("what a flood leaves untold is told within a tick's time, and then the room rests") {
  for (const bool paused : {true, false}) {
    SharedRoom t(paused);
    for (int k = 0; k < 50; ++k) {
      t.tell(1, R"({"op":"hello","name":"n)" + std::to_string(k) + R"("})");
      t.turn(R"({"op":"pin","particle":30})");
    }
    CHECK(tellings(t.output, "pins") == 1);
    const double wake = t.room->next_wake();
    CHECK(wake <= t.clock.now + kTick * 1.001);
    t.clock.now = wake;
    t.room->finish_turn();
    CHECK(t.output.last("pins")["pins"].size() == 52);
    CHECK(t.output.last("roster")["viewers"][0]["name"] == "n49");
    t.clock.now = t.room->next_wake();
    t.room->finish_turn();
    CHECK(t.room->next_wake() > t.clock.now);
  }
}

TEST_CASE("long lists of pins are told to each viewer at no more than 2 MB/s") {
  SharedRoom t(true);
  for (int k = 0; k < 4000; ++k) t.tell(1, R"({"op":"pin","particle":30})");
  t.settle();
  std::size_t bytes = 0, longest = 0;
  for (int k = 0; k < 500; ++k) {
    t.clock.now += 0.01;
    t.turn(R"({"op":"move","pin":5,"stop":true})");
    for (const auto& [viewer, text] : std::exchange(t.output.sent, {})) {
      bytes += viewer == 0 ? text.size() : 0;
      longest = std::max(longest, text.size());
    }
  }
  CHECK(longest > 100'000);
  CHECK(bytes <= 2'000'000 * 5 + longest);
  CHECK(bytes >= 1'000'000 * 5);
}

TEST_CASE("what happens again and again is noticed once in a tick's time") {
  SharedRoom t(true);
  for (int k = 0; k < 1000; ++k) {
    t.clock.now += 0.001;
    t.turn(R"({"op":"reset"})");
  }
  CHECK(tellings(t.output, "notice") <= 61);
  CHECK(tellings(t.output, "notice") >= 50);
}

TEST_CASE("the first frame of who joins comes at once, and to it alone") {
  for (const bool paused : {true, false}) {
    SharedRoom t(paused);
    t.turn(R"({"op":"drag","phase":"move","target":[0,1,0.5]})");
    t.output.offered.clear();
    for (proto::ViewerId viewer = 3; viewer < 40; ++viewer) {
      t.join(viewer);
      CHECK(t.output.frames_for(viewer) == 1);
    }
    CHECK(t.output.frames_for(2) == 0);
  }
}

TEST_CASE("who wants frames again gets the present one, and nobody else") {
  SharedRoom t(true);
  for (int k = 0; k < 1000; ++k) {
    t.clock.now += 0.001;
    t.room->take({1, ++t.number, Noted{true, {}}});
    t.room->finish_turn();
  }
  CHECK(t.output.frames_for(1) >= 1);
  CHECK(t.output.frames_for(1) <= 61);
  CHECK(t.output.frames_for(2) == 0);
}

TEST_CASE("the frames after a reset and of a new epoch come at once, however many are asked for") {
  for (const bool paused : {true, false}) {
    for (const char* text : {R"({"op":"reset"})", R"({"op":"load","scene":"other"})"}) {
      SharedRoom t(paused);
      t.turn(R"({"op":"drag","phase":"move","target":[0,1,0.5]})");
      t.output.offered.clear();
      t.turn(text);
      REQUIRE(t.output.frames_for(2) == 1);
      CHECK(t.output.offered.back().at_once);
      CHECK(decoded(t.output.frames.back()).header.tick == 0);
    }
    SharedRoom t(paused);
    for (int k = 0; k < 1000; ++k) {
      t.clock.now += 0.001;
      t.turn(R"({"op":"reset"})");
    }
    CHECK(t.output.frames_for(2) <= 61);
  }
}

}  // namespace
}  // namespace weft::server
