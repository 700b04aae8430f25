#include "tests/proto/sample_messages.h"

#include <array>
#include <span>

#include "proto/frames/mesh.h"
#include "proto/messages/data.h"
#include "proto/messages/http.h"

using namespace weft::proto;

namespace weft::test {
namespace {

const Energy kEnergy{0.012, 0.034, 0.001, 1.9, 1.947};
constexpr std::uint64_t kHash = 0xc3a5c85c97cb3127ULL;

Welcome welcome() {
  Welcome w;
  w.version = "0.1.0";
  w.session = "8f14e45fceea167a";
  w.viewer = 3;
  w.name = "viewer 3";
  w.color = "#e4572e";
  w.role = Role::operator_;
  w.scene = "default";
  w.clock = 86.500125;
  w.capabilities = {"pick",  "drag", "pin",      "camera",  "step", "advance",
                    "query", "move", "move_pin", "gripper", "load", "rooms"};
  return w;
}

// The bytes that a mesh of the size in the example has.
std::size_t mesh_bytes() {
  SceneMesh mesh;
  mesh.rest_positions.resize(std::size_t{600} * 3);
  mesh.triangles.resize(std::size_t{1102} * 3);
  mesh.uv.resize(std::size_t{600} * 2);
  mesh.colliders.resize(1);
  mesh.colliders[0].positions.resize(std::size_t{711} * 3);
  mesh.colliders[0].triangles.resize(std::size_t{1418} * 3);
  return encode_mesh_data(mesh).size();
}

MeshAnnouncement mesh() {
  MeshAnnouncement m;
  m.epoch = 1;
  m.scene = "default";
  m.hash = 0x4fd1c2a09b7e6d35ULL;
  m.bytes = mesh_bytes();
  m.vertices = 600;
  m.triangles = 1102;
  m.cloths = {{"cloth", 0, 600, 0, 1102, 20, 30, 0.004, {"silk", "#2a6f97", ""}}};
  m.view = {{0, 1, 0}, {0, 0.6, 0.8}, 0.9};
  m.colliders = {{"ground", PlaneInfo{{0, 0, 0}, {0, 1, 0}}, {0, 0, 0}},
                 {"ball", SphereInfo{{0, 0.5, 0}, 0.3}, {0, 0.5, 0}},
                 {"post", CapsuleInfo{{0, 0, 0}, {0, 1, 0}, 0.05}, {0, 0.5, 0}},
                 {"block", BoxInfo{{0, 0.2, 0}, {0.2, 0.1, 0.2}, {0, 0, 0, 1}}, {0, 0.2, 0}},
                 {"form", MeshInfo{711, 1418}, {0, 1.2, 0}}};
  return m;
}

std::string drag_error() {
  Error error = range_error("target[1]", 1e99, weft::kPositionRange);
  error.id = 13;
  error.command = "drag";
  error.hint = "positions are in metres";
  return encode_error(error);
}

constexpr std::array<float, 12> kBoxes = {-0.5F, 0.4F, -0.2F, 0,    1.6F, 0.3F,
                                          0,     0.4F, -0.2F, 0.5F, 1.6F, 0.3F};

ContactInfo contact() {
  ContactInfo contact;
  contact.collider = "ground";
  contact.particles = {17};
  contact.weights = {1};
  contact.point = {0.1, 0.004, 0.2};
  contact.normal = {0, 1, 0};
  contact.gap = 0.004;
  contact.normal_force = 0.0021;
  contact.friction = {0.0003, 0, 0};
  return contact;
}

RoomInfo room(const char* name, std::uint64_t tick, bool paused) {
  return {name, "flag", 1225, 0, tick, paused, 0};
}

}  // namespace

State sample_state() {
  State s;
  s.tick = 5160;
  s.time = 86;
  s.scene = "default";
  s.gravity = {0, -9.81, 0};
  s.air.wind = {0, 0, 1.5};
  s.air.gust_speed = 0.5;
  s.air.gust_length = 0.6;
  s.air.density = 1.225;
  s.air.drag = 0.1;
  s.fabric = "default";
  FabricChange& fabric = s.fabrics.emplace_back();
  fabric.areal_density = 0.2;
  fabric.stretch_warp = fabric.stretch_weft = 400;
  fabric.shear = 40;
  fabric.bending_warp = fabric.bending_weft = 1e-5;
  fabric.damping_ratio = 0.05;
  fabric.bending_damping = 0;
  fabric.thickness = 0.004;
  fabric.friction = 0.4;
  s.solver = "verlet";
  s.substeps = 8;
  s.particles = 600;
  s.step_ms = 0.42;
  s.real_time_factor = 1;
  s.guarantee.covers = {"objects", "cloth"};
  s.crossings = {0, 5158, 0.0031};
  s.strain = {0.021, 0.012};
  s.energy = kEnergy;
  return s;
}

EnergyBalance sample_balance() {
  EnergyBalance balance;
  balance.since = 300;
  balance.start = 1.75;
  balance.work.hands = 0.5;
  balance.work.wind = 0.25;
  balance.losses.damping = 0.125;
  balance.losses.air = 0.375;
  balance.now = 2;
  return balance;
}

ReactionInfo sample_reactions() {
  ReactionInfo reactions;
  reactions.pins = {{1, {0.1, 0.49, 0}}, {2, {-0.1, 0.49, 0}}};
  reactions.grabs = {{4, 3, {0, 0.2, 0}}};
  reactions.colliders = {{"ground", {0, -0.31, 0}}};
  return reactions;
}

std::vector<std::string> sample_events() {
  const GrabInfo grab{17,
                      3,
                      1,
                      {411, {0.2, 0.5, 0.3}},
                      0.03,
                      150,
                      50,
                      {0.1, 0.9, 0.2},
                      {0.2, 1.1, 0.4},
                      DragMode::live,
                      std::nullopt};
  Notice notice{NoticeLevel::warning,
                "lease_expired",
                "drag 1 was released after 2 s without a target",
                5200,
                3,
                1,
                {},
                {}};
  return {
      encode_welcome(welcome()),
      encode_mesh(mesh()),
      encode_state(sample_state()),
      encode_roster({{3, "Ada", "#e4572e", Role::operator_, true, kCamera},
                     {4, "script", "#2e86e4", Role::viewer, false, std::nullopt}}),
      encode_pins(5160, {{1, 0, 0, 0, {-0.5, 1.6, 0}, 1, {}, false},
                         {9, 3, 299, 0.05, {0.1, 0.8, 0.3}, 7, Vec3{0.1, 1, 0.5}, false}}),
      encode_grabs(5160, {grab}),
      encode_notice(notice),
      encode_bye({1001, "the server stops"}),
      encode_presence({{3, {}, false, kCamera, {}},
                       {4, Vec3{0.1, 0.8, 0.3}, false, {}, {}},
                       {5, {}, true, {}, ViewerId{3}}}),
      drag_error(),
  };
}

std::vector<std::string> sample_replies() {
  const ClothHit hit{{411, {0.2, 0.5, 0.3}}, {0, 1, 0.12}, 222, 2.88};
  return {
      encode_reply(12, PauseReply{5160, true}),
      encode_reply(1, HelloReply{3, "Ada", "#e4572e", Role::operator_}),
      encode_reply(2, PickReply{5161, hit}),
      encode_reply(2, PickReply{5161, std::nullopt}),
      encode_reply(3, DragReply{5162, 1, 17, Vec3{0, 1.1, 0.2}, {}}),
      encode_reply(4, DragReply{5301, 1, 17, {}, {}}),
      encode_reply(4, DragReply{5301, 2, 18, {}, Vec3{0, 0.6, 0.2}}),
      encode_reply(5, PinReply{5310, 9, 299, 7}),
      encode_reply(6, ReleaseReply{5400, {9}}),
      encode_reply(14, PauseReply{5160, false}),
      encode_reply(15, StepReply{5160, 5161}),
      encode_reply(16, DoneReply{"reset", 0}),
      encode_reply(17, SpeedReply{8, 0.25}),
      encode_reply(27, MoveReply{30, "ball"}),
      encode_reply(31, MovePinReply{30, 9, {0.1, 0.8, 0.3}}),
      encode_reply(32, MovePinReply{90, 9, {0.1, 0.9, 0.4}}),
      encode_reply(29, GripperReply{30, "gripper"}),
      encode_reply(30, QueryReply{600, std::vector<GripperInfo>{{"gripper",
                                                                 {0.28, 0.9, 0},
                                                                 {0, 0, 0, 1},
                                                                 0.008,
                                                                 5,
                                                                 true,
                                                                 {0, -0.8, 0},
                                                                 {0, 0, 0.01}}}}),
      encode_reply(18, DoneReply{"set", 30}),
      encode_reply(19, AdvanceReply{600, kHash}),
      encode_reply(20, QueryReply{600, kEnergy}),
      encode_reply(21, BinaryReply{600, QueryWhat::positions, QueryFormat::f64, 1, 600, 3}),
      encode_reply(23, VectorsReply{600, QueryWhat::boxes, std::span<const float>(kBoxes), 6}),
      encode_reply(24, QueryReply{600, std::vector<ContactInfo>{contact()}}),
      encode_reply(25, QueryReply{600, sample_reactions()}),
      encode_reply(27, QueryReply{600, Crossings{0, 600, {}}}),
      encode_reply(28, QueryReply{600, sample_balance()}),
      encode_reply(23, HashReply{600, kHash}),
      encode_reply(24, PingReply{1712.25, 91.000125, 91.000131}),
      encode_reply(25, LoadReply{0, "flag", 2}),
      encode_reply(24, DoneReply{"policy", 5160}),
      encode_reply(25, InviteReply{5160, "5f2b6c0d9a8e4713c1d2e3f405162738"}),
      encode_reply(33, DoneReply{"save", 300}),
      encode_reply(34, DoneReply{"restore", 300}),
      encode_reply(29, CreateRoomReply{room("class-7", 0, false)}),
      encode_reply(30, ForkReply{481, room("mine", 481, true), {}}),
      encode_reply(31, ListRoomsReply{{{"mine", "flag", 1225, 1, 503, false, 1}}, 64}),
      encode_reply(32, CloseRoomReply{"mine"}),
      encode_reply(26, ViewReply{30, Codec::f32}),
      encode_reply(28, ViewReply{240, Codec::packed, false, 1e-4}),
  };
}

std::vector<std::string> sample_http_bodies() {
  return {
      encode_version({"0.1.0", "c730fd8", "GNU 12.2.0", "avx2"}),
      encode_scenes({{"default", "A cloth hangs before a dressmaker's form in light wind."}}),
      encode_readiness({true, "default", "default", 5160, 1}),
      encode_http_error({"not_found", "no such path: /foo", "see /api/v1/scenes", "", {}}),
      encode_http_error(
          {"unknown_protocol", "this server speaks weft.v1", "", "weft.v7", {"weft.v1"}}),
      encode_http_error({"not_allowed",
                         "this server does not answer to the name evil.example",
                         "open one of those, or start the server with --allow-origin "
                         "http://evil.example (https:// behind a proxy with TLS)",
                         "evil.example",
                         {"localhost", "weft.example", "any IP address"}}),
  };
}

}  // namespace weft::test
