#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "proto/commands.h"
#include "proto/field_reader.h"
#include "proto/parse_move.h"
#include "proto/strict_json.h"
#include "proto/utf8.h"
#include "proto/words.h"

namespace weft::proto {
namespace {

using nlohmann::json;

void read_direction(FieldReader& in, const char* key, Vec3& value) {
  in.read(key, value, kPositionRange);
  const double largest = std::max({std::abs(value[0]), std::abs(value[1]), std::abs(value[2])});
  if (in.ok() && largest < kLeastDirection)
    in.fail(ErrorCode::out_of_range, key, std::string(key) + " must not be zero");
}

void read_barycentric(FieldReader& in, Vec3& value) {
  in.read("barycentric", value, kWeightRange);
  if (in.ok() && !(std::abs(value[0] + value[1] + value[2] - 1) <= kWeightSumTolerance))
    in.fail(ErrorCode::out_of_range, "barycentric", "barycentric must have the sum 1");
}

Hold read_hold(FieldReader& in) {
  if (in.has("particle") && in.has("triangle")) {
    in.fail(ErrorCode::conflicting_fields, "triangle", "triangle and particle exclude each other",
            "give triangle with barycentric, or particle");
  }
  if (in.has("triangle")) {
    SurfacePoint point;
    in.read("triangle", point.triangle, kIndexRange);
    read_barycentric(in, point.barycentric);
    return point;
  }
  Particle particle;
  in.read("particle", particle.index, kIndexRange);
  return particle;
}

Command read_hello(FieldReader& in) {
  Hello hello;
  in.read_if_there("name", hello.name);
  if (hello.name) {
    const std::size_t characters = character_count(*hello.name);
    if (characters < 1 || characters > kMostNameCharacters)
      in.fail(ErrorCode::wrong_length, "name", "name must have 1 to 32 characters");
    if (has_control_character(*hello.name))
      in.fail(ErrorCode::unknown_value, "name", "name must not have control characters");
  }
  in.read_if_there("color", hello.color);
  if (hello.color) {
    const std::string& c = *hello.color;
    const auto is_hex = [](char x) {
      return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'f') || (x >= 'A' && x <= 'F');
    };
    if (c.size() != 7 || c[0] != '#' || !std::all_of(c.begin() + 1, c.end(), is_hex))
      in.fail(ErrorCode::unknown_value, "color", "color must be # and 6 hexadecimal digits",
              "for instance #e4572e");
  }
  in.read_if_there("token", hello.token);
  if (hello.token && hello.token->size() > kMostTokenBytes) {
    Error error = make_error(ErrorCode::wrong_length, "token must have at most 256 bytes");
    error.field = "token";  // its value is a secret and is not repeated
    in.fail(std::move(error));
  }
  return hello;
}

Command read_pick(FieldReader& in) {
  Pick pick;
  in.read("origin", pick.origin, kPositionRange);
  read_direction(in, "direction", pick.direction);
  return pick;
}

Command read_drag(FieldReader& in) {
  DragPhase phase{};
  std::uint32_t drag = 0;
  in.read("phase", phase, kDragPhaseWords);
  in.read_if_there("drag", drag, kIndexRange);
  if (phase == DragPhase::end) {
    DragEnd end{drag};
    in.read_if_there("fire", end.fire);
    return end;
  }
  if (phase == DragPhase::move) {
    DragMove move{drag, {}};
    in.read("target", move.target, kPositionRange);
    return move;
  }
  DragStart start;
  start.drag = drag;
  start.hold = read_hold(in);
  in.read_if_there("mode", start.mode, kDragModeWords);
  if (start.mode == DragMode::sling) start.stiffness = kSlingStiffness;
  in.read_if_there("target", start.target, kPositionRange);
  in.read_if_there("radius", start.radius, kRadiusRange);
  in.read_if_there("stiffness", start.stiffness, kStiffnessRange);
  in.read_if_there("max_force", start.max_force, kForceRange);
  return start;
}

Command read_pin(FieldReader& in) {
  Pin pin;
  pin.hold = read_hold(in);
  in.read_if_there("radius", pin.radius, kRadiusRange);
  return pin;
}

Command read_release(FieldReader& in) {
  const int given = int{in.has("pin")} + int{in.has("particle")} + int{in.has("all")};
  if (given != 1) {
    in.fail(given == 0 ? ErrorCode::missing_field : ErrorCode::conflicting_fields, "pin",
            "release needs one of pin, particle, all");
  }
  if (in.has("all")) {
    bool all = false;
    in.read("all", all);
    if (in.ok() && !all) in.fail(ErrorCode::unknown_value, "all", "all must be true");
    return ReleaseAll{};
  }
  if (in.has("particle")) {
    ReleaseParticle release;
    in.read("particle", release.particle, kIndexRange);
    return release;
  }
  ReleasePin release;
  in.read("pin", release.pin, kIdRange);
  return release;
}

Command read_camera(FieldReader& in) {
  Camera camera;
  in.read("position", camera.position, kPositionRange);
  in.read("target", camera.target, kPositionRange);
  if (in.has("up")) read_direction(in, "up", camera.up);
  in.read_if_there("fov", camera.fov, kFovRange);
  if (in.ok() && camera.position == camera.target)
    in.fail(ErrorCode::out_of_range, "target", "target must not be the camera's position");
  return camera;
}

Command read_step(FieldReader& in) {
  Step step;
  in.read_if_there("n", step.n, kStepRange);
  return step;
}

Command read_speed(FieldReader& in) {
  Speed speed;
  in.read("speed", speed.speed, kSpeedRange);
  return speed;
}

Fan read_fan(FieldReader& in) {
  Fan fan;
  in.read("position", fan.position, kPositionRange);
  read_direction(in, "direction", fan.direction);
  in.read_if_there("speed", fan.speed, kFanSpeedRange);
  in.read_if_there("radius", fan.radius, kFanRadiusRange);
  in.read_if_there("spread", fan.spread, kFanSpreadRange);
  in.read_if_there("reach", fan.reach, kFanReachRange);
  return fan;
}

void read_fans(FieldReader& in, std::optional<std::vector<Fan>>& fans) {
  if (!in.has("fans")) return;
  fans.emplace();
  in.read_objects("fans", kMostFans, [&fans](FieldReader& fan) { fans->push_back(read_fan(fan)); });
}

Command read_set(FieldReader& in) {
  Set set;
  in.read_if_there("gravity", set.gravity, kGravityRange);
  in.read_if_there("wind", set.wind, kWindRange);
  in.read_if_there("gust_speed", set.gust_speed, kGustSpeedRange);
  in.read_if_there("gust_length", set.gust_length, kGustLengthRange);
  in.read_if_there("air_density", set.air_density, kAirDensityRange);
  in.read_if_there("still_air", set.still_air);
  in.read_if_there("drag", set.drag, kDragRange);
  read_fans(in, set.fans);
  in.read_if_there("softness", set.softness, kSoftnessRange);
  in.read_if_there("budget_ms", set.budget_ms, kBudgetRange);
  in.read_if_there("over_budget", set.over_budget, kOverBudgetWords);
  if (in.ok() && set == Set{}) {
    Error error = make_error(ErrorCode::missing_field, "set has nothing to set");
    error.limit = Limit{{},
                        {},
                        {},
                        {"gravity", "wind", "gust_speed", "gust_length", "air_density", "still_air",
                         "drag", "fans", "softness", "budget_ms", "over_budget"}};
    in.fail(std::move(error));
  }
  return set;
}

Command read_advance(FieldReader& in) {
  Advance advance;
  in.read("n", advance.n, kAdvanceRange);
  in.read_if_there("frames", advance.frames, kAdvanceFramesWords);
  return advance;
}

void read_tree(FieldReader& in, Query& query) {
  query.tree.emplace();
  in.read("tree", *query.tree);
  in.read_if_there("level", query.level, kLevelRange);
  if (in.ok() && (query.tree->empty() || query.tree->size() > kMostTreeBytes))
    in.fail(ErrorCode::wrong_length, "tree", "tree must have 1 to 80 bytes");
}

Command read_query(FieldReader& in) {
  Query query;
  in.read("what", query.what, kQueryWhatWords);
  in.read_if_there("format", query.format, kQueryFormatWords);
  in.read_if_there("viewer", query.viewer, kIdRange);
  const bool boxes = query.what == QueryWhat::boxes;
  const bool numbers =
      query.what == QueryWhat::positions || query.what == QueryWhat::velocities || boxes;
  if (query.format != QueryFormat::json && !numbers) {
    in.fail(ErrorCode::conflicting_fields, "format",
            "only positions, velocities and boxes have binary formats");
  }
  if (query.viewer && query.what != QueryWhat::camera)
    in.fail(ErrorCode::conflicting_fields, "viewer", "viewer is only for camera");
  if (boxes) read_tree(in, query);
  for (const char* key : {"tree", "level"}) {
    if (!boxes && in.has(key))
      in.fail(ErrorCode::conflicting_fields, key, std::string(key) + " is only for boxes");
  }
  return query;
}

Command read_ping(FieldReader& in) {
  Ping ping;
  in.read("t", ping.t, {-1e300, 1e300});
  return ping;
}

Command read_load(FieldReader& in) {
  Load load;
  if (in.read_object_text("scene", load.definition)) return load;
  in.read("scene", load.scene);
  if (!in.ok()) return load;
  if (load.scene.empty() || load.scene.size() > kMostSceneBytes)
    in.fail(ErrorCode::wrong_length, "scene", "scene must have 1 to 64 characters");
  const auto is_plain = [](char x) {
    return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'z') || (x >= 'A' && x <= 'Z') || x == '.' ||
           x == '_' || x == '-';
  };
  if (load.scene.starts_with('.') || !std::all_of(load.scene.begin(), load.scene.end(), is_plain))
    in.fail(ErrorCode::unknown_value, "scene", "scene must be a plain name, not a path");
  return load;
}

Command read_view(FieldReader& in) {
  View view;
  in.read_if_there("hz", view.hz, kFrameRateRange);
  in.read_if_there("codec", view.codec, kCodecWords);
  in.read_if_there("error", view.error, kPackedErrorRange);
  in.read_if_there("forces", view.forces);
  if (in.ok() && view == View{})
    in.fail(ErrorCode::missing_field, "hz", "view needs hz, codec, error or forces");
  return view;
}

template <class Plain>
Command read_plain(FieldReader&) {
  return Plain{};
}

struct Operation {
  const char* name;
  Command (*read)(FieldReader&);
};

constexpr std::array kOperations = {
    Operation{"hello", read_hello},        Operation{"pick", read_pick},
    Operation{"drag", read_drag},          Operation{"pin", read_pin},
    Operation{"release", read_release},    Operation{"camera", read_camera},
    Operation{"pause", read_plain<Pause>}, Operation{"resume", read_plain<Resume>},
    Operation{"step", read_step},          Operation{"reset", read_plain<Reset>},
    Operation{"speed", read_speed},        Operation{"set", read_set},
    Operation{"advance", read_advance},    Operation{"query", read_query},
    Operation{"hash", read_plain<Hash>},   Operation{"ping", read_ping},
    Operation{"load", read_load},          Operation{"view", read_view},
    Operation{"move", read_move},          Operation{"gripper", read_gripper},
};

const Operation* find_operation(const std::string& name) {
  const auto it = std::find_if(kOperations.begin(), kOperations.end(),
                               [&name](const Operation& o) { return name == o.name; });
  return it == kOperations.end() ? nullptr : &*it;
}

Error unknown_operation(const std::string& name) {
  std::vector<std::string> names;
  names.reserve(kOperations.size());
  for (const Operation& operation : kOperations) names.emplace_back(operation.name);
  Error error = word_error("op", name, std::move(names));
  error.code = ErrorCode::unknown_op;
  return error;
}

}  // namespace

Result<Request> parse_request(std::string_view text) {
  Result<json> object = parse_object(text);
  if (!object) {
    Error error = std::move(object).error();
    error.id = find_id(text);
    return error;
  }
  FieldReader in(*object);
  Request request;
  std::string name;
  in.read_id("id", request.id);
  in.read("op", name);
  const Operation* operation = in.ok() ? find_operation(name) : nullptr;
  if (operation != nullptr) {
    request.command = operation->read(in);
  } else {
    in.fail(unknown_operation(name));
  }
  if (in.ok()) return request;
  Error error = *in.error();
  error.id = request.id;
  if (operation != nullptr) error.command = operation->name;
  return error;
}

}  // namespace weft::proto
