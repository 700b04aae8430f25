#include <random>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/messages/commands.h"
#include "proto/messages/replies.h"
#include "tests/proto/golden.h"

using namespace weft::proto;
using namespace weft::test;
using nlohmann::json;

namespace {

json error_json(const Error& error) {
  return json::parse(encode_error(error));
}

}  // namespace

TEST_CASE("Each golden command is read with its defaults") {
  for (const json& golden : read_golden_json("accepted_commands.json")) {
    const std::string text = golden["text"];
    INFO(text);
    const Result<Request> request = parse_request(text);
    REQUIRE(request.has_value());
    CHECK(json::parse(encode_request(*request)) == golden["request"]);
  }
}

TEST_CASE("A written command is read as the same command") {
  for (const json& golden : read_golden_json("accepted_commands.json")) {
    const std::string text = golden["text"];
    INFO(text);
    const Result<Request> request = parse_request(text);
    REQUIRE(request.has_value());
    const Result<Request> again = parse_request(encode_request(*request));
    REQUIRE(again.has_value());
    CHECK(*again == *request);
  }
}

TEST_CASE("Each malformed command is refused with its code, field, value and limit") {
  for (const json& golden : read_golden_json("refused_commands.json")) {
    std::string text;
    if (golden.contains("hex")) {
      for (const std::byte b : bytes_of_hex(golden["hex"])) text += static_cast<char>(b);
    } else {
      text = golden["text"];
    }
    INFO(golden.dump());
    const Result<Request> request = parse_request(text);
    REQUIRE_FALSE(request.has_value());
    const json error = error_json(request.error());
    CHECK(error["op"] == "error");
    CHECK_FALSE(error["message"].get<std::string>().empty());
    for (const auto& [key, value] : golden["error"].items()) {
      INFO(key << " in " << error.dump());
      REQUIRE(error.contains(key));
      CHECK(error[key] == value);
    }
  }
}

TEST_CASE("Size and depth have sharp limits") {
  const std::string start = R"({"op":"pause","x":")", end = R"("})";
  const std::string fill(kMostMessageBytes - start.size() - end.size(), 'x');
  CHECK(parse_request(start + fill + end).has_value());
  CHECK(parse_request(start + fill + "x" + end).error().code == ErrorCode::too_large);

  const auto nested = [](std::size_t depth) {
    return R"({"op":"pause","x":)" + std::string(depth, '[') + std::string(depth, ']') + "}";
  };
  CHECK(parse_request(nested(kMostDepth - 1)).has_value());
  CHECK(parse_request(nested(kMostDepth)).error().code == ErrorCode::bad_json);
  CHECK(parse_request(std::string(60000, '[')).error().code == ErrorCode::bad_json);
  CHECK(parse_request(std::string(60000, '{')).error().code == ErrorCode::bad_json);
}

TEST_CASE("An error is short and valid JSON whatever was sent") {
  const std::string lengthy(60000, 'y');
  const std::string texts[] = {
      R"({"op":")" + lengthy + R"("})",
      R"({"op":"load","scene":")" + lengthy + R"("})",
      R"({"op":"query","what":")" + lengthy + R"("})",
      R"({"op":"pause","id":")" + lengthy + R"("})",
      R"({"op":"pick","origin":{")" + lengthy + R"(":1}})",
      R"({")" + lengthy + R"(":1,")" + lengthy + R"(":1})",
      R"({"t":1e)" + std::string(60000, '9') + "}",
  };
  for (const std::string& text : texts) {
    const Result<Request> request = parse_request(text);
    REQUIRE_FALSE(request.has_value());
    const std::string error = encode_error(request.error());
    CHECK(error.size() < 1500);
    CHECK(json::accept(error));
  }
}

TEST_CASE("The id of a message that is not read is the one that reading it gives") {
  for (const json& golden : read_golden_json("accepted_commands.json")) {
    std::string text = golden["text"];
    INFO(text);
    CHECK(find_id(text) == parse_request(text)->id);
    // And where it is too large to be read.
    text.insert(text.find('{') + 1,
                R"("padding":")" + std::string(kMostMessageBytes, 'x') + R"(",)");
    const Result<Request> refused = parse_request(text);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::too_large);
    CHECK(refused.error().id == find_id(golden["text"].get<std::string>()));
  }
}

TEST_CASE("Only an object that ends with the text and has one id of its own has an id") {
  const auto with_five = [](const std::string& text) { return find_id(text) == Id(5); };
  for (const char* text : {R"({"id":5})", R"( { "a" : [ 1, "}" , {"id":6} ] , "id" : 5 } )",
                           R"({"a":"\"id\":7,","id":5})", R"({"id":5,"a":"\\"})",
                           R"({"a":{"id":1},"id":5,"b":{"id":2}})", R"({"ids":1,"id":5e0})"}) {
    INFO(text);
    CHECK(with_five(text));
  }
  for (const char* text : {"",
                           " ",
                           "5",
                           R"("id")",
                           "nonsense",
                           R"(["id",5])",
                           R"({"id":5)",
                           R"({"id":5}})",
                           R"({"id":5} {})",
                           R"({"id":5,"id":5})",
                           R"({"id":})",
                           R"({"id")",
                           R"({"id":5,"a":"\"})",

                           R"({"id":-5})",
                           R"({"id":5.5})",
                           R"({"id":[5]})",
                           R"({"id":""})",
                           R"({"id":1e999})",
                           R"({"id":nonsense})",
                           R"({id:5})",
                           R"([{"id":5}])",
                           R"({"a":{"id":5}})"}) {
    INFO(text);
    CHECK_FALSE(find_id(text));
  }
  for (const std::string piece : {"[", "{", "\"", "\\", "{\"a\":", "{\"id\":", ",", "]", "}"}) {
    std::string text;
    while (text.size() < 4 * kMostMessageBytes) text += piece;
    CHECK_FALSE(find_id(text));
    CHECK_FALSE(find_id("{\"id\":" + text));
    CHECK_FALSE(find_id("{\"id\":5,\"a\":" + text));
  }
  CHECK(find_id(R"({"id":")" + std::string(kMostIdBytes, 'i') + R"("})") ==
        Id(std::string(kMostIdBytes, 'i')));
  CHECK_FALSE(find_id(R"({"id":")" + std::string(kMostIdBytes + 1, 'i') + R"("})"));
}

TEST_CASE("A token is never repeated") {
  const std::string secret(300, 's');
  const Result<Request> request = parse_request(R"({"op":"hello","token":")" + secret + R"("})");
  REQUIRE_FALSE(request.has_value());
  CHECK(encode_error(request.error()).find("sss") == std::string::npos);
}

TEST_CASE("No prefix of a command is a command") {
  for (const json& golden : read_golden_json("accepted_commands.json")) {
    std::string text = golden["text"];
    text.erase(text.find_last_of('}') + 1);
    for (std::size_t length = 0; length < text.size(); ++length) {
      INFO(text.substr(0, length));
      CHECK_FALSE(parse_request(std::string_view(text).substr(0, length)).has_value());
    }
  }
}

TEST_CASE("Any change of bytes is read or refused, and what is read can be written") {
  std::mt19937 random(20261121);
  const json goldens = read_golden_json("accepted_commands.json");
  std::size_t read = 0, refused = 0;
  for (int round = 0; round < 200; ++round) {
    for (const json& golden : goldens) {
      std::string text = golden["text"];
      const std::size_t changes = 1 + random() % 3;
      for (std::size_t i = 0; i < changes; ++i)
        text[random() % text.size()] = static_cast<char>(random() % 256);
      const Result<Request> request = parse_request(text);
      if (request) {
        ++read;
        const Result<Request> again = parse_request(encode_request(*request));
        REQUIRE(again.has_value());
        CHECK(*again == *request);
      } else {
        ++refused;
        CHECK(json::accept(encode_error(request.error())));
      }
    }
  }
  CHECK(read > 100);  // both paths were taken
  CHECK(refused > 100);
}
