#include "tests/fuzz/script_draw.h"

#include <iterator>
#include <utility>
#include <variant>

#include "proto/messages/commands.h"
#include "tests/fuzz/command_draw.h"
#include "tests/fuzz/scene_draw.h"

namespace weft::fuzz {
namespace {

constexpr double kTicks = 0.4, kLoad = 0.02, kComing = 0.03;  // of a step; else it is a command
constexpr double kFails = 0.3;   // of a load: its scene cannot be built
constexpr double kWithin = 0.3;  // of a command: it comes while a tick runs
constexpr int kMostStop = 40;    // stop points of a tick by which it comes
constexpr proto::ViewerId kViewers = 3;

/// An id of its own: mostly a number, sometimes text.
proto::Id id_of(Dice dice, std::size_t step) {
  const auto number = static_cast<std::int64_t>(step);
  if (dice.chance(0.8)) return number;
  return "step " + std::to_string(number);
}

/// A legal scene that is refused before, while or after it is built.
std::string failing_scene(Dice dice) {
  static const char* const scenes[] = {
      R"({"cloths":[{"rows":600,"columns":600}]})",
      R"({"cloths":[{"rows":90,"columns":90}],"solver":{"min_substeps":20000}})",
      R"({"cloths":[{"rows":40,"columns":40,"width":0.01,"height":0.01,
          "fabric":{"stretch_warp":10000,"stretch_weft":10000}}],"tick_rate":1})",
      R"({"cloths":[{"rows":5,"columns":5}],"pins":[{"place":"particle","particle":25}]})"};
  return scenes[dice.below(std::size(scenes))];
}

/// Comes while a tick runs, now and then.
void place_within(Dice dice, const ScriptSize& size, Step& step) {
  if (size.within && dice.chance(kWithin)) step.within = static_cast<int>(dice.below(kMostStop));
}

Step command_step(const Dice& dice, std::size_t number, const ScriptSize& size, RoomFacts& facts) {
  Step step;
  step.kind = Step::Kind::say;
  step.viewer = 1 + static_cast<proto::ViewerId>(dice.of("viewer").below(kViewers));
  proto::Request request;
  request.id = id_of(dice.of("id"), number);
  if (dice.of("load").chance(kLoad * kFails)) {
    proto::Load load;
    load.definition = failing_scene(dice.of("failing"));
    request.command = std::move(load);
  } else if (dice.of("load").chance(kLoad)) {
    proto::Load load;
    load.definition = draw_scene(dice.of("scene"), size.most_side, facts.scene);
    request.command = std::move(load);
    facts.pins_made = 0;
  } else {
    request.command = draw_command(dice.of("command"), facts);
    if (std::holds_alternative<proto::Pin>(request.command)) ++facts.pins_made;
  }
  step.text = proto::encode_request(request);
  place_within(dice.of("within"), size, step);
  return step;
}

}  // namespace

Script draw_script(const Dice& dice, const ScriptSize& size) {
  Script script;
  RoomFacts facts;
  facts.most_viewers = kViewers;
  script.scene = draw_scene(dice.of("first"), size.most_side, facts.scene);
  const auto count =
      static_cast<std::size_t>(dice.of("steps").between(size.most_steps / 3, size.most_steps));
  for (proto::ViewerId viewer = 1; viewer <= kViewers; ++viewer)
    script.steps.push_back({Step::Kind::join, viewer, 0, {}});
  for (std::size_t k = 0; k < count; ++k) {
    const Dice place = dice.of(k);
    Dice kind = place.of("kind");
    if (k == 0 || kind.chance(kTicks)) {
      script.steps.push_back({Step::Kind::ticks, 0, kind.between(1, size.most_ticks), {}});
    } else if (kind.chance(kComing)) {
      const auto viewer = 1 + static_cast<proto::ViewerId>(kind.below(kViewers));
      Step leave{Step::Kind::leave, viewer, 0, {}};
      place_within(place.of("within"), size, leave);
      Step join = leave;
      join.kind = Step::Kind::join;
      script.steps.push_back(std::move(leave));
      script.steps.push_back(std::move(join));
    } else {
      script.steps.push_back(command_step(place, k, size, facts));
    }
  }
  script.steps.push_back({Step::Kind::ticks, 0, size.most_ticks, {}});
  return script;
}

}  // namespace weft::fuzz
