#include "server/scene/scene_schema.h"

#include <cmath>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "server/scene/scene_format.h"

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

Json words_of(const FieldInfo& info) {
  Json words = Json::array();
  std::string rest = info.words;
  for (std::size_t bar = rest.find('|'); bar != rest.npos; bar = rest.find('|')) {
    words.push_back(rest.substr(0, bar));
    rest.erase(0, bar + 1);
  }
  words.push_back(rest);
  return words;
}

/// Whole numbers are written as integers, so that both ends of a range read naturally.
Json bound(double value) {
  constexpr double kExact = 1e15;
  if (value == static_cast<double>(static_cast<std::int64_t>(value)) && std::abs(value) < kExact)
    return static_cast<std::int64_t>(value);
  return value;
}

std::string meaning_of(const FieldInfo& info) {
  std::string text = info.meaning;
  if (*info.unit) text += std::string(" [") + info.unit + "]";
  return text;
}

/// Collects the schema of one object.
class Schema {
 public:
  template <class Walk>
  void fields(Walk&& walk) {
    walk([this](const FieldInfo& info, const auto& value) {
      Json& entry = properties_[info.name];
      entry["description"] = meaning_of(info);
      add_type(entry, info, value);
    });
  }
  void text(const TextInfo& info, const std::string& value) {
    Json& entry = properties_[info.name];
    entry = {{"description", info.meaning},
             {"type", "string"},
             {"minLength", info.least},
             {"maxLength", info.most}};
    if (info.plain) entry["pattern"] = "^[A-Za-z0-9_-][A-Za-z0-9._-]*$";
    if (info.color) entry["pattern"] = "^#[0-9a-fA-F]{6}$";
    if (!value.empty() && !info.required) entry["default"] = value;
    if (info.required) required_.push_back(info.name);
  }
  void orientation(const char* name, const char* meaning, const Eigen::Quaterniond&) {
    properties_[name] = {{"description", std::string(meaning) + ": unit quaternion [x, y, z, w]"},
                         {"type", "array"},
                         {"items", {{"type", "number"}, {"minimum", -1}, {"maximum", 1}}},
                         {"minItems", 4},
                         {"maxItems", 4},
                         {"default", {0, 0, 0, 1}}};
  }
  bool preset(const FabricDef&) {
    Json names = Json::array();
    for (const FabricPreset& each : fabric_presets()) names.push_back(each.name);
    properties_["preset"] = {{"description", "values to start from; others override them"},
                             {"enum", names}};
    return false;
  }
  void bending_lengths(const FabricDef&) {
    for (const BendingLength& length : kBendingLengths) {
      properties_[length.info.name] = {{"description", meaning_of(length.info)},
                                       {"type", "number"},
                                       {"minimum", bound(length.info.range.minimum)},
                                       {"maximum", bound(length.info.range.maximum)}};
      exclusive_[length.info.name] = {{"not", {{"required", Json::array({length.instead_of})}}}};
    }
  }
  template <class Describe>
  void object(const char* name, const char* meaning, Describe&& describe) {
    Schema inner;
    describe(inner);
    properties_[name] = inner.take(meaning);
    if (!inner.required_.empty()) required_.push_back(name);
  }
  template <class Value, class Describe>
  void optional(const char* name, const char* meaning, std::optional<Value>&, Describe&& describe) {
    Schema inner;
    Value value{};
    describe(inner, value);
    properties_[name] = inner.take(meaning);
  }
  template <class Value, class Describe>
  void list(const ListInfo& info, std::vector<Value>&, Describe&& describe) {
    Schema inner;
    Value value{};
    describe(inner, value);
    properties_[info.name] = {{"description", info.meaning},
                              {"type", "array"},
                              {"minItems", info.least},
                              {"maxItems", info.most},
                              {"items", inner.take({})}};
    if (info.least > 0) required_.push_back(info.name);
  }
  template <class Describe>
  void tagged(const TagInfo& info, int, Describe&& describe) {
    const Json words = words_of(info.choice);
    const char* tag = info.choice.name;
    for (std::size_t k = 0; k < words.size(); ++k) {
      Schema one = *this;
      one.alternatives_ = Json::array();
      one.properties_[tag] = Json::object();
      describe(one, static_cast<int>(k));
      Json condition = {{"properties", {{tag, {{"const", words[k]}}}}}};
      if (info.required || k > 0) condition["required"] = Json::array({tag});
      alternatives_.push_back({{"if", condition}, {"then", one.take({})}});
    }
    tag_ = {{tag, {{"description", info.choice.meaning}, {"enum", words}}}};
    if (!info.required) tag_[tag]["default"] = words[0];
    if (info.required) required_ = Json::array({tag});
  }
  template <class Take>
  void mesh(const MeshPlacement&, Take&&) {}

  Json take(const std::string& meaning) {
    Json out = Json::object();
    if (!meaning.empty()) out["description"] = meaning;
    out["type"] = "object";
    if (!required_.empty()) out["required"] = required_;
    if (!alternatives_.empty()) {
      out["properties"] = tag_;
      out["allOf"] = alternatives_;
      return out;
    }
    out["properties"] = properties_;
    if (!exclusive_.empty()) out["dependencies"] = exclusive_;
    out["additionalProperties"] = false;
    return out;
  }

 private:
  template <class Value>
  static void add_type(Json& entry, const FieldInfo& info, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      entry["type"] = "boolean";
      entry["default"] = value;
    } else if constexpr (std::is_enum_v<Value>) {
      entry["enum"] = words_of(info);
      entry["default"] = choice_word(info, static_cast<int>(value));
    } else if constexpr (std::is_same_v<Value, Vec3d>) {
      entry["type"] = "array";
      entry["items"] = {{"type", "number"},
                        {"minimum", bound(info.range.minimum)},
                        {"maximum", bound(info.range.maximum)}};
      entry["minItems"] = entry["maxItems"] = 3;
      entry["default"] = {bound(value[0]), bound(value[1]), bound(value[2])};
    } else {
      entry["type"] = std::is_same_v<Value, double> ? "number" : "integer";
      entry["minimum"] = bound(info.range.minimum);
      entry["maximum"] = bound(info.range.maximum);
      entry["default"] = bound(static_cast<double>(value));
    }
  }

  Json properties_ = Json::object(), required_ = Json::array(), alternatives_ = Json::array(),
       tag_ = Json::object(), exclusive_ = Json::object();
};

}  // namespace

std::string scene_schema() {
  Schema schema;
  WorldDef def;
  describe_scene(schema, def);
  Json out = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "A scene of Weft"}};
  out.update(
      schema.take("Cloths, what they meet and what holds them. Units are SI, y is up; values "
                  "left out have their defaults"));
  return out.dump(2) + "\n";
}

}  // namespace weft::server
