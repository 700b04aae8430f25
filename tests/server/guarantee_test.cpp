#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/server/halting_room.h"

// What a room tells of its promise that nothing crosses, and of what it counts.

namespace weft::server {
namespace {

using nlohmann::json;

WorldDef scarf() {
  WorldDef def;
  ClothDef& cloth = def.cloths[0];
  cloth.name = "scarf";
  cloth.rows = cloth.columns = 9;
  cloth.width = cloth.height = 0.4;
  cloth.origin = Vec3d(-0.2, 0.5, -0.2);
  cloth.v = Vec3d::UnitZ();
  return def;
}

/// "post" and "bead": a box and a ball start through the cells of a coarse cloth.
/// "inside": a scarf starts inside a ball, and a block stands far off. "through": a scarf and
/// another pass through each other, and no contact of cloth with cloth keeps them apart.
/// "gathered": the scene throws its scarf through itself.
WorldDef bad_scene(const std::string& name) {
  WorldDef def = scarf();
  if (name == "gathered") {
    DisturbanceDef gather;
    gather.time = 0.05;
    gather.gather = 7;
    def.disturbances = {gather};
    return def;
  }
  if (name == "post" || name == "bead") {
    ClothDef& cloth = def.cloths[0];
    cloth.rows = cloth.columns = 4;
    cloth.width = cloth.height = 0.9;
    cloth.origin = Vec3d(-0.45, 0.5, -0.45);
    if (name == "post")
      def.colliders = {{name, BoxDef{Vec3d(0, 0.5, 0), Vec3d(0.05, 0.4, 0.05)}}};
    else
      def.colliders = {{name, SphereDef{Vec3d(0.01, 0.51, 0), 0.05}}};
    return def;
  }
  if (name == "inside") {
    def.colliders = {{"ball", SphereDef{Vec3d(0, 0.5, 0), 0.1}},
                     {"block", BoxDef{Vec3d(2, 0.5, 0), Vec3d(0.1, 0.1, 0.1)}}};
    return def;
  }
  def.cloths.push_back(def.cloths[0]);
  def.cloths[1].name = "other";
  def.cloths[1].origin = Vec3d(-0.21, 0.32, 0.013);
  def.cloths[1].v = Vec3d::UnitY();
  def.contact.seed.self = SelfContact::none;
  return def;
}

struct BadRoom : TestRoom {
  explicit BadRoom(const std::string& scene, std::uint32_t count_pause = 60,
                   WorkLimit* limit = nullptr) {
    RoomOptions options;
    options.limit = limit;
    options.scene = scene;
    options.scene_names = {"bead", "gathered", "inside", "post", "through"};
    options.paused = true;
    options.count_pause = count_pause;
    room = std::make_unique<Room>(options, bad_scene, output, clock.clock(), metrics);
  }

  /// Messages of all notices of this code so far, in order.
  std::vector<std::string> told(const std::string& code) const {
    std::vector<std::string> messages;
    for (const auto& [viewer, text] : output.sent) {
      const json message = json::parse(text);
      if (message.value("code", "") == code) messages.push_back(message["message"]);
    }
    return messages;
  }
  json guarantee() {
    return say(1, R"({"op":"query","id":99,"what":"state"})")["data"]["guarantee"];
  }
  void stand_still() {
    clock.now += 0.3;
    room->finish_turn();
  }
};

const json kHeld = json::parse(R"({"state":"held","covers":["objects","cloth"],"pairs":0,
                                   "reasons":[]})");

TEST_CASE("what the scene itself throws through itself is counted in that tick") {
  const std::uint32_t pause = GENERATE(0u, 60u);
  BadRoom t("gathered", pause);
  t.join(1);
  bool crossed = false;
  for (int tick = 1; tick <= 8; ++tick) {
    INFO("tick " << tick << ", pause " << pause);
    t.say(1, R"({"op":"advance","n":1})");
    const json state = t.say(1, R"({"op":"query","id":1,"what":"state"})")["data"];
    const json found = t.say(1, R"({"op":"query","id":2,"what":"crossings"})")["data"];
    if (found["count"] == 0) continue;
    crossed = true;
    CHECK(state["guarantee"]["state"] != "held");
  }
  CHECK(crossed);
}

TEST_CASE("who joins a room whose cloth starts inside an object is told so by the state") {
  BadRoom t("inside");
  t.join(1);
  const json at_start = t.output.last("state")["guarantee"];
  CHECK(at_start["state"] == "bad_start");
  CHECK(at_start["reasons"] == json{"scarf started inside ball"});
  CHECK(at_start["pairs"].get<int>() > 0);
  t.say(1, R"({"op":"advance","n":2})");
  t.join(2);
  CHECK(t.output.last("state")["guarantee"]["reasons"] == json{"scarf started inside ball"});
  CHECK(t.told("guarantee_void").size() == 1);
  t.say(1, R"({"op":"advance","n":150})");
  CHECK(t.told("guarantee_back").size() == 1);
  CHECK(t.guarantee() == kHeld);
}

TEST_CASE("a reset while cloth is inside an object gives no guarantee back, and tells it again") {
  BadRoom t("inside");
  t.join(1);
  t.say(1, R"({"op":"advance","n":2})");
  t.say(1, R"({"op":"reset"})");
  CHECK(t.told("guarantee_back").empty());
  CHECK(t.told("guarantee_void").size() == 2);
  CHECK(t.guarantee()["state"] == "bad_start");
  t.say(1, R"({"op":"advance","n":2})");
  CHECK(t.told("guarantee_void").size() == 2);
}

TEST_CASE("a scene that starts badly says so each time it is loaded, and a good one nothing") {
  BadRoom t("inside");
  t.join(1);
  t.say(1, R"({"op":"advance","n":2})");
  t.say(1, R"({"op":"load","scene":"inside"})");
  CHECK(t.told("guarantee_void").size() == 2);
  CHECK(t.told("guarantee_back").empty());
  t.say(1, R"({"op":"load","scene":"through"})");
  t.say(1, R"({"op":"advance","n":2})");
  CHECK(t.told("guarantee_void").size() == 2);
  CHECK(t.told("guarantee_back").empty());
  // There nothing keeps cloth from cloth, which is not what the guarantee says it does.
  CHECK(t.guarantee()["covers"] == json{"objects"});
  CHECK(t.guarantee()["state"] == "void");
  CHECK(t.guarantee()["reasons"] ==
        json{"cloth passes through cloth, which nothing prevents here"});
}

TEST_CASE("a post through a cloth between its particles is told from the start, and never held") {
  for (const std::uint32_t pause : {1U, 60U}) {
    BadRoom t("post", pause);
    t.join(1);
    const json at_start = t.output.last("state");
    CHECK(at_start["guarantee"]["state"] == "bad_start");
    CHECK(at_start["guarantee"]["reasons"] == json{"scarf started through post"});
    CHECK(at_start["guarantee"]["pairs"] == at_start["crossings"]["count"]);
    CHECK(at_start["crossings"]["count"].get<int>() > 0);
    for (int k = 0; k < 30; ++k) {
      t.say(1, R"({"op":"advance","n":10})");
      const json crossings = t.say(1, R"({"op":"query","id":7,"what":"crossings"})")["data"];
      const json guarantee = t.guarantee();
      CHECK((guarantee["state"] == "held") == (crossings["count"] == 0));
      CHECK(guarantee["state"] != "void");
    }
    CHECK(t.told("guarantee_void").size() == 1);
  }
}

TEST_CASE("a bead through a cell of a cloth is led out, and the guarantee is back") {
  BadRoom t("bead");
  t.join(1);
  CHECK(t.output.last("state")["guarantee"]["state"] == "bad_start");
  CHECK(t.output.last("state")["guarantee"]["reasons"].size() == 1);
  t.say(1, R"({"op":"advance","n":300})");
  CHECK(t.guarantee() == kHeld);
  CHECK(t.told("guarantee_back").size() == 1);
  t.say(1, R"({"op":"reset"})");
  CHECK(t.guarantee()["state"] == "bad_start");
}

TEST_CASE("without counting a bad start is told all the same, and when it is out") {
  BadRoom t("bead", 0);
  t.join(1);
  CHECK(t.output.last("state")["guarantee"]["state"] == "bad_start");
  t.say(1, R"({"op":"advance","n":300})");
  CHECK(t.guarantee() == kHeld);
}

TEST_CASE("what was forced through the cloth voids the guarantee until the reset") {
  BadRoom t("inside");
  t.join(1);
  for (int i = 0; i < 81; ++i) t.say(1, json{{"op", "pin"}, {"particle", i}}.dump());
  t.say(1, R"({"op":"move","collider":"block","position":[-2,0.5,0],"speed":20,"force":true})");
  t.say(1, R"({"op":"advance","n":60})");
  REQUIRE(t.guarantee()["state"] == "void");
  CHECK(t.guarantee()["reasons"][0] == "block was forced through the cloth");
  // The cloth comes out of the ball, but the promise is not back.
  t.say(1, R"({"op":"release","all":true})");
  t.say(1, R"({"op":"advance","n":200})");
  CHECK(t.guarantee()["reasons"] == json{"block was forced through the cloth"});
  CHECK(t.told("guarantee_back").empty());
  t.join(2);
  CHECK(t.output.last("state")["guarantee"]["state"] == "void");
  t.say(1, R"({"op":"reset"})");
  CHECK(t.guarantee()["state"] == "bad_start");
  t.say(1, R"({"op":"advance","n":200})");
  CHECK(t.guarantee() == kHeld);
}

TEST_CASE("the contact of the seed is told to promise nothing") {
  TestRoom t(true, {{"model", "seed"}});
  t.join(1);
  CHECK(t.output.last("state")["guarantee"]["state"] == "none");
  CHECK(t.output.last("state")["guarantee"]["covers"].empty());
}

TEST_CASE("crossings are counted at the start and every so many ticks, and told in the state") {
  BadRoom t("through", 10);
  t.join(1);
  const json at_start = t.output.last("state")["crossings"];
  CHECK(at_start["count"].get<int>() > 0);
  CHECK(at_start["tick"] == 0);
  CHECK(at_start["smallest_gap"].is_null());
  t.say(1, R"({"op":"resume"})");
  t.tick(9);
  CHECK(t.output.last("state")["crossings"]["tick"] == 0);
  t.tick(20);
  const json state = t.say(1, R"({"op":"query","id":1,"what":"state"})")["data"];
  CHECK(state["crossings"]["tick"] == 20);
}

TEST_CASE("what stands still is counted once, and told") {
  BadRoom t("through");
  t.join(1);
  t.say(1, R"({"op":"advance","n":5})");
  CHECK(t.output.last("state")["crossings"]["tick"] == 0);
  t.stand_still();
  CHECK(t.output.last("state")["crossings"]["tick"] == 5);
  const std::size_t states = t.output.count("state");
  t.stand_still();
  t.stand_still();
  CHECK(t.output.count("state") == states);
  t.say(1, R"({"op":"reset"})");
  CHECK(t.output.last("state")["crossings"]["tick"] == 0);
}

TEST_CASE("cloth that falls asleep is counted once more, with the gap to what it lies on") {
  TestRoom t(false, {{"environment.drag", "10"}, {"sleep.after", "0.5"}});
  t.join(1);
  t.say(1, R"({"op":"release","all":true})");
  t.say(1, R"({"op":"move","collider":"ball","position":[5,0,0],"speed":20})");
  for (int k = 0; k < 2000 && !t.room->world().sleep().all_asleep(); ++k) t.tick(1);
  REQUIRE(t.room->world().sleep().all_asleep());
  const json state = t.output.last("state");
  CHECK(state["crossings"]["tick"] == state["tick"]);
  CHECK(state["crossings"]["count"] == 0);
  const double thickness = t.room->world().model().parts[0].fabric.thickness;
  CHECK(state["crossings"]["smallest_gap"].get<double>() > 0);
  CHECK(state["crossings"]["smallest_gap"].get<double>() < 2 * thickness);
}

TEST_CASE("without counting nothing is counted, until a query asks") {
  BadRoom t("through", 0);
  t.join(1);
  t.say(1, R"({"op":"advance","n":70})");
  t.stand_still();
  CHECK(t.output.last("state")["crossings"].is_null());
  const json asked = t.say(1, R"({"op":"query","id":1,"what":"crossings"})");
  CHECK(asked["data"]["tick"] == 70);
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.say(1, R"({"op":"query","id":2,"what":"crossings"})")["data"]["tick"] == 71);
}

TEST_CASE("counting changes no bit of the motion") {
  BadRoom counted("inside", 1), uncounted("inside", 0);
  std::string hashes[2];
  BadRoom* rooms[] = {&counted, &uncounted};
  for (int k = 0; k < 2; ++k) {
    rooms[k]->join(1);
    hashes[k] = rooms[k]->say(1, R"({"op":"advance","id":1,"n":90})")["hash"];
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(counted.output.last("state")["crossings"]["tick"] == 90);
}

TEST_CASE("a count that does not end within its limit leaves no guarantee held until one does") {
  HaltingRoom t(true);
  t.takes = 0.9;  // more than is allowed between two ticks
  t.room->join(1);
  const auto guarantee = [&] {
    return t.room->say(1, R"({"op":"query","id":99,"what":"state"})")["data"]["guarantee"];
  };
  const auto stand_still = [&](double seconds) {
    t.room->clock.now += seconds;
    t.get().finish_turn();
  };
  REQUIRE(guarantee() == kHeld);
  SECTION("while the room stands") {
    t.room->say(1, R"({"op":"advance","n":5})");
    t.halt_at(0);
    stand_still(0.3);
  }
  SECTION("as somebody asks") {
    t.room->say(1, R"({"op":"advance","n":5})");
    t.halt_at(0);
    const json error = t.room->say(1, R"({"op":"query","id":1,"what":"crossings"})");
    REQUIRE(error["code"] == "too_costly");
  }
  SECTION("while ticks pass") {
    t.room->say(1, R"({"op":"resume"})");
    bool stopped = false;
    t.at_stop = [&] {  // the first stop point behind the tick of the count
      if (t.get().world().tick() < 60 || std::exchange(stopped, true)) return;
      t.hand.now += t.takes;
    };
    t.room->tick(61);
    REQUIRE(stopped);
    REQUIRE_FALSE(t.get().paused());
    t.at_stop = nullptr;
  }
  CHECK(guarantee()["state"] == "void");
  CHECK(guarantee()["reasons"].size() == 1);
  CHECK(t.room->output.last("state")["guarantee"]["state"] == "void");  // told, too
  // It is tried again when there is time.
  for (int second = 0; second < 102; ++second) stand_still(1);
  if (!t.get().paused()) t.room->tick(60);
  CHECK(guarantee() == kHeld);
}

TEST_CASE("what the scene throws through itself is not held while its count does not end") {
  HandLimit hand;
  BadRoom t("gathered", 60, &hand.limit);
  bool slow = true;
  hand.limit.signal().attend = [&] {
    if (slow && t.room->world().tick() >= 4) hand.now += 0.9;  // it gathers in the fourth tick
    return t.room->gives_up();
  };
  hand.limit.signal().raise();
  t.join(1);
  t.say(1, R"({"op":"advance","n":4})");
  CHECK(t.guarantee()["state"] == "void");
  slow = false;
  t.say(1, R"({"op":"reset"})");
  CHECK(t.guarantee() == kHeld);
}

TEST_CASE("a first count that did not end holds nothing, and neither does a reset") {
  FakeClock clock;
  const World<float> world(bad_scene("through"));
  GuaranteeWatch<float> watch(60, clock.clock());
  StopSignal signal;
  signal.raise();
  {
    const StopScope scope(&signal);
    watch.start(world, {});
  }
  CHECK(watch.guarantee(world).state == proto::GuaranteeState::broken);
  watch.restart();
  CHECK(watch.guarantee(world).state == proto::GuaranteeState::broken);
  GuaranteeWatch<float> uncounted(0, clock.clock());
  uncounted.start(world, {});
  CHECK(uncounted.guarantee(world).state == proto::GuaranteeState::held);
}

TEST_CASE("counts are a hundred times as far apart as one takes") {
  FakeClock clock;
  const World<float> world(bad_scene("through"));
  GuaranteeWatch<float> watch(1, clock.clock());
  clock.between_reads = [] { return 1.0; };  // so a count takes a second
  watch.start(world, world.coming_bad_starts());
  const double counted = clock.now;
  int ticks = 0;
  do {
    watch.note_tick(world);
    ++ticks;
    watch.count_if_due(world);
  } while (ticks < 1000 && clock.now < counted + 99);
  CHECK(ticks >= 98);  // each looks at the clock once, and none has counted
  while (ticks < 1000 && !watch.count_if_stale(world)) ++ticks;
  CHECK(ticks < 1000);
}

}  // namespace
}  // namespace weft::server
