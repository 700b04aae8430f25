#include "server/translate/translate_settings.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/cloth/fabric_presets.h"

namespace weft::server {
namespace {

/// A walker of proto::FabricChange that sets the fields of the same names in core's definition.
class FabricSetter {
 public:
  explicit FabricSetter(FabricDef& fabric) {
    visit_fields_of_fabric(
        fabric, [this](const FieldInfo& info, double& value) { values_[info.name] = &value; });
  }
  void optional(const proto::Field&, const std::optional<std::string>&) {}  // of the preset
  void optional(const proto::Field& field, const std::optional<double>& value) {
    if (value) *values_.at(field.name) = *value;
  }
  void one_at_least(const char*) {}

 private:
  std::map<std::string_view, double*> values_;
};

/// The other way.
class FabricTeller {
 public:
  explicit FabricTeller(const FabricDef& fabric) : fabric_(fabric) {
    visit_fields_of_fabric(
        fabric, [this](const FieldInfo& info, double value) { values_[info.name] = value; });
  }
  void optional(const proto::Field&, std::optional<std::string>& preset) {
    if (!fabric_.preset.empty()) preset = fabric_.preset;
  }
  void optional(const proto::Field& field, std::optional<double>& value) {
    value = values_.at(field.name);
  }
  void one_at_least(const char*) {}

 private:
  const FabricDef& fabric_;
  std::map<std::string_view, double> values_;
};

/// Another one that reads what was sent.
class FabricSent {
 public:
  void optional(const proto::Field& field, const std::optional<std::string>& value) {
    if (value) preset_ = {field.name, proto::quoted_value(*value)};
  }
  void optional(const proto::Field& field, const std::optional<double>& value) {
    known_.insert(field.name);
    if (value) sent_[field.name] = proto::number_text(*value);
  }
  void one_at_least(const char*) {}

  bool knows(const std::string& name) const { return known_.contains(name); }

  /// Name and value of the one that is at fault; empty if that is not clear.
  /// @param names  those that may be, from the one that is most likely
  std::pair<std::string, std::string> blamed(const std::vector<std::string>& names) const {
    for (const std::string& name : names)
      if (const auto found = sent_.find(name); found != sent_.end()) return *found;
    if (!preset_.first.empty()) return preset_;
    if (sent_.size() == 1) return *sent_.begin();
    return {};
  }

 private:
  std::set<std::string> known_;
  std::map<std::string, std::string> sent_;  ///< as JSON, by name
  std::pair<std::string, std::string> preset_;
};

std::vector<proto::FabricChange> fabrics_of(const std::vector<ClothDef>& cloths) {
  std::vector<proto::FabricChange> fabrics;
  for (const ClothDef& cloth : cloths) {
    FabricTeller teller(cloth.fabric);
    proto::FabricChange::describe(teller, fabrics.emplace_back());
  }
  return fabrics;
}

/// Names of all cloths' fabrics, without duplicates.
std::string fabric_names(const std::vector<ClothDef>& cloths) {
  std::vector<std::string> names;
  std::string text;
  for (const ClothDef& cloth : cloths) {
    const std::string name = fabric_name(cloth.fabric);
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

proto::Result<FabricDef> preset_named(const std::string& name) {
  std::vector<std::string> names;
  for (const FabricPreset& preset : fabric_presets()) names.emplace_back(preset.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    return proto::word_error("fabric.preset", name, std::move(names));
  return make_fabric(name);
}

proto::Result<std::size_t> find_cloth(const std::vector<ClothDef>& cloths,
                                      const proto::ColliderRef& wanted) {
  if (const auto* index = std::get_if<std::uint32_t>(&wanted)) {
    if (*index < cloths.size()) return *index;
    return proto::range_error("cloth", *index, {0, static_cast<double>(cloths.size()) - 1});
  }
  const auto& name = std::get<std::string>(wanted);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    if (cloths[k].name == name) return k;
    names.push_back(cloths[k].name);
  }
  return proto::word_error("cloth", name, std::move(names));
}

}  // namespace

EnvironmentDef with_settings(EnvironmentDef environment, const proto::Set& set) {
  if (set.gravity) environment.gravity = from_wire(*set.gravity);
  if (set.wind) environment.wind = from_wire(*set.wind);
  if (set.gust_speed) environment.gust_speed = *set.gust_speed;
  if (set.gust_length) environment.gust_length = *set.gust_length;
  if (set.air_density) environment.air_density = *set.air_density;
  if (set.still_air) environment.still_air = *set.still_air;
  if (set.drag) environment.damping = *set.drag;
  if (set.fans) {
    environment.fans.clear();
    for (const proto::Fan& f : *set.fans)
      environment.fans.push_back(
          {from_wire(f.position), from_wire(f.direction), f.speed, f.radius, f.spread, f.reach});
  }
  return environment;
}

BudgetDef with_settings(BudgetDef budget, const proto::Set& set) {
  if (set.budget_ms) budget.milliseconds = *set.budget_ms;
  if (set.over_budget)
    budget.remedy =
        *set.over_budget == proto::OverBudget::soften ? OverBudget::soften : OverBudget::slow;
  return budget;
}

proto::OverBudget to_wire(OverBudget remedy) {
  return remedy == OverBudget::soften ? proto::OverBudget::soften : proto::OverBudget::slow;
}

proto::Result<std::optional<FabricWanted>> fabric_wanted(const ServedWorld& world,
                                                         const proto::Set& set) {
  if (!set.fabric) return std::optional<FabricWanted>();
  const std::vector<ClothDef>& cloths = world.def().cloths;
  const auto cloth = find_cloth(cloths, set.cloth.value_or(std::uint32_t{0}));
  if (!cloth) return cloth.error();
  FabricDef fabric = cloths[*cloth].fabric;
  if (set.fabric->preset) {
    proto::Result<FabricDef> preset = preset_named(*set.fabric->preset);
    if (!preset) return preset.error();
    fabric = *std::move(preset);
  }
  FabricSetter setter(fabric);
  proto::FabricChange::describe(setter, *set.fabric);
  return std::optional(FabricWanted{*cloth, std::move(fabric)});
}

proto::Error refused_fabric(const DefinitionError& error, const proto::Set& set) {
  FabricSent sent;
  proto::FabricChange::describe(sent, *set.fabric);
  const std::string name = error.field.substr(error.field.rfind('.') + 1);
  std::vector<std::string> names = {name};
  names.insert(names.end(), error.causes.begin(), error.causes.end());
  const auto [blamed, value] = sent.blamed(names);
  proto::Error out = to_wire(error);
  out.field = blamed.empty() ? "fabric" : "fabric." + blamed;
  out.value = value;
  if (blamed == name) {
    out.message = DefinitionError(out.field, value, error.limit, error.hint).what();
    return out;
  }
  out.limit.reset();  // is another field's
  out.message = out.field + (value.empty() ? "" : " = " + value) + ": ";
  if (sent.knows(name)) {
    out.message += "fabric." + name + " = ";
    out.hint = "change " + out.field + " less, or send a fabric." + name +
               " that is allowed beside it; " + error.hint;
  }
  out.message += error.value + "; allowed is " + error.limit + " (" + out.hint + ")";
  return out;
}

proto::Error refused_softness(const DefinitionError& error, const proto::Set& set) {
  // Another fabric or budget takes back what the last budget has softened.
  return to_wire(error.renamed(set.softness    ? "softness"
                               : set.fabric    ? "fabric"
                               : set.budget_ms ? "budget_ms"
                                               : "over_budget"));
}

proto::Error refused_environment(const DefinitionError& error, const proto::Set& set) {
  proto::Error out = to_wire(error);
  const std::string group = "environment.";
  if (error.field.starts_with(group)) {
    out.field = error.field.substr(group.size());
    return out;
  }
  // The air costs too much. Of what was sent, what weighs most is named.
  out.field = set.wind          ? "wind"
              : set.fans        ? "fans"
              : set.gust_speed  ? "gust_speed"
              : set.air_density ? "air_density"
                                : "softness";
  out.value.clear();
  out.message = out.field + ": allowed is " + error.limit + " (" + error.hint + ")";
  return out;
}

void tell_settings(const ServedWorld& world, proto::State& state) {
  const EnvironmentDef& environment = world.environment();
  state.gravity = to_wire(environment.gravity);
  state.air.wind = to_wire(environment.wind);
  state.air.gust_speed = environment.gust_speed;
  state.air.gust_length = environment.gust_length;
  state.air.density = environment.air_density;
  state.air.still = environment.still_air;
  state.air.drag = environment.damping;
  for (const FanDef& f : environment.fans)
    state.air.fans.push_back(
        {to_wire(f.position), to_wire(f.direction), f.speed, f.radius, f.spread, f.reach});
  state.fabric = fabric_names(world.def().cloths);
  state.fabrics = fabrics_of(world.def().cloths);
}

}  // namespace weft::server
