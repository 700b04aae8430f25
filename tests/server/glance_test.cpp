// Who glances at a room, as a wall of small pictures does, is nobody in it and costs it little.

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/net/hub.h"
#include "tests/server/fakes.h"

namespace weft::server {
namespace {

using nlohmann::json;
using proto::Role;

constexpr proto::ViewerId kWall = 7;

/// A room that rests while nobody is in it, with a wall that looks at it.
struct Watched {
  Watched() : t(false, {}, resting()) {
    t.room->take({kWall, 0, Join{false, Grant{Role::admin, HandRight::given, "Wall", true}, true}});
  }
  static RoomOptions resting() {
    RoomOptions options;
    options.rests_when_empty = true;
    return options;
  }
  json roster() {
    const json answer = t.say(kWall, R"({"op":"query","what":"roster","id":9})");
    return answer["data"];
  }

  TestRoom t;
};

}  // namespace

TEST_CASE("who glances is in no roster and no count, and time stands where nobody else is") {
  Watched w;
  CHECK(w.t.room->viewers() == 0);
  CHECK_FALSE(w.t.room->ticking());
  CHECK(w.t.output.count("welcome") == 1);
  CHECK(w.t.output.frames_for(kWall) == 1);
  CHECK(w.roster().empty());
  w.t.join(1);
  CHECK(w.t.room->viewers() == 1);
  CHECK(w.t.room->ticking());
  REQUIRE(w.roster().size() == 1);
  CHECK(w.roster()[0]["id"] == 1);
  w.t.leave(1);
  CHECK(w.t.room->viewers() == 0);
  CHECK_FALSE(w.t.room->ticking());
}

TEST_CASE("a room that rests is woken by a glance for its picture alone") {
  Watched w;
  w.t.room->finish_turn();
  CHECK(w.t.room->next_wake() > w.t.clock.now + 1e6);
  Noted wish;
  wish.wants_frame = true;
  w.t.room->take({kWall, 1, wish});
  CHECK(w.t.room->next_wake() <= w.t.clock.now + 1);
  w.t.clock.now += 1;
  w.t.room->finish_turn();
  CHECK(w.t.output.frames_for(kWall) == 2);
  CHECK(w.t.room->next_wake() > w.t.clock.now + 1e6);
  w.t.room->take({kWall, 2, Leave{}});
  CHECK(w.t.room->viewers() == 0);
}

TEST_CASE("who glances may change nothing, whatever its token, and others cannot give it a hand") {
  Watched w;
  w.t.join(1);
  for (const char* command :
       {R"({"op":"pause","id":1})", R"({"op":"drag","phase":"start","drag":1,"particle":3,"id":1})",
        R"({"op":"fork","name":"mine","id":1})", R"({"op":"reset","id":1})"})
    CHECK(w.t.say(kWall, command)["code"] == "not_allowed");
  CHECK(w.t.say(1, R"({"op":"give_hand","viewer":7,"id":2})")["code"] == "unknown_viewer");
  w.t.room->take({kWall, 3, Grant{Role::admin, HandRight::given, "", true}});
  CHECK(w.t.say(kWall, R"({"op":"pause","id":3})")["code"] == "not_allowed");
}

TEST_CASE("who glances does not become the operator of a room that has none") {
  Watched w;
  w.t.room->take({1, 0, Join{}});
  w.t.leave(1);
  CHECK(w.t.say(kWall, R"({"op":"pause","id":4})")["code"] == "not_allowed");
}

TEST_CASE("nobody sees where who glances points") {
  Watched w;
  w.t.join(1);
  w.t.output.sent.clear();
  w.t.tell(kWall, R"({"op":"presence","cursor":[0,1,0]})");
  w.t.tick(60);
  CHECK(w.t.output.count("presence") == 0);
}

TEST_CASE("of what is told to all who glances gets the state alone, the newest once a second") {
  FakeClock fake;
  Metrics metrics;
  Hub hub(fake.clock(), 60, {}, metrics);
  FakeStream wall, other;
  wall.channel = &hub.add(kWall, wall);
  other.channel = &hub.add(1, other);
  hub.set_glance(kWall);
  hub.welcome_done(kWall);
  hub.welcome_done(1);
  for (int tick = 0; tick < 120; ++tick) {
    hub.broadcast(text_message("state " + std::to_string(tick), Topic::state));
    hub.broadcast(text_message("roster", Topic::roster));
    hub.broadcast(text_message("notice"));
    fake.now += 1.0 / 60;
    hub.poll();
    wall.drain();
    other.drain();
  }
  CHECK(other.written.size() == 360);
  REQUIRE(wall.written.size() == 2);
  CHECK(wall.written[0] == "state 0");
  fake.now += 1;
  hub.poll();
  wall.drain();
  CHECK(wall.written.back() == "state 119");
}

TEST_CASE("a state of the scene before does not come after a new mesh") {
  FakeClock fake;
  Metrics metrics;
  Hub hub(fake.clock(), 60, {}, metrics);
  FakeStream wall;
  wall.channel = &hub.add(kWall, wall);
  hub.set_glance(kWall);
  hub.welcome_done(kWall);
  hub.broadcast(text_message("old", Topic::state));
  hub.offer_mesh(99, SharedBytes(std::string("mesh")));
  hub.poll();
  CHECK(wall.written.empty());
  hub.broadcast(text_message("new", Topic::state));
  hub.poll();
  CHECK(wall.written == std::vector<std::string>{"new"});
}

}  // namespace weft::server
