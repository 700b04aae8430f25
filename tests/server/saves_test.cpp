#include <catch2/catch.hpp>

#include "server/constants.h"
#include "tests/server/fakes.h"

// States that a room keeps to go back to.

namespace weft::server {
namespace {

std::string name_text(const char* op, const std::string& name, int id) {
  return proto::encode_request({id, std::string_view(op) == "save"
                                        ? proto::Command(proto::Save{name})
                                        : proto::Command(proto::Restore{name})});
}

TEST_CASE("a restored state has the same future, bit for bit, as often as it is restored") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"advance","n":10,"id":1})");
  t.say(1, R"({"op":"set","wind":[1,0,2]})");
  t.say(1, R"({"op":"pin","particle":20})");
  const auto saved = t.say(1, name_text("save", "a", 2));
  CHECK(saved["tick"] == 10);
  const auto wanted = t.say(1, R"({"op":"advance","n":30,"id":3})");
  for (int round = 0; round < 2; ++round) {
    t.say(1, R"({"op":"set","wind":[5,0,0]})");
    t.say(1, R"({"op":"release","all":true})");
    t.say(1, R"({"op":"advance","n":7,"id":4})");
    const auto restored = t.say(1, name_text("restore", "a", 5));
    CHECK(restored["op"] == "result");
    CHECK(restored["tick"] == 10);
    CHECK(t.say(1, R"({"op":"advance","n":30,"id":6})")["hash"] == wanted["hash"]);
  }
}

TEST_CASE("a save holds no viewer's hand, restoring lets go of those there are and tells all") {
  TestRoom t;
  t.join(1);
  t.join(2);
  t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":20})");
  t.say(1, name_text("save", "held", 1));
  t.say(2, R"({"op":"drag","phase":"start","drag":1,"particle":30})");
  t.say(2, name_text("restore", "held", 2));
  CHECK(t.room->world().grabs().list.empty());
  CHECK(t.output.last("grabs")["grabs"].empty());
  CHECK(t.output.last("notice")["code"] == "restored");
  CHECK(t.output.last("notice")["viewer"] == 2);
  CHECK(t.say(1, R"({"op":"drag","phase":"start","drag":1,"particle":30,"id":3})")["op"] ==
        "result");
}

TEST_CASE("a state that would cost more than all rooms may is not restored, and nothing changes") {
  OneOtherRoom others;
  RoomOptions options;
  options.others = &others;
  TestRoom t(true, {}, options);
  t.join(1);
  t.say(1, name_text("save", "dear", 1));
  t.say(1, R"({"op":"advance","n":3,"id":2})");
  const auto before = t.say(1, R"({"op":"hash","id":3})");
  others.most_updates = 1;
  CHECK(t.say(1, name_text("restore", "dear", 4))["code"] == "too_costly");
  CHECK(t.say(1, R"({"op":"hash","id":5})")["hash"] == before["hash"]);
  others.most_updates = 1e18;
  CHECK(t.say(1, name_text("restore", "dear", 6))["tick"] == 0);
}

TEST_CASE("a name that nothing was saved under is refused with those that there are") {
  TestRoom t;
  t.join(1);
  const auto none = t.say(1, name_text("restore", "b", 7));
  CHECK(none["code"] == "unknown_save");
  CHECK(none["message"] == "name must be one of those that are there; there are none");
  CHECK_FALSE(none.contains("limit"));
  t.say(1, name_text("save", "a", 1));
  const auto refused = t.say(1, name_text("restore", "b", 2));
  CHECK(refused["code"] == "unknown_save");
  CHECK(refused["field"] == "name");
  CHECK(refused["limit"]["allowed"] == nlohmann::json({"a"}));
}

TEST_CASE("a room keeps a bounded number of states, in place of earlier ones, of one scene") {
  TestRoom t;
  t.join(1);
  for (std::size_t k = 0; k < kMostSaves; ++k)
    CHECK(t.say(1, name_text("save", 's' + std::to_string(k), 1))["op"] == "result");
  const auto refused = t.say(1, name_text("save", "one-more", 2));
  CHECK(refused["code"] == "too_many");
  CHECK(refused["limit"]["maximum"] == kMostSaves);
  CHECK(refused["hint"] == "save in place of one, under its name");
  CHECK(t.say(1, name_text("save", "s0", 3))["op"] == "result");
  t.say(1, R"({"op":"load","scene":"other","id":4})");
  CHECK(t.say(1, name_text("restore", "s0", 5))["code"] == "unknown_save");
}

TEST_CASE("saves and restores are in the log, so that its replay ends alike") {
  TestRoom t, again;
  t.join(1);
  again.join(1);
  t.say(1, R"({"op":"advance","n":5,"id":1})");
  t.say(1, name_text("save", "a", 2));
  t.say(1, R"({"op":"advance","n":9,"id":3})");
  t.say(1, name_text("restore", "a", 4));
  t.say(1, R"({"op":"advance","n":3,"id":5})");
  for (const LogEntry& entry : t.room->log().entries())
    again.say(1, proto::encode_request({std::nullopt, entry.command}));
  CHECK(again.room->world().tick() == 8);
  CHECK(again.room->world().hash() == t.room->world().hash());
}

TEST_CASE("a restored pin belongs to the viewer that set it") {
  TestRoom t(true);
  t.join(1);
  t.room->take({2, 0, Join{false, Grant{proto::Role::viewer, HandRight::by_policy, "", true}}});
  const auto pin = t.say(2, R"({"op":"pin","id":1,"particle":33})");
  t.say(1, name_text("save", "a", 2));
  t.say(1, R"({"op":"release","all":true})");
  t.say(1, name_text("restore", "a", 3));
  CHECK(t.output.last("pins")["pins"].back()["viewer"] == 2);
  CHECK(t.say(2, R"({"op":"release","id":4,"pin":)" + std::to_string(pin["pin"].get<int>()) +
                     "}")["op"] == "result");
}

}  // namespace
}  // namespace weft::server
