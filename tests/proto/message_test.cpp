#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/messages/events.h"
#include "proto/messages/replies.h"
#include "tests/proto/golden.h"
#include "tests/proto/sample_messages.h"

using namespace weft::proto;
using namespace weft::test;
using nlohmann::json;

// The examples of the specification are what the encoders write, message by message; so the page
// cannot say anything else than the program.

namespace {

bool is_command(const json& example) {
  static const std::set<std::string> of_server = {"welcome", "mesh", "state",  "roster", "pins",
                                                  "grabs",   "bye",  "notice", "result", "error"};
  if (example.contains("viewers")) return false;  // `presence` is the op of a command too
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
  for (const auto& group : {sample_events(), sample_replies(), sample_http_bodies()})
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
  CHECK(operations.size() == 33);  // one at least for each
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
  for (const auto& group : {sample_events(), sample_replies()})
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
  CHECK(what({1, sample_state()}) == "state");
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
  ReactionInfo unknown = sample_reactions();
  unknown.pins.reset();
  CHECK_FALSE(json::parse(encode_reply(1, QueryReply{0, unknown}))["data"].contains("pins"));
}

TEST_CASE("A guarantee that does not hold is told with its reasons, what was not counted is null") {
  State s = sample_state();
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
  State s = sample_state();
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
