// What a viewer may do, over every command that there is, and who may hold the cloth.

#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "server/net/tokens.h"
#include "server/options.h"
#include "tests/server/halting_room.h"

namespace weft::server {
namespace {

using nlohmann::json;
using proto::Role;

constexpr proto::ViewerId kOperator = 1, kLooker = 2;

/// One of each form of each command that a client may send, as it is by default.
template <std::size_t... K>
std::vector<proto::Command> every_form(std::index_sequence<K...>) {
  std::vector<proto::Command> list;
  const auto add = [&list]<class Form>(std::type_identity<Form>) {
    if constexpr (!std::is_same_v<Form, proto::Halt>) list.emplace_back(Form{});
  };
  (add(std::type_identity<std::variant_alternative_t<K, proto::Command>>{}), ...);
  return list;
}
std::vector<proto::Command> every_form() {
  return every_form(std::make_index_sequence<std::variant_size_v<proto::Command>>{});
}

/// The commands that need more than their op alone.
std::vector<proto::Command> further_forms() {
  std::vector<proto::Command> list;
  for (const auto what : {proto::QueryWhat::contacts, proto::QueryWhat::reactions,
                          proto::QueryWhat::crossings, proto::QueryWhat::balance}) {
    proto::Query query;
    query.what = what;
    list.emplace_back(query);
  }
  proto::View view;
  view.forces = true;
  list.emplace_back(view);
  return list;
}

/// A room with an operator and a viewer that may only look, a hand and a pin of the operator's.
struct Shared {
  TestRoom t{true};

  Shared() {
    t.join(kOperator);
    t.room->take({kLooker, 0, Join{false, {Role::viewer, HandRight::by_policy, "", true}}});
    t.say(kOperator, R"({"op":"drag","phase":"start","drag":0,"particle":38})");
    t.say(kOperator, R"({"op":"pin","particle":20})");
    t.say(kOperator, R"({"op":"policy","policy":"watch"})");
  }

  /// All of the room that a viewer could change.
  std::string everything() {
    std::string all = hash_of(*t.room);
    for (const char* what : {"state", "pins", "grabs", "colliders"})
      all +=
          t.say(kOperator, std::string(R"({"op":"query","id":999,"what":")") + what + "\"}").dump();
    json people = t.say(kOperator, R"({"op":"query","id":999,"what":"roster"})")["data"];
    for (json& person : people)
      if (person["id"] == kLooker)
        person = {person["role"], person["hand"]};  // the rest is its own
    return all + people.dump() + std::to_string(t.room->paused());
  }

  /// Hands over a command of the looker; null or the error.
  json send(const proto::Command& command) {
    t.room->take({kLooker, ++t.number, proto::Request{proto::Id(7), command}});
    while (t.room->advancing()) t.room->advance_until(t.clock.now + 1);
    t.clock.now += 1;
    t.room->finish_turn();
    const json error = t.output.last("error", 7);
    return error;
  }
};

}  // namespace

TEST_CASE("a viewer that may only look is refused every command but looks, and changes nothing") {
  const std::vector<proto::Command> forms = every_form();
  REQUIRE(forms.size() >= 28);
  for (const proto::Command& form : forms) {
    CAPTURE(proto::encode_request({std::nullopt, form}));
    Shared room;
    const std::string before = room.everything();
    const json error = room.send(form);
    if (proto::right_to(form) == proto::Right::look) {
      CHECK((error.is_null() || error["code"] != "not_allowed"));
    } else {
      REQUIRE(error.is_object());
      CHECK(error["code"] == "not_allowed");
      CHECK(error["field"] == "op");
      CHECK(error["value"] == proto::name_of(form));
      CHECK_FALSE(error["limit"]["allowed"].empty());
      CHECK_FALSE(error["hint"].get<std::string>().empty());
    }
    CHECK(room.everything() == before);
  }
  for (const proto::Command& form : further_forms()) {
    Shared room;
    CHECK(room.send(form)["code"] == "not_allowed");
  }
}

TEST_CASE("a viewer with a hand is refused what operators do, and nothing is refused to these") {
  for (const proto::Command& form : every_form()) {
    CAPTURE(proto::encode_request({std::nullopt, form}));
    CHECK_FALSE(check_right(form, Role::operator_, true));
    CHECK_FALSE(check_right(form, Role::admin, true));
    const bool refused = check_right(form, Role::viewer, true).has_value();
    CHECK(refused == (proto::right_to(form) == proto::Right::operate));
  }
}

TEST_CASE("no text of any bytes lets a viewer that may only look change something") {
  std::mt19937 random(20261125);
  Shared room;
  const std::string before = room.everything();
  int read = 0;
  for (const proto::Command& form : every_form()) {
    const std::string whole = proto::encode_request({proto::Id(7), form});
    for (int round = 0; round < 60; ++round) {
      std::string text = whole;
      for (std::size_t changes = random() % 3; changes > 0; --changes)
        text[random() % text.size()] = static_cast<char>(random() % 256);
      const auto request = proto::parse_request(text);
      if (!request) continue;
      ++read;
      room.send(request->command);
    }
  }
  CHECK(read > 300);
  CHECK(room.everything() == before);
}

TEST_CASE("the policy says who holds, and hands that it forbids let go, the oldest last") {
  TestRoom t(true);
  t.join(1);
  t.room->take({2, 0, Join{false, Grant{Role::viewer, HandRight::by_policy, "", true}}});
  int id = 0;
  const auto start = [&](proto::ViewerId viewer, int drag, int particle) {
    return t.say(viewer, R"({"op":"drag","phase":"start","id":)" + std::to_string(++id) +
                             R"(,"drag":)" + std::to_string(drag) + R"(,"particle":)" +
                             std::to_string(particle) + "}");
  };
  CHECK(start(2, 0, 38)["op"] == "result");
  CHECK(start(2, 1, 30)["op"] == "result");
  CHECK(start(1, 0, 22)["op"] == "result");
  t.say(1, R"({"op":"policy","policy":"one_hand"})");
  CHECK(t.output.last("state")["policy"] == "one_hand");
  CHECK(t.output.last("notice")["code"] == "policy");
  json grabs = t.output.last("grabs")["grabs"];
  REQUIRE(grabs.size() == 2);
  CHECK((grabs[0]["viewer"] == 2 && grabs[0]["drag"] == 0));
  CHECK(start(2, 3, 31)["code"] == "too_many");
  t.say(1, R"({"op":"policy","policy":"watch"})");
  grabs = t.output.last("grabs")["grabs"];
  REQUIRE(grabs.size() == 1);  // of the one that has something to show
  CHECK(grabs[0]["viewer"] == 1);
  CHECK(start(2, 0, 38)["limit"] == json{{"allowed", {"hand"}}});
  const json roster = t.output.last("roster")["viewers"];
  CHECK((roster[0]["hand"] == true && roster[1]["hand"] == false));
  t.say(1, R"({"op":"give_hand","viewer":2})");
  CHECK(start(2, 0, 38)["op"] == "result");
  t.say(1, R"({"op":"give_hand","viewer":2,"given":false})");
  CHECK(start(2, 1, 30)["code"] == "not_allowed");
  t.say(1, R"({"op":"policy","policy":"everybody"})");
  CHECK(start(2, 0, 38)["op"] == "result");
}

TEST_CASE(
    "a muted viewer lets go and holds no more, whatever the policy, until it is given a hand") {
  Shared room;
  TestRoom& t = room.t;
  int id = 100;
  const auto start = [&] {
    return t.say(kLooker, R"({"op":"drag","phase":"start","drag":4,"particle":30,"id":)" +
                              std::to_string(++id) + "}");
  };
  t.say(kOperator, R"({"op":"policy","policy":"everybody"})");
  CHECK(start()["op"] == "result");
  t.say(kOperator, R"({"op":"mute","viewer":2})");
  CHECK(t.output.last("grabs")["grabs"].size() == 1);
  t.say(kOperator, R"({"op":"policy","policy":"one_hand"})");
  CHECK(start()["code"] == "not_allowed");
  t.room->take({kLooker, ++t.number, Grant{Role::viewer, HandRight::by_policy, "", true}});
  CHECK(start()["code"] == "not_allowed");  // telling its token again is no way out
  t.say(kOperator, R"({"op":"mute","viewer":2,"muted":false})");
  CHECK(start()["op"] == "result");
  CHECK(t.say(kOperator, R"({"op":"mute","id":6,"viewer":77})")["code"] == "unknown_viewer");
}

TEST_CASE("an operator cannot mute an admin") {
  TestRoom t(true);
  t.join(1);
  t.room->take({2, 0, Join{false, Grant{Role::admin, HandRight::by_policy, "", true}}});
  CHECK(t.say(1, R"({"op":"mute","id":6,"viewer":2})")["code"] == "not_allowed");
  CHECK(t.say(2, R"({"op":"mute","id":7,"viewer":1})")["op"] == "result");
}

TEST_CASE("a viewer moves and releases its own pins alone, an operator all") {
  Shared room;
  TestRoom& t = room.t;
  t.say(kOperator, R"({"op":"policy","policy":"everybody"})");
  const std::uint32_t other = t.output.last("pins")["pins"].back()["id"];
  const json own = t.say(kLooker, R"({"op":"pin","id":5,"particle":33})");
  const auto with = [](const char* text, std::uint32_t pin) {
    return std::string(text) + std::to_string(pin) + "}";
  };
  const json refused = t.say(kLooker, with(R"({"op":"release","id":6,"pin":)", other));
  CHECK(refused["code"] == "not_allowed");
  CHECK(refused["field"] == "pin");
  CHECK(refused["value"] == other);
  CHECK(t.say(kLooker, R"({"op":"release","id":7,"particle":20})")["code"] == "not_allowed");
  CHECK(t.say(kLooker, with(R"({"op":"move","id":8,"position":[0,1,0],"pin":)", other))["code"] ==
        "not_allowed");
  CHECK(t.say(kLooker, with(R"({"op":"move","id":9,"stop":true,"pin":)", other))["code"] ==
        "not_allowed");
  CHECK(t.say(kLooker, with(R"({"op":"release","id":10,"pin":)", own["pin"]))["op"] == "result");
  CHECK(t.say(kOperator, with(R"({"op":"release","id":11,"pin":)", other))["op"] == "result");
}

TEST_CASE("the fourth to come by a link looks until it is given a hand or an operator decides") {
  for (const bool tokens : {true, false}) {
    RoomOptions options;
    options.linked = true;
    options.has_tokens = tokens;
    TestRoom t(true, {}, options);
    const auto role = [&](proto::ViewerId viewer) {
      return tokens && viewer > 1 ? Role::viewer : Role::operator_;
    };
    for (const proto::ViewerId viewer : {1U, 2U, 3U, 4U, 5U})
      t.room->take({viewer, 0, Join{false, {role(viewer), HandRight::by_policy, "", tokens}}});
    const auto hands = [&] {
      const json people = t.say(1, R"({"op":"query","id":9,"what":"roster"})")["data"];
      std::vector<bool> list;
      for (const json& person : people) list.push_back(person["hand"]);
      return list;
    };
    CHECK(hands() == std::vector<bool>{true, true, true, false, false});
    CHECK(t.say(5, R"({"op":"reset","id":4})")["code"] == "not_allowed");
    t.say(1, R"({"op":"give_hand","viewer":4})");
    CHECK(hands() == std::vector<bool>{true, true, true, true, false});
    t.say(1, R"({"op":"policy","policy":"everybody"})");
    t.room->take({6, 0, Join{false, {role(6), HandRight::by_policy, "", tokens}}});
    CHECK(hands() == std::vector<bool>(6, true));
  }
}

TEST_CASE("a token that is told again neither gives a hand nor takes the one that was given") {
  RoomOptions options;
  options.linked = options.has_tokens = true;
  TestRoom t(true, {}, options);
  const auto looker = [](std::uint64_t token) {
    return Grant{Role::viewer, HandRight::by_policy, "", true, "", token};
  };
  t.join(1);
  for (const proto::ViewerId viewer : {2U, 3U, 4U})
    t.room->take({viewer, 0, Join{false, looker(7)}});
  int id = 0;
  const auto start = [&] {
    return t.say(4, R"({"op":"drag","phase":"start","drag":0,"particle":30,"id":)" +
                        std::to_string(++id) + "}");
  };
  const auto tell = [&t](const Grant& grant) { t.room->take({4, ++t.number, grant}); };
  tell(looker(7));
  CHECK(start()["code"] == "not_allowed");
  tell(looker(8));  // nor does another that grants no more
  CHECK(start()["code"] == "not_allowed");
  t.say(1, R"({"op":"policy","policy":"watch"})");
  t.say(1, R"({"op":"give_hand","viewer":4})");
  tell(looker(8));
  CHECK(start()["op"] == "result");
  tell(looker(9));  // another token counts as it is
  CHECK(start()["code"] == "not_allowed");
}

TEST_CASE("a room without tokens is never without an operator") {
  RoomOptions options;
  options.linked = true;
  TestRoom t(true, {}, options);
  for (const proto::ViewerId viewer : {1U, 2U, 3U, 4U, 5U}) t.join(viewer);
  for (const proto::ViewerId viewer : {1U, 2U, 3U}) t.leave(viewer);
  CHECK(t.say(4, R"({"op":"reset","id":4})")["op"] == "result");
  CHECK(t.say(5, R"({"op":"reset","id":5})")["code"] == "not_allowed");
}

TEST_CASE("what a policy lets go is in the log: replaying it leads to the same hash") {
  TestRoom t(false);
  t.join(1);
  t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":38,"target":[0.3,1,0.4]})");
  t.say(1, R"({"op":"drag","phase":"start","drag":2,"particle":24,"target":[0.1,1.2,0.4]})");
  t.tick(10);
  t.say(1, R"({"op":"policy","policy":"one_hand"})");
  t.tick(10);
  t.say(1, R"({"op":"mute","viewer":1})");
  t.tick(20);
  std::vector<CommandOrigin> let_go;
  for (const LogEntry& entry : t.room->log().entries())
    if (std::holds_alternative<proto::DragEnd>(entry.command)) let_go.push_back(entry.origin);
  CHECK(let_go == std::vector{CommandOrigin::policy, CommandOrigin::policy});
  CHECK(replayed(*t.room, t.room->world().tick(), nullptr) == hash_of(*t.room));
}

TEST_CASE("viewers that may only look take a quarter of the room's time together at most") {
  double cpu = 0;
  RoomOptions options;
  options.cpu_clock = [&] { return cpu += 0.001; };  // so much each command takes
  TestRoom t(true, {}, options);
  t.join(1);
  const Grant looks{Role::viewer, HandRight::muted, "", true};
  for (const proto::ViewerId viewer : {2U, 3U, 4U}) t.room->take({viewer, 0, Join{false, looks}});
  int done = 0;
  t.room->on_finished = [&](proto::ViewerId) { ++done; };
  for (int k = 0; k < 300; ++k)
    for (const proto::ViewerId viewer : {2U, 3U, 4U}) t.tell(viewer, R"({"op":"hash"})");
  done = 0;
  for (int turn = 0; turn < 400; ++turn) {
    t.clock.now += 0.001;
    t.room->finish_turn();
  }
  CHECK(done >= 80);
  CHECK(done <= 0.25 / 0.001 * 0.4 + 40);
  t.tell(1, R"({"op":"hash","id":3})");  // and an operator does not wait for them
  CHECK(t.output.last("result", 3).is_object());
}

TEST_CASE("a viewer that is no operator changes its name once a second") {
  Shared room;
  TestRoom& t = room.t;
  CHECK(t.say(kLooker, R"({"op":"hello","id":5,"name":"a"})")["op"] == "result");
  CHECK(t.say(kLooker, R"({"op":"hello","id":6,"name":"a"})")["op"] == "result");
  CHECK(t.say(kLooker, R"({"op":"hello","id":7,"name":"b"})")["code"] == "rate_limited");
  t.clock.now += 1;
  CHECK(t.say(kLooker, R"({"op":"hello","id":8,"name":"b"})")["op"] == "result");
}

TEST_CASE("tokens grant what their line says, and lines that are wrong are refused by number") {
  Tokens tokens;
  CHECK_FALSE(tokens.required());
  tokens.read("--tokens",
              "# who may what\n\nviewer 0123456789abcdef Class 7b \r\n"
              "operator ABCDEFGHIJKLMNOP\nadmin a~b.c-d_e~f.g-h_ Ada\n");
  CHECK(tokens.required());
  CHECK(tokens.find("0123456789abcdef", "default") ==
        Grant{Role::viewer, HandRight::by_policy, "Class 7b", true, "", 1, "token 1"});
  CHECK(tokens.find("ABCDEFGHIJKLMNOP", "ada")->role == Role::operator_);
  CHECK(tokens.find("a~b.c-d_e~f.g-h_", "default")->role == Role::admin);
  for (const char* wrong : {"", "0", "0123456789abcde", "0123456789abcdef0", "0123456789abcdeF",
                            "0123456789abcdef0123456789abcdef"})
    CHECK_FALSE(tokens.find(wrong, "default"));
  for (const std::string line :
       {"owner 0123456789abcdef", "viewer", "viewer 0123456789", "viewer 0123456789abcd/f",
        "operator 0123456789abcdef\nviewer 0123456789abcdef",
        "viewer 0123456789abcdef a name of more than thirty-two characters"}) {
    CAPTURE(line);
    Tokens none;
    try {
      none.read("--tokens", "# first\n" + line);
      FAIL("it was taken");
    } catch (const OptionError& error) {
      const std::string what = error.what();
      CHECK(what.find(line.find('\n') == std::string::npos ? "line 2" : "line 3") !=
            std::string::npos);
      CHECK(what.find("0123456789") == std::string::npos);
    }
  }
  CHECK_THROWS_AS(Tokens().read("--tokens", "# nothing\n"), OptionError);
}

TEST_CASE("an operator by its token holds under every policy, also after it has come back") {
  TestRoom t(true);
  const Grant leads{Role::operator_, HandRight::by_policy, "Teacher", true, "", 7};
  t.room->take({1, 0, Join{false, leads}});
  t.room->take({2, 0, Join{false, Grant{Role::viewer, HandRight::by_policy, "", true}}});
  t.say(1, R"({"op":"policy","policy":"watch"})");
  t.room->take({1, 0, Leave{}});
  t.room->take({3, 0, Join{false, leads}});
  const char* const start = R"({"op":"drag","phase":"start","id":1,"drag":0,"particle":30})";
  CHECK(t.say(2, start)["code"] == "not_allowed");
  CHECK(t.say(3, start)["op"] == "result");
  CHECK(t.output.last("roster")["viewers"][1]["hand"] == true);
}

}  // namespace weft::server
