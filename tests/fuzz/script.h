#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/types.h"

namespace weft::fuzz {

/// One thing that happens to a room.
struct Step {
  enum class Kind { ticks, join, leave, say };
  Kind kind = Kind::ticks;
  proto::ViewerId viewer = 1;
  int ticks = 0;
  std::string text;  ///< of a command, as it arrives
  int within = -1;   ///< stop point of the coming tick at which it happens; -1: before that tick
};

/// A scene and what is done to it: all that a run depends on. As JSON it is one array: the scene,
/// and then numbers (so many ticks) and [viewer, what], where what is "join", "leave" or a command;
/// or [viewer, what, within].
struct Script {
  std::string scene;  ///< JSON text
  std::vector<Step> steps;
};

inline nlohmann::ordered_json json_of(const Script& script) {
  using Json = nlohmann::ordered_json;
  Json out = Json::array({Json::parse(script.scene)});
  for (const Step& step : script.steps) {
    if (step.kind == Step::Kind::ticks) {
      out.push_back(step.ticks);
      continue;
    }
    const Json what = step.kind == Step::Kind::join    ? Json("join")
                      : step.kind == Step::Kind::leave ? Json("leave")
                                                       : Json::parse(step.text);
    out.push_back(Json::array({step.viewer, what}));
    if (step.within >= 0) out.back().push_back(step.within);
  }
  return out;
}

/// Throws nlohmann's exceptions on what is no script.
inline Script script_of(const nlohmann::ordered_json& json) {
  Script script;
  script.scene = json.at(0).dump();
  for (std::size_t k = 1; k < json.size(); ++k) {
    Step step;
    if (json[k].is_number()) {
      step.ticks = json[k].get<int>();
    } else {
      step.viewer = json[k].at(0).get<proto::ViewerId>();
      const auto& what = json[k].at(1);
      step.kind = what == "join"    ? Step::Kind::join
                  : what == "leave" ? Step::Kind::leave
                                    : Step::Kind::say;
      if (step.kind == Step::Kind::say) step.text = what.dump();
      if (json[k].size() > 2) step.within = json[k][2].get<int>();
    }
    script.steps.push_back(std::move(step));
  }
  return script;
}

}  // namespace weft::fuzz
