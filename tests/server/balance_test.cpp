#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "tests/server/fakes.h"

// Where the cloth's energy came from and went, as a room tells it.

namespace weft::server {
namespace {

using nlohmann::json;

constexpr const char* kBalance = R"({"op":"query","id":9,"what":"balance"})";

double sum_of(const json& parts) {
  double sum = 0;
  for (const json& part : parts) sum += part.get<double>();
  return sum;
}

json balance_of(TestRoom& t, proto::ViewerId viewer = 1) {
  return t.say(viewer, kBalance)["data"];
}

void advance(TestRoom& t, int ticks) {
  t.say(1, json{{"op", "advance"}, {"id", 8}, {"n", ticks}}.dump());
}

TEST_CASE(
    "what a hand brings is the height that the cloth gains, and the sums are the energy now") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"set","drag":20})");
  advance(t, 300);  // hangs at rest
  const json before = balance_of(t);
  CHECK(before["since"] == 300);
  CHECK(sum_of(before["work"]) == 0);
  CHECK(sum_of(before["losses"]) == 0);
  t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":38})");
  const Vec3d from = t.room->world().grabs().list[0].target.cast<double>(), to(0, 1, 0.2);
  for (int step = 1; step <= 50; ++step) {
    const Vec3d at = from + (to - from) * (step / 50.0);
    t.say(1, json{{"op", "drag"}, {"phase", "move"}, {"drag", 1}, {"target", {at[0], at[1], at[2]}}}
                 .dump());
    advance(t, 10);
  }
  const json after = balance_of(t);
  CHECK(after["since"] == 300);
  const double start = after["start"], now = after["now"], hands = after["work"]["hands"];
  CHECK(start == Approx(before["now"].get<double>()));
  CHECK(now ==
        Approx(
            t.say(1, R"({"op":"query","id":7,"what":"energies"})")["data"]["total"].get<double>()));
  CHECK(start + sum_of(after["work"]) - sum_of(after["losses"]) == Approx(now).margin(1e-9));
  REQUIRE(now - start > 0.02);
  CHECK(sum_of(after["work"]) == Approx(hands).epsilon(0.01));
  CHECK(hands > now - start);
  CHECK(std::abs(after["losses"]["solver"].get<double>()) < 0.01 * hands);
  CHECK(t.output.last("state")["balance"]["since"] == 300);
}

TEST_CASE("measuring the balance changes no bit, and ends with the last viewer that asked") {
  TestRoom measured, plain;
  for (TestRoom* t : {&measured, &plain}) {
    t->join(1);
    t->join(2);
    t->say(1, R"({"op":"set","wind":[3,0,2],"gust_speed":1})");
  }
  CHECK(plain.output.last("state")["balance"].is_null());
  balance_of(measured, 2);
  advance(measured, 60);
  advance(plain, 60);
  CHECK(measured.room->world().hash() == plain.room->world().hash());
  REQUIRE(measured.room->world().energy_balance());
  CHECK_FALSE(plain.room->world().energy_balance());
  measured.leave(2);
  advance(measured, 1);
  CHECK_FALSE(measured.room->world().energy_balance());
}

TEST_CASE("the balance begins anew where the state is replaced") {
  TestRoom t;
  t.join(1);
  advance(t, 10);
  t.say(1, R"({"op":"save","name":"a"})");
  advance(t, 10);
  balance_of(t);
  advance(t, 5);
  t.say(1, R"({"op":"restore","name":"a"})");
  CHECK(balance_of(t)["since"] == 10);
  t.say(1, R"({"op":"reset"})");
  CHECK(balance_of(t)["since"] == 0);
  t.say(1, R"({"op":"load","scene":"other"})");
  advance(t, 3);
  const json loaded = balance_of(t);
  CHECK(loaded["since"] == 0);
  CHECK(loaded["start"].get<double>() + sum_of(loaded["work"]) - sum_of(loaded["losses"]) ==
        Approx(loaded["now"].get<double>()).margin(1e-9));
}

}  // namespace
}  // namespace weft::server
