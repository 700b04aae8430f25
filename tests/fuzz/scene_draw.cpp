#include "tests/fuzz/scene_draw.h"

#include <map>
#include <optional>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "server/scene/scene_format.h"
#include "tests/fuzz/scene_rules.h"

namespace weft::fuzz {
namespace {

using Json = nlohmann::ordered_json;

/// How one scene is drawn.
struct Taste {
  double told = 0.5;  ///< probability that a field is told at all
  double wild = 0.3;  ///< probability that a number is not near the usual one
  int most_side = 24;
};

/// How many there usually are of a list, and the probability that there are any. A list that is not
/// here has up to three with probability one half.
struct UsualList {
  std::size_t most = 3;
  double some = 0.5;
};

UsualList usual_list(const std::string& name) {
  static const std::map<std::string, UsualList> lists = {
      {"cloths", {4, 1}},     {"colliders", {4, 0.75}}, {"pins", {5, 0.6}},
      {"hands", {12, 0.4}},   {"insults", {2, 0.15}},   {"winds", {3, 0.15}},
      {"grippers", {2, 0.2}}, {"fans", {4, 0.3}},       {"keyframes", {5, 1}},
      {"path", {4, 1}},       {"steps", {4, 0.7}}};
  const auto found = lists.find(name);
  return found == lists.end() ? UsualList{} : found->second;
}

/// Walks the description of the scene format and draws what it tells.
class SceneDraw {
 public:
  SceneDraw(Dice dice, const Taste& taste, SceneFacts& facts, std::string list)
      : dice_(dice), taste_(taste), facts_(facts), list_(std::move(list)) {}

  template <class Walk>
  void fields(Walk&& walk) {
    walk([this](const FieldInfo& info, auto& value) {
      Dice dice = dice_.of(info.name);
      if (dice.chance(is_needed(info) ? 0.95 : taste_.told)) draw(dice, info, value);
    });
  }

  void text(const server::TextInfo& info, const std::string&) {
    Dice dice = dice_.of(info.name);
    const std::string name = info.name;
    if (name == "cloth" && !facts_.cloths.empty()) {
      if (dice.chance(0.8)) json_[name] = facts_.cloths[dice.below(facts_.cloths.size())];
    } else if (name == "name" && !list_.empty()) {
      std::vector<std::string>& names = list_ == "cloths"      ? facts_.cloths
                                        : list_ == "colliders" ? facts_.colliders
                                                               : facts_.grippers;
      names.push_back(list_ + "-" + std::to_string(names.size()));
      json_[name] = names.back();
    } else if (name == "source") {
      constexpr const char* kSources[] = {"gable", "loop", "dress-form"};
      json_[name] = kSources[dice.chance(0.6) ? 0 : 1 + dice.below(2)];
    } else if (info.color) {
      constexpr char kDigits[] = "0123456789abcdefABCDEF";
      std::string color = "#";
      while (color.size() < 7) color += kDigits[dice.below(sizeof kDigits - 1)];
      if (dice.chance(0.5)) json_[name] = color;
    } else if (info.least > 0 || dice.chance(0.2)) {
      json_[name] = std::string(std::max<std::size_t>(info.least, dice.below(info.most)), 'x');
    }
  }

  void orientation(const char* name, const char*, const Eigen::Quaterniond&) {
    Dice dice = dice_.of(name);
    if (dice.chance(0.5)) json_[name] = dice.rotation();
  }

  bool preset(const FabricDef&) {
    Dice dice = dice_.of("preset");
    const auto& presets = fabric_presets();
    if (dice.chance(0.4)) json_["preset"] = presets[dice.below(presets.size())].name;
    return false;
  }

  void bending_lengths(const FabricDef&) {
    for (const server::BendingLength& length : server::kBendingLengths) {
      Dice dice = dice_.of(length.info.name);
      if (json_.contains(length.instead_of) || !dice.chance(0.1 * taste_.told)) continue;
      json_[length.info.name] =
          dice.number(length.info.range.minimum, length.info.range.maximum, 0.02, taste_.wild);
    }
  }

  template <class Describe>
  void object(const char* name, const char*, Describe&& describe) {
    SceneDraw inner(dice_.of(name), taste_, facts_, "");
    describe(inner);
    if (!inner.json_.empty()) json_[name] = std::move(inner.json_);
  }

  template <class Value, class Describe>
  void optional(const char* name, const char*, std::optional<Value>&, Describe&& describe) {
    if (!dice_.of(name).chance(std::string_view(name) == "motion" ? 0.5 : 0.1)) return;
    Value value{};
    SceneDraw inner(dice_.of(name), taste_, facts_, name);
    describe(inner, value);
    json_[name] = std::move(inner.json_);
  }

  template <class Value, class Describe>
  void list(const server::ListInfo& info, std::vector<Value>&, Describe&& describe) {
    Dice dice = dice_.of(info.name);
    const UsualList usual = usual_list(info.name);
    if (info.least == 0 && !dice.chance(usual.some)) return;
    // One more often than many.
    const std::size_t most = 1 + dice.below(std::min(usual.most, info.most));
    const std::size_t count = std::max(info.least, 1 + dice.below(most));
    Json items = Json::array();
    for (std::size_t k = 0; k < count; ++k) {
      Value value{};
      SceneDraw inner(dice.of(k), taste_, facts_, info.name);
      describe(inner, value);
      items.push_back(std::move(inner.json_));
    }
    if (std::string_view(info.name) == "cloths")
      facts_.particles = particles_of({{"cloths", items}});
    json_[info.name] = std::move(items);
  }

  template <class Describe>
  void tagged(const server::TagInfo& info, int, Describe&& describe) {
    Dice dice = dice_.of(info.choice.name);
    const auto words = static_cast<std::size_t>(info.choice.range.maximum) + 1;
    // The first of a choice that need not be told is the usual one.
    const std::size_t index = info.required || dice.chance(0.15) ? dice.below(words) : 0;
    if (info.required || index > 0)
      json_[info.choice.name] = choice_word(info.choice, static_cast<int>(index));
    describe(*this, static_cast<int>(index));
  }

  template <class Take>
  void mesh(const MeshPlacement&, Take&&) {}

  Json take() { return std::move(json_); }

 private:
  /// What an interesting scene nearly always tells.
  static bool is_needed(const FieldInfo& info) {
    const std::string_view name = info.name;
    return name == "rows" || name == "columns" || name == "time" || name == "particle" ||
           name == "offset" || name == "center" || name == "radius";
  }

  double number(Dice& dice, const FieldInfo& info, double usual) const {
    return dice.number(info.range.minimum, info.range.maximum, usual, taste_.wild);
  }

  void draw(Dice& dice, const FieldInfo& info, const double& value) {
    json_[info.name] = number(dice, info, value);
  }
  void draw(Dice& dice, const FieldInfo& info, const int& value) {
    const std::string_view name = info.name;
    double number = std::floor(this->number(dice, info, value));
    if (name == "rows" || name == "columns")
      number = dice.between(2, dice.chance(0.7) ? std::min(9, taste_.most_side) : taste_.most_side);
    if (name == "particle")
      number = static_cast<double>(dice.below(static_cast<std::size_t>(facts_.particles)));
    json_[info.name] = static_cast<int>(std::clamp(number, info.range.minimum, info.range.maximum));
  }
  void draw(Dice& dice, const FieldInfo& info, const bool&) { json_[info.name] = dice.chance(0.5); }
  void draw(Dice& dice, const FieldInfo& info, const Vec3d& value) {
    // Far places are seldom, as nothing meets there.
    const bool is_place = std::string_view(info.unit) == "m" && info.range.minimum < 0;
    const double wild = is_place ? 0.2 * taste_.wild : taste_.wild;
    Json numbers = Json::array();
    for (int axis = 0; axis < 3; ++axis) {
      const double usual = is_place ? 0 : value[axis];
      numbers.push_back(dice.number(info.range.minimum, info.range.maximum, usual, wild));
    }
    json_[info.name] = std::move(numbers);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void draw(Dice& dice, const FieldInfo& info, const Enum&) {
    const auto words = static_cast<std::size_t>(info.range.maximum) + 1;
    json_[info.name] = choice_word(info, static_cast<int>(dice.below(words)));
  }

  Dice dice_;
  const Taste& taste_;
  SceneFacts& facts_;
  std::string list_;  ///< whose element this is
  Json json_ = Json::object();
};

}  // namespace

std::string draw_scene(const Dice& dice, int most_side, SceneFacts& facts) {
  Dice whole = dice.of("taste");
  Taste taste;
  taste.told = std::array{0.05, 0.15, 0.4, 0.8}[whole.below(4)];
  taste.wild = std::array{0.02, 0.1, 0.3, 0.8}[whole.below(4)];
  taste.most_side = most_side;
  facts = {};
  SceneDraw draw(dice.of("scene"), taste, facts, "");
  WorldDef def;
  server::describe_scene(draw, def);
  Json scene = draw.take();
  make_legal(dice.of("rules"), scene);
  facts.pins = scene.contains("pins") ? scene["pins"].size() : 0;
  if (!scene.contains("grippers")) facts.grippers.clear();
  return scene.dump();
}

}  // namespace weft::fuzz
