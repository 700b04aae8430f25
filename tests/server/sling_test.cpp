#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

namespace weft::server {
namespace {

using nlohmann::json;

TEST_CASE("a sling is fired by its end, and by nothing else that lets go") {
  TestRoom t(false);
  t.join(1);
  const char* start =
      R"({"op":"drag","phase":"start","particle":38,"target":[0,5,0],"mode":"sling"})";
  const auto impulses = [&t] { return t.room->world().grabs().impulses.size(); };
  t.say(1, start);
  t.tick(1);
  CHECK(t.output.last("grabs")["grabs"][0]["mode"] == "sling");
  CHECK(t.output.last("grabs")["grabs"][0]["stiffness"] == 20);
  const json kept = t.say(1, R"({"op":"drag","id":1,"phase":"end","fire":false})");
  CHECK(!kept.contains("impulse"));
  t.say(1, start);
  t.tick(125);  // its lease ends
  CHECK(t.room->world().grabs().list.empty());
  CHECK(impulses() == 0);
  t.say(1, start);
  const json fired = t.say(1, R"({"op":"drag","id":2,"phase":"end"})");
  CHECK(fired["impulse"][1].get<double>() > 1);
  CHECK(impulses() == 1);
  t.join(2);
  t.say(2, start);
  t.leave(2);
  CHECK(impulses() == 1);
}

}  // namespace
}  // namespace weft::server
