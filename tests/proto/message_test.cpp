#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/frames/mesh.h"
#include "proto/messages/data.h"
#include "proto/messages/events.h"
#include "proto/messages/http.h"
#include "proto/messages/replies.h"
#include "tests/proto/golden.h"

using namespace weft::proto;
using namespace weft::test;
using nlohmann::json;

// The examples of the specification are what the encoders write, message by message; so the page
// cannot say anything else than the program.

namespace {

const Energy kEnergy{0.012, 0.034, 0.001, 1.9, 1.947};
const Camera kCamera{{0, 1.2, 3}, {0, 1, 0}, {0, 1, 0}, 45};
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

State state() {
  State s;
  s.tick = 5160;
  s.time = 86;
  s.scene = "default";
  s.gravity = {0, -9.81, 0};
  s.wind = {0, 0, 1.5};
  s.gust_speed = 0.5;
  s.gust_length = 0.6;
  s.air_density = 1.225;
  s.drag = 0.1;
  s.fabric = "default";
  s.fabrics = {{{}, 0.2, 400, 400, 40, 1e-5, 1e-5, 0.05, 0, 0.004, 0.4}};
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

std::string drag_error() {
  Error error = range_error("target[1]", 1e99, weft::kPositionRange);
  error.id = 13;
  error.command = "drag";
  error.hint = "positions are in metres";
  return encode_error(error);
}

std::vector<std::string> events() {
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
      encode_state(state()),
      encode_roster({{3, "Ada", "#e4572e", Role::operator_, true, kCamera},
                     {4, "script", "#2e86e4", Role::viewer, false, std::nullopt}}),
      encode_pins(5160, {{1, 0, 0, 0, {-0.5, 1.6, 0}, 1, {}, false},
                         {9, 3, 299, 0.05, {0.1, 0.8, 0.3}, 7, Vec3{0.1, 1, 0.5}, false}}),
      encode_grabs(5160, {grab}),
      encode_notice(notice),
      encode_bye({1001, "the server stops"}),
      drag_error(),
  };
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

ReactionInfo reactions() {
  ReactionInfo reactions;
  reactions.pins = {{1, {0.1, 0.49, 0}}, {2, {-0.1, 0.49, 0}}};
  reactions.grabs = {{4, 3, {0, 0.2, 0}}};
  reactions.colliders = {{"ground", {0, -0.31, 0}}};
  return reactions;
}

RoomInfo room(const char* name, std::uint64_t tick, bool paused) {
  return {name, "flag", 1225, 0, tick, paused, 0};
}

std::vector<std::string> replies() {
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
      encode_reply(25, QueryReply{600, reactions()}),
      encode_reply(27, QueryReply{600, Crossings{0, 600, {}}}),
      encode_reply(23, HashReply{600, kHash}),
      encode_reply(24, PingReply{1712.25, 91.000125, 91.000131}),
      encode_reply(25, LoadReply{0, "flag", 2}),
      encode_reply(33, DoneReply{"save", 300}),
      encode_reply(34, DoneReply{"restore", 300}),
      encode_reply(29, CreateRoomReply{room("class-7", 0, false)}),
      encode_reply(30, ForkReply{481, room("mine", 481, true)}),
      encode_reply(31, ListRoomsReply{{{"mine", "flag", 1225, 1, 503, false, 1}}, 64}),
      encode_reply(32, CloseRoomReply{"mine"}),
      encode_reply(26, ViewReply{30, Codec::f32}),
      encode_reply(28, ViewReply{240, Codec::packed, false, 1e-4}),
  };
}

std::vector<std::string> http_bodies() {
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

bool is_command(const json& example) {
  static const std::set<std::string> of_server = {"welcome", "mesh", "state",  "roster", "pins",
                                                  "grabs",   "bye",  "notice", "result", "error"};
  return example.contains("op") && !of_server.contains(example["op"].get<std::string>());
}

std::vector<json> examples(bool of_commands) {
  std::vector<json> found;
  for (const std::string& text : specification_examples()) {
    INFO(text);
    json example = json::parse(text);
    if (is_command(example) == of_commands) found.push_back(std::move(example));
  }
  return found;
}

std::vector<json> written_messages() {
  std::vector<json> written;
  for (const auto& group : {events(), replies(), http_bodies()})
    for (const std::string& text : group) written.push_back(json::parse(text));
  return written;
}

bool has(const std::vector<json>& list, const json& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

TEST_CASE("Each example of a command in the specification is a command") {
  std::set<std::string> operations;
  for (const json& example : examples(true)) {
    INFO(example.dump());
    const Result<Request> request = parse_request(example.dump());
    REQUIRE(request.has_value());
    operations.insert(name_of(request->command));
  }
  CHECK(operations.size() == 26);  // one at least for each
}

TEST_CASE("Each example of a server's message in the specification is what the server writes") {
  const std::vector<json> written = written_messages();
  for (const json& example : examples(false)) {
    INFO(example.dump());
    CHECK(has(written, example));
  }
}

TEST_CASE("Each message that the server writes has its example in the specification") {
  const std::vector<json> specified = examples(false);
  for (const json& message : written_messages()) {
    INFO(message.dump());
    CHECK(has(specified, message));
  }
}

TEST_CASE("Each message of the server on the socket begins with its op") {
  for (const auto& group : {events(), replies()})
    for (const std::string& text : group) CHECK(text.starts_with("{\"op\":\""));
}

TEST_CASE("Every kind of query is answered with its name") {
  const auto what = [](const QueryReply& reply) {
    return json::parse(encode_reply("q", reply))["what"].get<std::string>();
  };
  CHECK(what({1, Strain{}}) == "strain");
  CHECK(what({1, std::vector<PinInfo>{}}) == "pins");
  CHECK(what({1, std::vector<GrabInfo>{}}) == "grabs");
  CHECK(what({1, std::vector<ViewerInfo>{}}) == "roster");
  CHECK(what({1, state()}) == "state");
  CHECK(what({1, std::vector<StageWork>{{"stretch", 0.2, 5814}}}) == "work");
  const json cameras =
      json::parse(encode_reply("q", QueryReply{1, std::vector<ViewerCamera>{{4, kCamera}}}));
  CHECK(cameras["what"] == "camera");
  CHECK(cameras["data"][0]["viewer"] == 4);
  CHECK(cameras["data"][0]["fov"] == 45);
}

TEST_CASE("Contacts of cloth with cloth name no object, unknown forces of pins are left out") {
  ContactInfo cloth;
  cloth.particles = {1, 2, 3, 4};
  const json contacts =
      json::parse(encode_reply(1, QueryReply{0, std::vector<ContactInfo>{cloth}}));
  CHECK_FALSE(contacts["data"][0].contains("collider"));
  ReactionInfo unknown = reactions();
  unknown.pins.reset();
  CHECK_FALSE(json::parse(encode_reply(1, QueryReply{0, unknown}))["data"].contains("pins"));
}

TEST_CASE("A guarantee that does not hold is told with its reasons, what was not counted is null") {
  State s = state();
  s.crossings.reset();
  s.guarantee = {GuaranteeState::bad_start, {"objects"}, 12, {"scarf started inside ball"}};
  const json told = json::parse(encode_state(s));
  CHECK(told["crossings"].is_null());
  CHECK(told["guarantee"] == json::parse(R"({"state":"bad_start","covers":["objects"],"pairs":12,
                                             "reasons":["scarf started inside ball"]})"));
  const auto word = [&s](GuaranteeState guarantee) {
    s.guarantee.state = guarantee;
    return json::parse(encode_state(s))["guarantee"]["state"].get<std::string>();
  };
  CHECK(word(GuaranteeState::held) == "held");
  CHECK(word(GuaranteeState::broken) == "void");
  CHECK(word(GuaranteeState::none) == "none");
}

TEST_CASE("Vectors are written as rows of three and read back bit for bit") {
  const std::vector<float> floats = {0.1F, -1.0F / 3, 1e-30F, 3.4028235e38F, 0, 12};
  const json singles = json::parse(encode_reply(7, VectorsReply{5, QueryWhat::velocities, floats}));
  CHECK(singles["id"] == 7);
  CHECK(singles["tick"] == 5);
  CHECK(singles["what"] == "velocities");
  REQUIRE(singles["data"].size() == 2);
  for (std::size_t i = 0; i < floats.size(); ++i)
    CHECK(singles["data"][i / 3][i % 3].get<float>() == floats[i]);

  const std::vector<double> doubles = {0.1, -1.0 / 3, 5e-324};
  const json data = json::parse(encode_reply(7, VectorsReply{5, QueryWhat::positions, doubles}));
  for (std::size_t i = 0; i < 3; ++i) CHECK(data["data"][0][i].get<double>() == doubles[i]);

  const std::vector<float> none;
  CHECK(json::parse(encode_reply(7, VectorsReply{5, QueryWhat::positions, none}))["data"].empty());
}

TEST_CASE("What is not finite is written as null") {
  const std::vector<float> bad = {std::numeric_limits<float>::quiet_NaN(),
                                  std::numeric_limits<float>::infinity(), 1};
  const json reply = json::parse(encode_reply(7, VectorsReply{5, QueryWhat::positions, bad}));
  CHECK(reply["data"][0] == json({nullptr, nullptr, 1.0}));
  State s = state();
  s.step_ms = std::numeric_limits<double>::quiet_NaN();
  CHECK(json::parse(encode_state(s))["step_ms"].is_null());
}

TEST_CASE("Text that is not UTF-8 does not keep a message from being written") {
  Notice notice;
  notice.message = "bad \xFF byte";
  CHECK(json::accept(encode_notice(notice)));
}

TEST_CASE("A force of a grab is written when it is known") {
  GrabInfo grab;
  grab.force = Vec3{1, 2, 3};
  const json reply = json::parse(encode_reply(1, QueryReply{0, std::vector<GrabInfo>{grab}}));
  CHECK(reply["data"][0]["force"] == json({1, 2, 3}));
}

TEST_CASE("Hashes are 16 hexadecimal digits") {
  CHECK(hash_text(0) == "0000000000000000");
  CHECK(hash_text(0x0123456789abcdefULL) == "0123456789abcdef");
  CHECK(mesh_url(255) == "/api/v1/mesh/00000000000000ff");
}

TEST_CASE("Numbers in errors are short and read back to the same") {
  CHECK(number_text(100000) == "100000");
  CHECK(number_text(-0.5) == "-0.5");
  CHECK(number_text(1e99) == "1e+99");
  for (const double x : {0.1, 1e22, 1.0 / 3, -2.5e-9, 9007199254740992.0})
    CHECK(std::stod(number_text(x)) == x);
  CHECK(number_text(std::numeric_limits<double>::infinity()) == "null");
}
