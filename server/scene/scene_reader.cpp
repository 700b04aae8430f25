#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/world/object_repair.h"
#include "core/world/world.h"
#include "server/scene/scene_file.h"
#include "server/scene/scene_format.h"
#include "server/scene/scene_json.h"

namespace weft::server {
namespace {

using Json = nlohmann::json;

std::vector<std::string> words_of(const FieldInfo& info) {
  std::vector<std::string> words;
  std::string_view rest = info.words;
  while (true) {
    const std::size_t bar = rest.find('|');
    words.emplace_back(rest.substr(0, bar));
    if (bar == std::string_view::npos) return words;
    rest.remove_prefix(bar + 1);
  }
}

bool is_plain(const std::string& text) {
  return !text.starts_with('.') && std::all_of(text.begin(), text.end(), [](char x) {
    return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'z') || (x >= 'A' && x <= 'Z') || x == '.' ||
           x == '_' || x == '-';
  });
}

/// Whether a text is "#rrggbb".
bool is_color(const std::string& text) {
  return text.size() == 7 && text[0] == '#' &&
         std::all_of(text.begin() + 1, text.end(),
                     [](unsigned char x) { return std::isxdigit(x) != 0; });
}

/// Number of UTF-8 characters, as the schema counts them.
std::size_t length_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char x) { return (x & 0xC0) != 0x80; }));
}

/// Reads one object. Throws the first error.
class Reader {
 public:
  Reader(const Json& node, std::string path, const MeshSource& meshes)
      : node_(node), path_(std::move(path)), meshes_(meshes) {
    if (!node_.is_object()) throw wrong(path_, node_, "an object {...}");
  }

  template <class Walk>
  void fields(Walk&& walk) {
    walk([this](const FieldInfo& info, auto& value) {
      if (const Json* node = find(info.name)) read(info, *node, value);
    });
  }

  void text(const TextInfo& info, std::string& value) {
    const Json* node = info.required ? &require(info.name) : find(info.name);
    if (!node) return;
    const std::string allowed =
        std::to_string(info.least) + " to " + std::to_string(info.most) + " characters" +
        (info.plain ? " of a-z A-Z 0-9 . _ -, not beginning with a dot" : "") +
        (info.color ? ", # and six of 0-9 a-f A-F" : "");
    if (!node->is_string()) throw wrong(at(info.name), *node, allowed, info.meaning);
    const std::string given = node->get<std::string>();
    const std::size_t length = length_of(given);
    if (length < info.least || length > info.most || (info.plain && !is_plain(given)) ||
        (info.color && !is_color(given)))
      throw wrong(at(info.name), *node, allowed, info.meaning);
    value = given;
  }

  void orientation(const char* name, const char* meaning, Eigen::Quaterniond& value) {
    const Json* node = find(name);
    if (!node) return;
    std::array<double, 4> q;
    read_numbers({name, -1, 1, "", meaning}, *node, q);
    value = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
    if (!(std::abs(value.norm() - 1) < 1e-3))
      throw wrong(at(name), *node, "a unit quaternion [x, y, z, w]", "its norm must be 1");
  }

  bool preset(FabricDef& fabric) {
    const Json* node = find("preset");
    if (!node) return false;
    std::vector<std::string> names;
    for (const FabricPreset& preset : fabric_presets()) names.emplace_back(preset.name);
    fabric = fabric_presets()[word("preset", *node, names)].fabric;
    return false;
  }

  void bending_lengths(FabricDef& fabric) {
    for (const BendingLength& length : kBendingLengths) {
      const Json* node = find(length.info.name);
      if (!node) continue;
      if (node_.contains(length.instead_of))
        throw wrong(at(length.info.name), *node, std::string("none beside ") + length.instead_of,
                    "each tells the rigidity");
      double value = 0;
      read(length.info, *node, value);
      fabric.*length.rigidity = bending_rigidity(fabric.areal_density, value);
    }
  }

  template <class Describe>
  void object(const char* name, const char*, Describe&& describe) {
    const Json* node = find(name);
    if (node && node->is_string() && std::string_view(name) == "mesh")
      throw wrong(at(name), *node, "an object {...}", R"({"source": )" + shown_json(*node) + "}");
    static const Json empty = Json::object();
    Reader inner(node ? *node : empty, at(name), meshes_);
    describe(inner);
    inner.finish();
  }

  template <class Value, class Describe>
  void optional(const char* name, const char*, std::optional<Value>& value, Describe&& describe) {
    const Json* node = find(name);
    if (!node) return;
    value.emplace();
    Reader inner(*node, at(name), meshes_);
    describe(inner, *value);
    inner.finish();
  }

  template <class Value, class Describe>
  void list(const ListInfo& info, std::vector<Value>& values, Describe&& describe) {
    const Json* node = find(info.name);
    if (!node) {
      if (values.size() < info.least) throw missing(info.name);
      return;
    }
    const std::string allowed =
        "a list of " + std::to_string(info.least) + " to " + std::to_string(info.most) + " objects";
    if (!node->is_array()) throw wrong(at(info.name), *node, allowed, info.meaning);
    if (node->size() < info.least || node->size() > info.most)
      throw DefinitionError(at(info.name), "a list of " + std::to_string(node->size()), allowed,
                            info.meaning);
    values.clear();
    for (std::size_t k = 0; k < node->size(); ++k) {
      Reader inner((*node)[k], at(info.name) + "[" + std::to_string(k) + "]", meshes_);
      values.emplace_back();
      describe(inner, values.back());
      inner.finish();
    }
  }

  template <class Describe>
  void tagged(const TagInfo& info, int, Describe&& describe) {
    const Json* node = info.required ? &require(info.choice.name) : find(info.choice.name);
    const std::size_t index = node ? word(info.choice.name, *node, words_of(info.choice)) : 0;
    describe(*this, static_cast<int>(index));
  }

  template <class Take>
  void mesh(const MeshPlacement& placement, Take&& take) {
    try {
      take(meshes_(placement.source));
    } catch (const DefinitionError& error) {
      throw error.renamed(at("source"));
    }
  }

  /// Refuses unknown keys.
  void finish() const {
    for (const auto& [key, value] : node_.items()) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      std::string all;
      for (const std::string& name : known_) all += (all.empty() ? "" : ", ") + name;
      const std::string nearest = nearest_word(key, known_);
      throw DefinitionError(at(key), shown_json(value), "no key but " + all,
                            nearest.empty() ? "" : "did you mean " + nearest + "?");
    }
  }

 private:
  std::string at(const std::string& name) const {
    return path_.empty() ? name : path_ + "." + name;
  }

  const Json* find(const char* name) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.emplace_back(name);
    const auto found = node_.find(name);
    return found == node_.end() ? nullptr : &*found;
  }

  const Json& require(const char* name) {
    const Json* node = find(name);
    if (!node) throw missing(name);
    return *node;
  }

  DefinitionError missing(const char* name) const {
    return {at(name), "missing", "a value", "this key is needed here"};
  }

  static DefinitionError wrong(const std::string& path, const Json& node,
                               const std::string& allowed, const std::string& hint = {}) {
    return {path, shown_json(node), allowed, hint};
  }

  std::size_t word(const char* name, const Json& node,
                   const std::vector<std::string>& words) const {
    std::string all;
    for (const std::string& each : words) all += (all.empty() ? "" : ", ") + each;
    const std::string given = node.is_string() ? node.get<std::string>() : std::string();
    const auto found = std::find(words.begin(), words.end(), given);
    if (found == words.end()) {
      const std::string nearest = nearest_word(given, words);
      throw wrong(at(name), node, "one of " + all,
                  nearest.empty() ? "" : "did you mean " + nearest + "?");
    }
    return static_cast<std::size_t>(found - words.begin());
  }

  double number(const FieldInfo& info, const std::string& path, const Json& node) const {
    if (!node.is_number()) throw wrong(path, node, allowed_values(info), info.meaning);
    const double value = node.get<double>();
    if (!(value >= info.range.minimum && value <= info.range.maximum))
      throw wrong(path, node, allowed_values(info), info.meaning);
    return value;
  }

  void read(const FieldInfo& info, const Json& node, double& value) const {
    value = number(info, at(info.name), node);
  }
  void read(const FieldInfo& info, const Json& node, int& value) const {
    const double given = number(info, at(info.name), node);
    if (given != std::floor(given))
      throw wrong(at(info.name), node, "a whole number, " + allowed_values(info), info.meaning);
    value = static_cast<int>(given);
  }
  void read(const FieldInfo& info, const Json& node, bool& value) const {
    if (!node.is_boolean()) throw wrong(at(info.name), node, "true or false", info.meaning);
    value = node.get<bool>();
  }
  void read(const FieldInfo& info, const Json& node, Vec3d& value) const {
    std::array<double, 3> numbers;
    read_numbers(info, node, numbers);
    value = Vec3d(numbers[0], numbers[1], numbers[2]);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void read(const FieldInfo& info, const Json& node, Enum& value) const {
    value = static_cast<Enum>(word(info.name, node, words_of(info)));
  }

  template <std::size_t N>
  void read_numbers(const FieldInfo& info, const Json& node, std::array<double, N>& values) const {
    if (!node.is_array() || node.size() != N)
      throw wrong(at(info.name), node, "a list of " + std::to_string(N) + " numbers", info.meaning);
    for (std::size_t k = 0; k < N; ++k)
      values[k] = number(info, at(info.name) + "[" + std::to_string(k) + "]", node[k]);
  }

  const Json& node_;
  std::string path_;
  const MeshSource& meshes_;
  std::vector<std::string> known_;
};

/// Path in the file of a field that the physics refused.
std::string file_path(const std::string& field) {
  if (field.starts_with("cloth.")) return "cloths[0]." + field.substr(6);
  if (field == "fabric" || field.starts_with("fabric.")) return "cloths[0]." + field;
  return field;
}

/// Checks what only the whole scene can show.
void check_whole(const WorldDef& def) {
  check_size(def);  // before slower checks
  try {
    WorldDef repaired = def;  // the world's maker repairs it again, and reports it
    repair_objects(repaired);
    const World<float> world(repaired);
  } catch (const DefinitionError& error) {
    throw error.renamed(file_path(error.field));
  }
}

}  // namespace

WorldDef read_scene(std::string_view text, const MeshSource& meshes) {
  const StrictJson json = read_strict_json(text, kMostSceneBytes);
  if (!json.good)
    throw DefinitionError(
        json.field.empty() ? "scene" : json.field, json.value.empty() ? "this text" : json.value,
        "one JSON object of at most 1 MiB and 8 levels, no key twice", json.reason);
  WorldDef def;
  def.cloths.clear();
  Reader reader(json.root, "", meshes);
  describe_scene(reader, def);
  reader.finish();
  check_whole(def);
  return def;
}

}  // namespace weft::server
