#include "server/rooms/rooms.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

// The set of rooms of a server, without a network.

namespace weft::server {
namespace {

constexpr auto kLook = std::chrono::milliseconds(1);  // between two looks at what is waited for

/// What outputs of rooms have in common.
struct Outside {
  std::atomic<int> closed = 0;
  std::atomic<bool> blocks = false;  ///< what is sent to a viewer is not taken, so that turns last
  std::atomic<bool> fails = false;   ///< rooms get no output, so that none opens
};

/// An output that no viewer listens to.
struct NoOutput : RoomOutput {
  explicit NoOutput(Outside& all) : outside(all) {}
  void send(proto::ViewerId, Message) override {
    while (outside.blocks) std::this_thread::sleep_for(kLook);
  }
  void set_frame_rate(double) override {}
  void broadcast(Message) override {}
  void offer_mesh(std::uint64_t, SharedBytes, PackedMesh) override {}
  void welcome_done(proto::ViewerId) override {}
  bool wants_frames() const override { return false; }
  bool wants_forces() const override { return false; }
  void offer_frame(Frame) override {}
  void close() override { ++outside.closed; }

  Outside& outside;
};

RoomOptions small_room() {
  RoomOptions options;
  options.scene = "small";
  options.scene_names = {"small", "other"};
  return options;
}

struct TestRooms {
  explicit TestRooms(std::size_t most = 4, double idle_seconds = 0)
      : rooms(
            {.threads = 2, .most = most, .idle_seconds = idle_seconds, .waiting_commands = 8},
            small_room(), small_scene,
            [this](Metrics&) {
              if (outside.fails) throw std::runtime_error("no output");
              return std::make_shared<NoOutput>(outside);
            },
            process_seconds, metrics) {
    rooms.open_default();
    rooms.start();
  }

  proto::Result<proto::RoomInfo> open(const std::string& name, bool paused = false,
                                      const std::string& maker = {}) {
    const auto kept = rooms.reserve(name, maker);
    if (!kept) return kept.error();
    return rooms.open(*kept, build_scene(small_scene("other"), nullptr, 0), paused);
  }

  Outside outside;
  Metrics metrics;
  Rooms rooms;
};

TickCost cost_of(double particles) {
  return {.particles = particles, .substeps = 1, .tick_rate = 60};
}

TEST_CASE("a name belongs to one room, from its reservation until the room is closed") {
  TestRooms t;
  {
    const auto kept = t.rooms.reserve("a", "");
    REQUIRE(kept);
    CHECK(t.rooms.reserve("a", "").error().code == proto::ErrorCode::room_exists);
    CHECK(t.rooms.find("a") == nullptr);
  }
  const auto room = t.open("a", true);
  REQUIRE(room);
  CHECK(room->name == "a");
  CHECK(room->scene == small_scene("other").name);
  CHECK(room->particles == 35);
  CHECK(room->paused);
  CHECK(t.open("a").error().field == "name");
  CHECK_FALSE(t.rooms.close("a"));
  CHECK(t.outside.closed == 1);
  CHECK(t.rooms.find("a") == nullptr);
  CHECK(t.rooms.close("a")->code == proto::ErrorCode::unknown_room);
  CHECK(t.open("a"));
}

TEST_CASE("the default room is there from the start and cannot be closed") {
  TestRooms t;
  CHECK(t.rooms.close("default")->code == proto::ErrorCode::not_allowed);
  REQUIRE(t.rooms.find("default"));
  CHECK(t.open("default").error().code == proto::ErrorCode::room_exists);
}

TEST_CASE("there are no more rooms than allowed, those that are being built among them") {
  TestRooms t(3);
  REQUIRE(t.open("a"));
  const auto kept = t.rooms.reserve("b", "");
  REQUIRE(kept);
  const auto refused = t.rooms.reserve("c", "");
  CHECK(refused.error().code == proto::ErrorCode::too_many);
  CHECK(refused.error().limit->maximum == 3);
  CHECK(t.rooms.list().rooms.size() == 2);
  CHECK(t.rooms.list().most == 3);
}

TEST_CASE("one viewer has four rooms at a time, and viewers leave operators a quarter of all") {
  TestRooms t(12);
  for (const char* name : {"a", "b", "c"}) REQUIRE(t.open(name, true, "pupil"));
  {
    const auto kept = t.rooms.reserve("d", "pupil");  // counts while it is being built
    REQUIRE(kept);
    CHECK_FALSE(t.rooms.reserve("e", "pupil"));
  }
  REQUIRE(t.open("d", true, "pupil"));
  const proto::Error refused = t.open("e", true, "pupil").error();
  CHECK(refused.code == proto::ErrorCode::too_many);
  CHECK(refused.limit->maximum == 4);
  CHECK_FALSE(refused.hint.empty());
  CHECK(t.open("e", true, "other"));
  CHECK(t.open("f", true));
  CHECK_FALSE(t.rooms.close("b"));
  CHECK(t.open("g", true, "pupil"));
  for (const char* name : {"h", "i", "j", "k"}) REQUIRE(t.open(name, true, name));
  const proto::Error full = t.open("l", true, "last").error();
  CHECK(full.code == proto::ErrorCode::too_many);
  CHECK(full.limit->maximum == 9);
  CHECK(t.open("l", true));
}

TEST_CASE("one viewer's rooms may cost half of what all may, and those of viewers three quarters") {
  TestRooms t(12);
  for (const char* name : {"a", "b"}) REQUIRE(t.open(name, true, "pupil"));
  REQUIRE(t.open("c", true, "other"));
  REQUIRE(t.open("d", true, "third"));
  const double most = kMostParticlesOfRooms, own = 35;  // of each of them
  CHECK_FALSE(t.rooms.admit("a", cost_of(most / 2 - own)));
  const auto half = t.rooms.admit("b", cost_of(own + 1));
  REQUIRE(half);
  CHECK(half->code == proto::ErrorCode::too_costly);
  CHECK(half->limit->maximum == most / 2);
  CHECK_FALSE(t.rooms.admit("c", cost_of(most / 4 - own)));
  const auto three_quarters = t.rooms.admit("d", cost_of(own + 1));
  REQUIRE(three_quarters);
  CHECK(three_quarters->limit->maximum == most * 0.75);
  CHECK_FALSE(t.rooms.admit("default", cost_of(most / 4)));
}

TEST_CASE("all rooms together keep to one bound of particles and one of updates") {
  TestRooms t;
  REQUIRE(t.open("a"));
  const double own = 42;  // of the default room
  const double most = kMostParticlesOfRooms;
  CHECK_FALSE(t.rooms.admit("a", cost_of(most - own)));
  const auto refused = t.rooms.admit("default", cost_of(own + 1));
  REQUIRE(refused);
  CHECK(refused->code == proto::ErrorCode::too_costly);
  CHECK(refused->limit->maximum == most);
  CHECK(t.open("b").error().code == proto::ErrorCode::too_costly);
  CHECK_FALSE(t.rooms.close("a"));
  CHECK_FALSE(t.rooms.admit("default", cost_of(own + 1)));
  CHECK(t.rooms.admit(
      "default", {.particles = 1000, .substeps = kMostUpdatesOfRooms / 1000, .tick_rate = 60}));
}

TEST_CASE("a room that could not be opened, or is closed, costs the others nothing") {
  TestRooms t;
  t.outside.fails = true;
  CHECK_THROWS(t.open("a"));
  CHECK_FALSE(t.rooms.admit("default", cost_of(kMostParticlesOfRooms)));
  CHECK_FALSE(t.rooms.admit("default", cost_of(1)));
  t.outside.fails = false;
  REQUIRE(t.open("a"));
  CHECK_FALSE(t.rooms.close("a"));
  // As by a load whose turn is not over yet.
  CHECK_FALSE(t.rooms.admit("a", cost_of(kMostParticlesOfRooms)));
  CHECK_FALSE(t.rooms.admit("default", cost_of(kMostParticlesOfRooms)));
  CHECK_FALSE(t.rooms.admit("default", cost_of(1)));
  t.rooms.stop();
  CHECK(t.open("b").error().code == proto::ErrorCode::busy);
  CHECK_FALSE(t.rooms.admit("default", cost_of(kMostParticlesOfRooms)));
}

TEST_CASE("an empty room closes after its time, and the default one never does") {
  TestRooms kept(4, 1e6), closing(4, 1e-9);
  REQUIRE(kept.open("a"));
  REQUIRE(closing.open("a"));
  kept.rooms.close_empty();
  closing.rooms.close_empty();
  CHECK(kept.rooms.find("a"));
  CHECK_FALSE(closing.rooms.find("a"));
  CHECK(closing.rooms.find("default"));
}

TEST_CASE("time stands in a room without viewers, and passes while it has one") {
  TestRooms t;
  REQUIRE(t.open("a"));
  const auto room = t.rooms.find("a");
  const auto other = t.rooms.find("default");
  const std::uint64_t begun = other->info().tick;
  while (other->info().tick < begun + 5) std::this_thread::sleep_for(kLook);
  CHECK(room->info().tick == 0);
  room->put({1, 0, Join{}});
  while (room->info().tick < 5) std::this_thread::sleep_for(kLook);
  CHECK(room->info().viewers == 1);
  room->put({1, 1, Leave{}});
  while (room->info().viewers > 0) std::this_thread::sleep_for(kLook);
  const std::uint64_t left = room->info().tick, then = other->info().tick;
  while (other->info().tick < then + 5) std::this_thread::sleep_for(kLook);
  CHECK(room->info().tick == left);
  CHECK(t.rooms.readiness().ready);
}

TEST_CASE("readiness names the room whose turn does not end, and the others go on") {
  TestRooms t;
  REQUIRE(t.open("a"));
  CHECK(t.rooms.readiness().room == "default");
  t.outside.blocks = true;
  t.rooms.find("a")->put({1, 0, Join{}});
  while (t.rooms.readiness().ready) std::this_thread::sleep_for(kLook);
  const proto::Readiness told = t.rooms.readiness();
  CHECK(told.room == "a");
  CHECK(told.stalled > kStallSeconds);
  const auto other = t.rooms.find("default");
  const std::uint64_t tick = other->info().tick;
  while (other->info().tick < tick + 5) std::this_thread::sleep_for(kLook);
  t.outside.blocks = false;
  while (!t.rooms.readiness().ready) std::this_thread::sleep_for(kLook);
}

TEST_CASE("metrics count all rooms together and tell each one's, and a sum never falls") {
  TestRooms t;
  REQUIRE(t.open("a"));
  const auto room = t.rooms.find("a");
  room->put({1, 0, Join{}});
  while (room->info().tick < 5) std::this_thread::sleep_for(kLook);
  const std::string text = t.rooms.metrics_text();
  CHECK(text.find("weft_rooms 2\n") != std::string::npos);
  for (const char* name : {"a", "default"})
    CHECK(text.find("weft_room_ticks_total{room=\"" + std::string(name) + "\"} ") !=
          std::string::npos);
  CHECK(text.find("weft_tick_late_seconds_count{room=\"a\"} ") != std::string::npos);
  Metrics whole;
  {
    Metrics one(&whole);
    one.count_tick(0.01, 0.008);
    one.set_viewers(3);
    CHECK(whole.text().find("weft_viewers 3\n") != std::string::npos);
  }
  CHECK(whole.text().find("weft_ticks_total 1\n") != std::string::npos);
  CHECK(whole.text().find("weft_viewers 0\n") != std::string::npos);
}

}  // namespace
}  // namespace weft::server
