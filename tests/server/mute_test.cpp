// A mute holds, and pins belong, to who comes again with its token.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

namespace weft::server {
namespace {

using nlohmann::json;
using proto::Role;

constexpr proto::ViewerId kOperator = 1;

/// A room with an operator, to which viewers come with tokens.
struct Class {
  TestRoom t{true};
  proto::ViewerId last = kOperator;

  Class() { t.join(kOperator); }

  proto::ViewerId come(std::uint64_t token, const char* name = "", bool glances = false) {
    Grant grant{Role::viewer, HandRight::by_policy, name, true, "", token};
    t.room->take({++last, 0, Join{false, grant, glances}});
    return last;
  }
  void say(const char* op, proto::ViewerId viewer, const char* more = "") {
    t.say(kOperator,
          std::string(R"({"op":")") + op + R"(","viewer":)" + std::to_string(viewer) + more + "}");
  }
  bool holds(proto::ViewerId viewer) {
    const json people = t.say(kOperator, R"({"op":"query","id":9,"what":"roster"})")["data"];
    for (const json& person : people)
      if (person["id"] == viewer) return person["hand"];
    throw std::runtime_error("the viewer is not in the room");
  }
};

}  // namespace

TEST_CASE("of those that come by one token as many are muted as were when they left") {
  Class room;
  const auto max = room.come(7), lea = room.come(7);
  room.say("mute", max);
  CHECK(room.holds(room.come(7)));  // the token of a class is no one's alone
  room.t.leave(max);
  CHECK(room.holds(room.come(8)));
  const auto wall = room.come(7, "", true);  // to glance is no way out
  room.t.leave(wall);
  const auto again = room.come(7);
  CHECK_FALSE(room.holds(again));
  CHECK(room.holds(room.come(7)));
  CHECK(room.holds(lea));
  room.t.room->take({again, 1, Grant{Role::viewer, HandRight::by_policy, "", true, "", 8}});
  room.t.leave(again);
  const auto by_other = room.come(8), by_same = room.come(7);
  CHECK_FALSE(room.holds(by_other));
  CHECK_FALSE(room.holds(by_same));
  room.say("give_hand", by_other);
  room.say("mute", by_same, R"(,"muted":false)");
  room.t.leave(by_other);
  room.t.leave(by_same);
  CHECK(room.holds(room.come(7)));
  CHECK(room.holds(room.come(8)));
}

TEST_CASE("a person that is muted is so by every connection with its token, until it may hold") {
  Class room;
  const auto first = room.come(7, "Max");
  room.say("mute", first);
  const auto second = room.come(7, "Max");
  CHECK_FALSE(room.holds(second));
  room.t.leave(first);
  room.t.leave(second);
  const auto again = room.come(7, "Max");
  CHECK_FALSE(room.holds(again));
  room.say("mute", again, R"(,"muted":false)");
  CHECK(room.holds(again));
  CHECK(room.holds(room.come(7, "Max")));
}

TEST_CASE("a person that is here by several connections is muted, and may hold again, by all") {
  Class room;
  const auto first = room.come(7, "Max"), second = room.come(7, "Max"), lea = room.come(8, "Lea"),
             unnamed = room.come(9), same = room.come(9);
  room.say("mute", first);
  CHECK_FALSE(room.holds(second));
  CHECK(room.holds(lea));
  room.say("give_hand", second);
  CHECK(room.holds(first));
  room.say("mute", unnamed);
  CHECK(room.holds(same));
}

TEST_CASE("a person that leaves and comes back with its token has its pins again") {
  TestRoom t(true);
  t.join(1);
  const Grant anna{Role::viewer, HandRight::by_policy, "Anna", true, "", 5};
  const Grant everyone{Role::viewer, HandRight::by_policy, "", true, "", 6};
  t.room->take({2, 0, Join{false, anna}});
  t.room->take({3, 0, Join{false, everyone}});
  const json pin = t.say(2, R"({"op":"pin","id":1,"particle":33})");
  const json other = t.say(3, R"({"op":"pin","id":2,"particle":30})");
  const auto release = [](const json& of) {
    return R"({"op":"release","id":3,"pin":)" + std::to_string(of["pin"].get<int>()) + "}";
  };
  t.room->take({2, 0, Leave{}});
  t.room->take({3, 0, Leave{}});
  t.room->take({4, 0, Join{false, everyone}});  // a token that a class shares is nobody's own
  CHECK(t.say(4, release(pin))["code"] == "not_allowed");
  CHECK(t.say(4, release(other))["code"] == "not_allowed");
  t.room->take({5, 0, Join{false, anna}});
  CHECK(t.say(5, release(pin))["op"] == "result");
}

TEST_CASE("a token that is told counts as a command until it is taken, also behind an advance") {
  Class room;
  int taken = 0;
  room.t.room->on_finished = [&](proto::ViewerId) { ++taken; };
  const auto tell = [&] {
    room.t.room->take({kOperator, ++room.t.number, Grant{Role::operator_, {}, "", true, "", 7}});
  };
  tell();
  CHECK(taken == 1);
  room.t.tell(kOperator, R"({"op":"advance","n":100000})");
  tell();
  CHECK(taken == 2);  // the advance
  room.t.tell(kOperator, R"({"op":"pause"})");
  room.t.room->finish_turn();
  CHECK(taken == 4);
}

TEST_CASE("who may not touch a pin is told whose it is, and who may") {
  Class room;
  const auto max = room.come(7), lea = room.come(8);
  const json own = room.t.say(max, R"({"op":"pin","id":1,"particle":30})");
  REQUIRE(own["op"] == "result");
  const std::uint32_t scenes = room.t.room->world().pins().list.front().id;
  const std::pair<json, const char*> pins[] = {{scenes, "scene"}, {own["pin"], "another viewer"}};
  for (const auto& [pin, whose] : pins) {
    const json commands[] = {{{"op", "release"}, {"pin", pin}, {"id", 2}},
                             {{"op", "move"}, {"pin", pin}, {"position", {0, 1, 0}}, {"id", 2}},
                             {{"op", "move"}, {"pin", pin}, {"stop", true}, {"id", 2}}};
    const bool of_scene = pin == json(scenes);
    for (const json& command : commands) {
      const json error = room.t.say(lea, command.dump());
      CHECK(error["code"] == "not_allowed");
      CHECK(error["field"] == "pin");
      CHECK(error["message"].get<std::string>().find(whose) != std::string::npos);
      const json may = of_scene ? json{"operator", "admin"} : json{"owner", "operator", "admin"};
      CHECK(error["limit"]["allowed"] == may);
      CHECK((error["hint"].get<std::string>().find("owner") == std::string::npos) == of_scene);
    }
  }
}

}  // namespace weft::server
