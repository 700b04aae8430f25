// How much of the cloth one viewer may hold or pin while others are there.

#include <string>

#include <catch2/catch.hpp>

#include "server/net/tokens.h"
#include "server/options.h"
#include "tests/server/halting_room.h"

namespace weft::server {

using proto::Role;

TEST_CASE("a viewer cannot hold so much that others find nothing; an operator holds beside it") {
  TestRoom t(true, {{"cloth.rows", "20"}, {"cloth.columns", "20"}});
  const Grant leads{Role::operator_, HandRight::by_policy, "", true};
  t.room->take({1, 0, Join{false, leads}});
  t.room->take({2, 0, Join{false, Grant{Role::viewer, HandRight::by_policy, "", true}}});
  const auto wide =
      t.say(2, R"({"op":"drag","phase":"start","id":2,"drag":0,"particle":210,"radius":100})");
  CHECK(wide["code"] == "held");
  CHECK(wide["field"] == "radius");
  CHECK(wide["value"] == 100);
  CHECK(t.room->world().grabs().list.empty());
  CHECK(t.say(2, R"({"op":"drag","phase":"start","id":3,"drag":0,"particle":210})")["op"] ==
        "result");
  CHECK(
      t.say(1,
            R"({"op":"drag","phase":"start","id":4,"drag":0,"particle":210,"radius":100})")["op"] ==
      "result");
}

TEST_CASE("the pins of a viewer together leave others three quarters, and what others hold") {
  TestRoom t(true, {{"cloth.rows", "20"}, {"cloth.columns", "20"}});
  const Grant leads{Role::operator_, HandRight::by_policy, "", true};
  t.room->take({1, 0, Join{false, leads}});
  for (const proto::ViewerId viewer : {2U, 3U})
    t.room->take({viewer, 0, Join{false, Grant{Role::viewer, HandRight::by_policy, "", true}}});
  const std::size_t pins = t.room->world().pins().list.size();
  const auto wide = t.say(2, R"({"op":"pin","id":2,"particle":210,"radius":100})");
  CHECK(wide["code"] == "held");
  CHECK(wide["field"] == "radius");
  CHECK(t.room->world().pins().list.size() == pins);
  const auto pin = [&](proto::ViewerId viewer, int particle) {
    const nlohmann::json text = {
        {"op", "pin"}, {"id", 100 + particle}, {"particle", particle}, {"radius", 0.05}};
    return t.say(viewer, text.dump());
  };
  std::size_t pinned = 0;
  nlohmann::json answer;
  for (int particle = 0; particle < 200; particle += 3) {
    answer = pin(2, particle);
    if (answer["op"] == "error") break;
    pinned += answer["count"].get<std::size_t>();
  }
  CHECK(answer["code"] == "held");
  CHECK(pinned <= 100);
  CHECK(pinned > 64);
  CHECK(pin(3, 294)["op"] == "result");
  // What another holds it may not pin; an operator by its token may both.
  CHECK(t.say(2, R"({"op":"drag","phase":"start","id":7,"drag":0,"particle":210})")["op"] ==
        "result");
  const char* const held = R"({"op":"pin","id":8,"particle":210})";
  CHECK(t.say(3, held)["code"] == "held");
  CHECK(t.say(1, held)["op"] == "result");
  CHECK(t.say(1, R"({"op":"pin","id":9,"particle":210,"radius":100})")["op"] == "result");
}

}  // namespace weft::server
