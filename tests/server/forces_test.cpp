#include <array>
#include <span>
#include <string>

#include <catch2/catch.hpp>

#include "proto/frames/frame.h"
#include "tests/server/fakes.h"

// Contacts and forces, asked for once and in frames.

namespace weft::server {
namespace {

using nlohmann::json;

double weight_of(const Room& room) {
  double mass = 0;
  for (const float m : room.world().model().mass) mass += static_cast<double>(m);
  return mass * 9.81;
}

proto::Frame decoded(const std::string& bytes) {
  return *proto::decode_frame(std::as_bytes(std::span(bytes)));
}

TEST_CASE("a query tells the forces of pins, hands and objects, and changes nothing") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"set","drag":8})");
  t.say(1, R"({"op":"advance","n":600})");
  const std::string before = proto::hash_text(t.room->world().hash());
  const json hanging = t.say(1, R"({"op":"query","id":1,"what":"reactions"})")["data"];
  REQUIRE(hanging["pins"].size() == 2);
  const double up =
      hanging["pins"][0]["force"][1].get<double>() + hanging["pins"][1]["force"][1].get<double>();
  CHECK(up == Approx(weight_of(*t.room)).epsilon(1e-3));
  CHECK(hanging["colliders"][0]["collider"] == "floor");
  CHECK(hanging["colliders"][0]["force"] == json({0, 0, 0}));
  CHECK(t.say(1, R"({"op":"query","id":2,"what":"contacts"})")["data"].empty());
  CHECK(proto::hash_text(t.room->world().hash()) == before);

  t.say(1, R"({"op":"drag","phase":"start","particle":38,"target":[0,1,0.5]})");
  t.say(1, R"({"op":"advance","n":300})");
  const json held = t.say(1, R"({"op":"query","id":3,"what":"reactions"})")["data"];
  REQUIRE(held["grabs"].size() == 1);
  CHECK(held["grabs"][0]["viewer"] == 1);
  CHECK(held["grabs"][0]["force"][2].get<double>() > 0);
}

TEST_CASE("a cloth that lies tells its contacts, and their sum carries it") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"release","all":true})");
  t.say(1, R"({"op":"move","collider":"ball","position":[5,0,0],"speed":20})");
  t.say(1, R"({"op":"set","drag":8})");
  t.say(1, R"({"op":"advance","n":900})");
  const json contacts = t.say(1, R"({"op":"query","id":1,"what":"contacts"})")["data"];
  double normal = 0;
  for (const json& contact : contacts) {
    CHECK(contact["collider"] == "floor");
    CHECK(contact["particles"].size() == contact["weights"].size());
    normal += contact["normal_force"].get<double>();
  }
  CHECK(normal == Approx(weight_of(*t.room)).epsilon(0.02));
}

/// What a query for reactions tells of the first pin.
Vec3d asked_force(TestRoom& t) {
  const json pins = t.say(1, R"({"op":"query","id":9,"what":"reactions"})")["data"]["pins"];
  const auto force = pins[0]["force"].get<std::array<double, 3>>();
  return Vec3d(force[0], force[1], force[2]);
}

TEST_CASE(
    "the first question for forces looks a tick ahead, later ones tell the last tick's means") {
  TestRoom t;
  t.join(1);
  t.say(1, R"({"op":"advance","n":30})");
  CHECK(t.room->world().reactions() == nullptr);
  const Vec3d first = asked_force(t);
  REQUIRE(t.room->world().reactions() != nullptr);
  CHECK(t.room->world().reactions()->tick == 31);
  CHECK(first == t.room->world().reactions()->pins[0].force);
  CHECK(asked_force(t) == first);
  t.say(1, R"({"op":"advance","n":5})");
  CHECK(t.room->world().reactions()->tick == 35);
  CHECK(asked_force(t) == t.room->world().reactions()->pins[0].force);
  CHECK(asked_force(t) != t.room->world().coming_reactions().pins[0].force);
  CHECK(t.room->world().reactions()->tick == 35);
}

TEST_CASE("forces that nobody asks for any more are measured no longer, nor after a reset") {
  TestRoom t;
  t.join(1);
  asked_force(t);
  t.say(1, R"({"op":"advance","n":)" + std::to_string(kForcesAskedTicks - 1) + "}");
  CHECK(t.room->world().reactions() != nullptr);
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.room->world().reactions() != nullptr);  // of the last tick that measured
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.room->world().reactions() == nullptr);
  asked_force(t);
  t.say(1, R"({"op":"reset"})");
  t.say(1, R"({"op":"advance","n":1})");
  CHECK(t.room->world().reactions() == nullptr);
}

TEST_CASE("frames have no forces because a query asked for them") {
  TestRoom t(false);
  t.join(1);
  asked_force(t);
  t.tick(3);
  CHECK(t.room->world().reactions() != nullptr);
  CHECK(t.output.frames_with_forces.empty());
}

TEST_CASE("frames tell forces only to those who ask, and nothing is measured before") {
  TestRoom t(false);
  t.join(1);
  t.tick(3);
  CHECK(t.output.frames_with_forces.empty());
  CHECK(t.room->world().reactions() == nullptr);
  t.output.viewers_want_forces = true;
  t.tick(2);
  REQUIRE(t.output.frames_with_forces.size() >= 1);
  const proto::Frame plain = decoded(t.output.frames.back());
  const proto::Frame full = decoded(t.output.frames_with_forces.back());
  CHECK(plain.reactions.empty());
  CHECK(full.header == plain.header);
  REQUIRE(full.reactions.size() == 4);  // two pins, two objects
  CHECK(full.reactions[0].of == proto::ReactionOf::pin);
  CHECK(full.reactions[0].force[1] > 0);
  CHECK(full.reactions[3].of == proto::ReactionOf::collider);
  CHECK(full.reactions[3].id == 1);
  t.output.viewers_want_forces = false;
  t.tick(1);
  CHECK(t.room->world().reactions() == nullptr);
}

/// A room whose cloth lies on the floor, by itself, and sleeps if the scene lets it.
struct LyingRoom : TestRoom {
  explicit LyingRoom(const char* sleep_after)
      : TestRoom(false, {{"environment.drag", "10"}, {"sleep.after", sleep_after}}) {
    join(1);
    say(1, R"({"op":"release","all":true})");
    say(1, R"({"op":"move","collider":"ball","position":[5,0,0],"speed":20})");
    tick(900);
  }

  /// As after a viewer's `view`.
  proto::Frame ask_for_forces() {
    output.viewers_want_forces = true;
    room->take({1, ++number, Noted{true, {}}});
    clock.now += 0.1;
    room->finish_turn();
    REQUIRE(output.frames_with_forces.size() >= 1);
    return decoded(output.frames_with_forces.back());
  }
  std::size_t asked_contacts() {
    return say(1, R"({"op":"query","id":70,"what":"contacts"})")["data"].size();
  }
};

TEST_CASE("who asks a paused room for forces gets the contacts that a query tells, at once") {
  LyingRoom t("0");
  t.say(1, R"({"op":"pause"})");
  const std::string before = proto::hash_text(t.room->world().hash());
  const proto::Frame frame = t.ask_for_forces();
  CHECK(proto::hash_text(t.room->world().hash()) == before);
  CHECK(frame.header.tick == t.room->world().tick());
  CHECK(frame.contacts.size() > 4);
  CHECK(frame.contacts.size() == t.asked_contacts());
  CHECK(frame.reactions.size() == 2);  // of the objects
  // Another state has other contacts, and nobody has to step for them.
  t.say(1, R"({"op":"reset"})");
  t.clock.now += 0.1;
  t.room->finish_turn();
  const proto::Frame at_start = decoded(t.output.frames_with_forces.back());
  CHECK(at_start.header.tick == 0);
  CHECK(at_start.contacts.empty());
  CHECK(at_start.reactions.size() == 4);  // of the pins, too
}

TEST_CASE("who asks a sleeping room for forces gets the contacts that a query tells, at once") {
  LyingRoom t("0.5");
  REQUIRE(t.room->world().sleep().all_asleep());
  const proto::Frame frame = t.ask_for_forces();
  CHECK(frame.contacts.size() > 4);
  CHECK(frame.contacts.size() == t.asked_contacts());
  // And who joins them later, as well.
  t.tick(10);
  t.join(2);
  t.tick(10);
  CHECK(decoded(t.output.frames_with_forces.back()).contacts.size() == frame.contacts.size());
  CHECK(t.room->world().report().rested);
}

TEST_CASE("a viewer that asks for forces gets the frames that have them, the others do not") {
  FakeClock clock;
  const Clock now = clock.clock();
  FakeStream stream;
  ViewerChannel channel(stream, now, 60, {});
  stream.channel = &channel;
  channel.welcome_done();
  Frame frame = fake_frame(1);
  frame.with_forces = SharedBytes(std::string("frame with forces"));
  channel.offer_frame(frame);
  CHECK(stream.written.back() == "frame 1");
  CHECK_FALSE(channel.wants_forces());
  stream.drain();
  channel.want_forces(true);
  CHECK(channel.wants_forces());
  frame.sequence = 2;
  clock.now += 1;
  channel.offer_frame(frame);
  CHECK(stream.written.back() == "frame with forces");
  channel.set_most_frames(0);
  CHECK_FALSE(channel.wants_forces());
}

}  // namespace
}  // namespace weft::server
