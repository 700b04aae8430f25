#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "proto/messages/commands.h"
#include "proto/messages/replies.h"

// What a description says of a command is what its reader does.

using namespace weft::proto;
using nlohmann::json;

namespace {

/// A number of `set`, as the description has it.
struct Number {
  std::string outer, name;  ///< `outer` is the object that it is in, if any
  weft::Range range;
  bool vector = false;

  std::string path() const {
    return (outer.empty() ? name : outer + "." + name) + (vector ? "[1]" : "");
  }
  /// The command that sets it to this value alone.
  std::string command(double value) const {
    json field = {{name, vector ? json{0, value, 0} : json(value)}};
    if (!outer.empty()) field = {{outer, field}};
    field["op"] = "set";
    return field.dump();
  }
};

/// A walker that lists the optional fields of a command, and the numbers among them.
class Lister {
 public:
  std::vector<std::string> names;
  std::vector<Number> numbers;

  explicit Lister(std::string outer = "") : outer_(std::move(outer)) {}

  void optional(const Field& field, std::optional<double>&) { add(field, false); }
  void optional(const Field& field, std::optional<Vec3>&) { add(field, true); }
  template <class Value>
  void optional(const Field& field, std::optional<Value>&) {
    names.emplace_back(field.name);
    if constexpr (Described<Value>) {
      Lister inner(field.name);
      Value value;
      Value::describe(inner, value);
      numbers.insert(numbers.end(), inner.numbers.begin(), inner.numbers.end());
    }
  }
  void one_at_least(const char*) {}
  template <class... Rest>
  void only_if(Rest&&...) {}

 private:
  void add(const Field& field, bool vector) {
    names.emplace_back(field.name);
    numbers.push_back({outer_, field.name, field.range, vector});
  }

  std::string outer_;
};

Lister fields_of_set() {
  Lister lister;
  Set set;
  Set::describe(lister, set);
  return lister;
}

json refusal(const std::string& text) {
  const auto request = parse_request(text);
  REQUIRE_FALSE(request.has_value());
  return json::parse(encode_error(request.error()));
}

}  // namespace

TEST_CASE("a number of set is read up to the ends of its range, and refused by its path beyond") {
  const std::vector<Number> numbers = fields_of_set().numbers;
  REQUIRE(numbers.size() >= 8);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Number& number : numbers) {
    CAPTURE(number.path());
    const weft::Range range = number.range;
    for (const double end : {range.minimum, range.maximum})
      CHECK(parse_request(number.command(end)).has_value());
    for (const double beyond :
         {std::nextafter(range.minimum, -kInfinity), std::nextafter(range.maximum, kInfinity)}) {
      const json error = refusal(number.command(beyond));
      CHECK(error["code"] == "out_of_range");
      CHECK(error["field"] == number.path());
      CHECK(error["limit"] == json{{"minimum", range.minimum}, {"maximum", range.maximum}});
    }
  }
}

TEST_CASE("a set with nothing to set is told all that it could have") {
  const json error = refusal(R"({"op":"set"})");
  CHECK(error["code"] == "missing_field");
  CHECK(error["limit"]["allowed"] == json(fields_of_set().names));
  const json winds = refusal(R"({"op":"set","winds":[1,0,0]})");  // no field of it
  CHECK(winds["code"] == "missing_field");
}
