#include <nlohmann/json.hpp>

#include "core/error.h"
#include "server/scene/scene_file.h"
#include "server/scene/scene_format.h"

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

/// Writes one object with all its values.
class Writer {
 public:
  template <class Walk>
  void fields(Walk&& walk) {
    walk([this](const FieldInfo& info, const auto& value) {
      out_[info.name] = to_json(info, value);
    });
  }
  void text(const TextInfo& info, const std::string& value) {
    if (!value.empty()) out_[info.name] = value;
    if (value.empty() && info.required)
      throw DefinitionError(info.name, "nothing", "a name",
                            "a mesh made by code cannot be written");
  }
  void orientation(const char* name, const char*, const Eigen::Quaterniond& q) {
    out_[name] = {q.x(), q.y(), q.z(), q.w()};
  }
  bool preset(const FabricDef& fabric) {
    const std::string name = fabric_name(fabric);
    for (const FabricPreset& each : fabric_presets()) {
      if (name != each.name) continue;
      out_["preset"] = name;
      return true;
    }
    if (!fabric.preset.empty()) out_["preset"] = fabric.preset;
    return false;  // all values are written too, and override the preset's
  }
  void bending_lengths(const FabricDef&) {}  // the rigidities are written
  template <class Describe>
  void object(const char* name, const char*, Describe&& describe) {
    Writer inner;
    describe(inner);
    out_[name] = std::move(inner.out_);
  }
  template <class Value, class Describe>
  void optional(const char* name, const char*, std::optional<Value>& value, Describe&& describe) {
    if (!value) return;
    object(name, "", [&](Writer& inner) { describe(inner, *value); });
  }
  template <class Value, class Describe>
  void list(const ListInfo& info, std::vector<Value>& values, Describe&& describe) {
    Json list = Json::array();
    for (Value& value : values) {
      Writer inner;
      describe(inner, value);
      list.push_back(std::move(inner.out_));
    }
    out_[info.name] = std::move(list);
  }
  template <class Describe>
  void tagged(const TagInfo& info, int index, Describe&& describe) {
    out_[info.choice.name] = choice_word(info.choice, index);
    describe(*this, index);
  }
  template <class Take>
  void mesh(const MeshPlacement&, Take&&) {}

  Json take() { return std::move(out_); }

 private:
  template <class Value>
  static Json to_json(const FieldInfo& info, const Value& value) {
    if constexpr (std::is_enum_v<Value>)
      return choice_word(info, static_cast<int>(value));
    else if constexpr (std::is_same_v<Value, Vec3d>)
      return {value[0], value[1], value[2]};
    else
      return value;
  }

  Json out_ = Json::object();
};

}  // namespace

std::string write_scene(const WorldDef& def) {
  WorldDef copy = def;  // the shared description takes a mutable scene, but writing changes nothing
  Writer writer;
  describe_scene(writer, copy);
  return writer.take().dump(2) + "\n";
}

}  // namespace weft::server
