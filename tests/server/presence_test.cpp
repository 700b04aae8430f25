// Where viewers point and look: what is told of it, how often, and that it is no part of the
// history.

#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "server/constants.h"
#include "tests/server/fakes.h"

namespace weft::server {
namespace {

using nlohmann::json;
using proto::Role;

std::string cursor_at(double x) {
  return R"({"op":"presence","cursor":[)" + std::to_string(x) + ",1,0]}";
}
constexpr const char* kCamera =
    R"({"op":"presence","camera":{"position":[0,1,3],"target":[0,1,0]}})";

/// A room of so many viewers, of which the first is an operator.
struct Crowd {
  TestRoom t{true};
  explicit Crowd(unsigned viewers) {
    for (proto::ViewerId viewer = 1; viewer <= viewers; ++viewer)
      t.room->take(
          {viewer, 0,
           Join{false,
                {viewer == 1 ? Role::operator_ : Role::viewer, HandRight::by_policy, "", true}}});
    pass(1);
    t.output.sent.clear();
  }
  /// Lets time pass in turns of a sixtieth of a second.
  void pass(double seconds) {
    for (double end = t.clock.now + seconds; t.clock.now < end;) {
      t.clock.now += 1.0 / 60;
      t.room->finish_turn();
    }
  }
  /// What was told of each viewer since the last call, in order.
  std::vector<json> told() {
    std::vector<json> list;
    for (const auto& [to, text] : t.output.sent) {
      const json message = json::parse(text);
      if (message["op"] == "presence")
        for (const json& one : message["viewers"]) list.push_back(one);
    }
    t.output.sent.clear();
    return list;
  }
  std::size_t bytes_told() const {
    std::size_t bytes = 0;
    for (const auto& [to, text] : t.output.sent)
      if (json::parse(text)["op"] == "presence") bytes += text.size();
    return bytes;
  }
};

}  // namespace

TEST_CASE("a cursor is told as it is now, at most ten times a second, and when it goes") {
  Crowd crowd(2);
  for (int k = 0; k < 60; ++k) {
    crowd.t.tell(2, cursor_at(k));
    crowd.pass(1.0 / 60);
  }
  crowd.pass(0.2);
  const std::vector<json> told = crowd.told();
  CHECK(told.size() <= 12);
  CHECK(told.size() >= 8);
  CHECK(told.back() == json{{"viewer", 2}, {"cursor", {59, 1, 0}}});
  crowd.pass(2);
  CHECK(crowd.told().empty());  // what stays is not told again
  crowd.t.tell(2, R"({"op":"presence","away":true})");
  crowd.pass(0.2);
  CHECK(crowd.told() == std::vector<json>{{{"viewer", 2}, {"away", true}}});
}

TEST_CASE(
    "thirty hands that move cost each viewer 4 kB a second at most, and all are told in turn") {
  Crowd crowd(30);
  for (int k = 0; k < 300; ++k) {
    for (unsigned viewer = 1; viewer <= 30; ++viewer)
      crowd.t.tell(viewer, cursor_at(0.01 * k + viewer));
    crowd.pass(1.0 / 60);
  }
  CHECK(static_cast<double>(crowd.bytes_told()) <= 5 * kPresenceRate + 1000);
  std::map<int, int> times;
  for (const json& one : crowd.told()) ++times[one["viewer"].get<int>()];
  REQUIRE(times.size() == 30);
  for (const auto& [viewer, count] : times) CHECK(count >= 5);
}

TEST_CASE("a camera is told to none until it is followed, and then before all cursors") {
  Crowd crowd(30);
  crowd.t.tell(7, kCamera);
  crowd.pass(0.3);
  CHECK(crowd.told().empty());
  crowd.t.say(3, R"({"op":"follow","viewer":7,"id":4})");
  crowd.pass(0.3);
  std::vector<json> told = crowd.told();
  REQUIRE(told.size() == 2);
  CHECK(told[0]["viewer"] == 7);
  CHECK(told[0]["camera"]["position"] == json{0, 1, 3});
  CHECK(told[1] == json{{"viewer", 3}, {"follows", 7}});
  for (unsigned viewer = 8; viewer <= 30; ++viewer) crowd.t.tell(viewer, cursor_at(viewer));
  crowd.t.tell(7, R"({"op":"camera","position":[1,1,3],"target":[0,1,0]})");
  crowd.pass(1);
  told = crowd.told();
  CHECK(told[0]["camera"]["position"] == json{1, 1, 3});
  crowd.t.leave(7);
  crowd.pass(0.3);
  CHECK(crowd.told() == std::vector<json>{{{"viewer", 3}, {"follows", 0}}});
  CHECK(crowd.t.say(3, R"({"op":"follow","viewer":7,"id":5})")["code"] == "unknown_viewer");
}

TEST_CASE("an operator brings all to its camera, and none that has left it a second time") {
  Crowd crowd(4);
  crowd.t.tell(1, kCamera);
  CHECK(crowd.t.say(2, R"({"op":"lead","id":3})")["code"] == "not_allowed");
  crowd.t.say(1, R"({"op":"lead"})");
  crowd.pass(0.3);
  const auto followers = [&] {
    std::map<int, int> list;
    for (const json& one : crowd.told())
      if (one.contains("follows")) list[one["viewer"].get<int>()] = one["follows"].get<int>();
    return list;
  };
  CHECK(crowd.t.output.last("notice")["code"] == "lead");
  CHECK(followers() == std::map<int, int>{{2, 1}, {3, 1}, {4, 1}});
  crowd.t.say(3, R"({"op":"follow","viewer":0})");
  crowd.pass(0.3);
  CHECK(followers() == std::map<int, int>{{3, 0}});
  crowd.t.say(1, R"({"op":"lead"})");
  crowd.pass(0.3);
  CHECK(followers().empty());
  crowd.t.say(3, R"({"op":"follow","viewer":1})");  // by itself
  crowd.pass(0.3);
  CHECK(followers() == std::map<int, int>{{3, 1}});
  crowd.t.say(1, R"({"op":"lead","on":false})");
  crowd.pass(0.3);
  CHECK(followers() == std::map<int, int>{{2, 0}, {3, 0}, {4, 0}});
}

TEST_CASE("nothing that only looks enters the log") {
  Crowd crowd(2);
  for (const char* text :
       {R"({"op":"presence","away":true})", kCamera, R"({"op":"follow","viewer":1})",
        R"({"op":"camera","position":[1,1,3],"target":[0,1,0]})", R"({"op":"hello","name":"a"})",
        R"({"op":"query","what":"positions"})", R"({"op":"hash"})"})
    crowd.t.say(2, text);
  CHECK(crowd.t.room->log().entries().empty());
  crowd.t.say(1, R"({"op":"speed","speed":2})");
  CHECK(crowd.t.room->log().entries().size() == 1);
}

TEST_CASE("a link lets in whom it was made for, and only an admin makes operators by tokens") {
  RoomOptions options;
  options.has_tokens = options.linked = true;
  std::vector<Grant> made;
  options.make_token = [&made](const Grant& grant) {
    made.push_back(grant);
    return "token " + std::to_string(made.size());
  };
  TestRoom t(true, {}, options);
  t.room->take({1, 0, Join{false, Grant{Role::operator_, HandRight::by_policy, "", true}}});
  t.room->take({2, 0, Join{false, Grant{Role::admin, HandRight::by_policy, "", true}}});
  t.room->take({3, 0, Join{false, Grant{Role::viewer, HandRight::by_policy, "", true}}});
  CHECK(t.say(3, R"({"op":"invite","id":1,"right":"look"})")["code"] == "not_allowed");
  CHECK(t.say(1, R"({"op":"invite","id":2,"right":"operate"})")["code"] == "not_allowed");
  CHECK(made.empty());
  CHECK(t.say(1, R"({"op":"invite","id":3,"right":"look"})")["token"] == "token 1");
  t.say(1, R"({"op":"invite","id":4,"right":"hold"})");
  t.say(2, R"({"op":"invite","id":5,"right":"operate"})");
  REQUIRE(made.size() == 3);
  for (const Grant& grant : made) CHECK(grant.room == "default");
  for (proto::ViewerId viewer = 4; viewer <= 6; ++viewer)
    t.room->take({viewer, 0, Join{false, made[viewer - 4]}});
  const json people = t.say(1, R"({"op":"query","id":9,"what":"roster"})")["data"];
  CHECK((people[3]["role"] == "viewer" && people[3]["hand"] == false));
  CHECK((people[4]["role"] == "viewer" && people[4]["hand"] == true));
  CHECK(people[5]["role"] == "operator");
  t.say(1, R"({"op":"policy","policy":"everybody"})");
  CHECK(t.say(4, R"({"op":"pin","id":8,"particle":3})")["code"] == "not_allowed");
  t.say(1, R"({"op":"give_hand","viewer":4})");
  CHECK(t.say(4, R"({"op":"pin","id":8,"particle":3})")["op"] == "result");
}

}  // namespace weft::server
