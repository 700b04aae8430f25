#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/field.h"
#include "proto/hash_text.h"
#include "proto/messages/hold_commands.h"

// The walker that writes a command as JSON. Included only by the encoders.

namespace weft::proto {

class CommandWriter {
 public:
  using Json = nlohmann::ordered_json;

  /// Adds the fields to an object, behind those that it has.
  explicit CommandWriter(Json& out) : out_(out) {}

  template <class Value>
  void required(const Field& field, const Value& value) {
    put(field, value);
  }
  template <class Value>
  void optional(const Field& field, const Value& value) {
    put(field, value);
  }
  template <class Value>
  void nullable(const Field& field, const std::optional<Value>& value) {
    out_[field.name] = value ? json_of(*value) : Json();
  }
  void hash(const Field& field, std::uint64_t value) { out_[field.name] = hash_text(value); }
  void flag(const Field& field, bool value, bool usual) {
    if (value != usual) put(field, value);
  }
  template <class Value>
  void only_if(bool condition, const char*, const Field& field, const Value& value, bool) {
    if (condition) put(field, value);
  }
  void constant(const char* name, const char* what) { out_[name] = what; }
  void constant(const char* name, bool what) {
    if (what) out_[name] = true;
  }
  void usual(double, double) {}
  void hold(const Hold& value) {
    if (const auto* point = std::get_if<SurfacePoint>(&value)) {
      put(kHeldTriangle, point->triangle);
      put(kHeldWeights, point->barycentric);
    } else {
      put(kHeldParticle, std::get<Particle>(value).index);
    }
  }
  void scene(const Field& field, const std::string& name, const std::string& text) {
    out_[field.name] = text.empty() ? Json(name) : Json::parse(text);
  }
  void excludes(const char* name, std::initializer_list<const char*> others) {
    for (const char* other : others) excluded_.push_back({name, other});
  }
  void one_at_least(const char*) {}
  template <class Code>
  void rule(bool, Code, const char*, const char*) {}

  /// The value as JSON: of a described struct, an object of its fields.
  template <class Value>
  static Json json_of(const Value& value) {
    if constexpr (Described<Value>) {
      Json object = Json::object();
      CommandWriter inner(object);
      Value::describe(inner, value);
      return object;
    } else if constexpr (Worded<Value>) {
      return name_of(value);
    } else {
      return value;
    }
  }
  template <class Element>
  static Json json_of(const std::vector<Element>& list) {
    Json array = Json::array();
    for (const Element& element : list) array.push_back(json_of(element));
    return array;
  }
  template <class... Values>
  static Json json_of(const std::variant<Values...>& value) {
    return std::visit([](const auto& present) { return json_of(present); }, value);
  }

 private:
  struct Exclusion {
    std::string by, other;  ///< `other` is left out if `by` is there
  };

  template <class Value>
  void put(const Field& field, const std::optional<Value>& value) {
    if (value) put(field, *value);
  }
  template <class Value>
  void put(const Field& field, const Value& value) {
    for (const Exclusion& exclusion : excluded_)
      if (exclusion.other == field.name && out_.contains(exclusion.by)) return;
    out_[field.name] = json_of(value);
  }

  Json& out_;
  std::vector<Exclusion> excluded_;
};

}  // namespace weft::proto
