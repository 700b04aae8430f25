#pragma once

#include <concepts>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/field.h"
#include "proto/messages/command_writer.h"
#include "proto/types.h"

// The walker that tells what a message consists of, as JSON, for the generator of declarations,
// clients and tables (proto/generate.py).

namespace weft::proto {

class Document {
 public:
  using Json = nlohmann::ordered_json;

  /// @param fields  an array that each field is added to
  explicit Document(Json& fields) : fields_(fields) {}

  template <class Value>
  void required(const Field& field, const Value& value) {
    add(field, value)["required"] = true;
  }
  template <class Value>
  void nullable(const Field& field, const std::optional<Value>& value) {
    Json& entry = add(field, value);
    entry["required"] = entry["nullable"] = true;
  }
  template <class Value>
  void optional(const Field& field, const Value& value) {
    add(field, value)["default"] = CommandWriter::json_of(value);
  }
  template <class Value>
  void optional(const Field& field, const std::optional<Value>& value) {
    add(field, value);
  }
  void hash(const Field& field, std::uint64_t) { add(field, std::string())["required"] = true; }
  void flag(const Field& field, bool value, bool usual) { add(field, value)["default"] = usual; }
  template <class Value>
  void only_if(bool, const char* of, const Field& field, const Value& value, bool) {
    add(field, value)["only_for"] = of;
  }
  void constant(const char* name, const char* what) { add_constant(name, what); }
  void constant(const char* name, bool what) {
    if (what) add_constant(name, what);
  }
  void usual(double, double) {}
  void hold(const Hold&) {
    for (const Field& field : {kHeldParticle, kHeldTriangle}) add(field, std::uint32_t{});
    add(kHeldWeights, Vec3{});
  }
  void scene(const Field& field, const std::string&, const std::string&) {
    Json& entry = add(field, std::string());
    entry["type"] = "name_or_object";
    entry["required"] = true;
  }
  void excludes(const char*, std::initializer_list<const char*>) {}
  void one_at_least(const char*) {}
  template <class Code>
  void rule(bool, Code, const char*, const char*) {}

 private:
  template <class Value>
  static Json type_of(const Value& value) {
    if constexpr (std::same_as<Value, bool>)
      return "boolean";
    else if constexpr (std::same_as<Value, Vec3>)
      return "vector";
    else if constexpr (std::same_as<Value, Quat>)
      return "rotation";
    else if constexpr (std::same_as<Value, ColliderRef>)
      return "name_or_place";
    else if constexpr (std::same_as<Value, std::string>)
      return "string";
    else if constexpr (std::floating_point<Value>)
      return "number";
    else if constexpr (std::integral<Value>)
      return "integer";
    else if constexpr (Worded<Value>)
      return {{"words", kWords<Value>}};
    else
      return object_type(value);
  }
  template <class Value>
  static Json type_of(const std::optional<Value>&) {
    return type_of(Value{});
  }
  template <class Element>
  static Json type_of(const std::vector<Element>&) {
    return {{"list", type_of(Element{})}};
  }
  template <Described Value>
  static Json object_type(const Value& value) {
    Json fields = Json::array();
    Document inner(fields);
    Value::describe(inner, value);
    return {{"object", Value::kName}, {"fields", std::move(fields)}};
  }

  template <class Value>
  Json& add(const Field& field, const Value& value) {
    Json& entry = fields_.emplace_back(Json{{"name", field.name}, {"meaning", field.meaning}});
    entry["type"] = type_of(value);
    if (*field.unit != '\0') entry["unit"] = field.unit;
    if (field.range.maximum > field.range.minimum)
      entry["range"] = {field.range.minimum, field.range.maximum};
    return entry;
  }
  void add_constant(const char* name, Json what) {
    fields_.push_back({{"name", name}, {"constant", std::move(what)}, {"required", true}});
  }

  Json& fields_;
};

}  // namespace weft::proto
