#include <string>
#include <variant>

#include <nlohmann/json.hpp>

#include "proto/commands.h"
#include "proto/event_json.h"
#include "proto/json_output.h"
#include "proto/words.h"

namespace weft::proto {
namespace {

using Json = nlohmann::ordered_json;

void put_hold(Json& out, const Hold& hold) {
  if (const auto* point = std::get_if<SurfacePoint>(&hold)) {
    out["triangle"] = point->triangle;
    out["barycentric"] = point->barycentric;
  } else {
    out["particle"] = std::get<Particle>(hold).index;
  }
}

void put_collider(Json& out, const ColliderRef& ref) {
  std::visit([&out](const auto& collider) { out["collider"] = collider; }, ref);
}

// Writes the fields of each command; the last overload takes commands without fields.
struct FieldWriter {
  Json& out;

  void operator()(const Hello& c) {
    put_if(out, "name", c.name);
    put_if(out, "color", c.color);
    put_if(out, "token", c.token);
  }
  void operator()(const Pick& c) {
    out["origin"] = c.origin;
    out["direction"] = c.direction;
  }
  void operator()(const DragStart& c) {
    out["phase"] = "start";
    out["drag"] = c.drag;
    put_hold(out, c.hold);
    put_if(out, "target", c.target);
    out["radius"] = c.radius;
    out["stiffness"] = c.stiffness;
    out["max_force"] = c.max_force;
    out["mode"] = name_of(c.mode);
  }
  void operator()(const DragMove& c) {
    out["phase"] = "move";
    out["drag"] = c.drag;
    out["target"] = c.target;
  }
  void operator()(const DragEnd& c) {
    out["phase"] = "end";
    out["drag"] = c.drag;
    if (!c.fire) out["fire"] = false;
  }
  void operator()(const Pin& c) {
    put_hold(out, c.hold);
    out["radius"] = c.radius;
  }
  void operator()(const ReleasePin& c) { out["pin"] = c.pin; }
  void operator()(const ReleaseParticle& c) { out["particle"] = c.particle; }
  void operator()(const ReleaseAll&) { out["all"] = true; }
  void operator()(const Camera& c) { put_camera(out, c); }
  void operator()(const Step& c) { out["n"] = c.n; }
  void operator()(const Speed& c) { out["speed"] = c.speed; }
  void operator()(const Move& c) {
    put_collider(out, c.collider);
    put_if(out, "position", c.position);
    put_if(out, "rotation", c.rotation);
    out["speed"] = c.speed;
    out["turn_speed"] = c.turn_speed;
    if (c.force) out["force"] = true;
  }
  void operator()(const Gripper& c) {
    out["name"] = c.gripper;
    put_if(out, "opening", c.opening);
    put_if(out, "force", c.force);
    put_if(out, "position", c.position);
    put_if(out, "rotation", c.rotation);
    put_if(out, "speed", c.speed);
    put_if(out, "turn_speed", c.turn_speed);
  }
  void operator()(const MoveEnd& c) {
    put_collider(out, c.collider);
    out["release"] = true;
  }
  void operator()(const MovePin& c) {
    out["pin"] = c.pin;
    out["position"] = c.position;
    if (c.seconds)
      out["seconds"] = *c.seconds;
    else
      out["speed"] = c.speed;
    out["max_force"] = c.max_force;
  }
  void operator()(const StopPin& c) {
    out["pin"] = c.pin;
    out["stop"] = true;
  }
  void operator()(const Set& c) {
    put_if(out, "gravity", c.gravity);
    put_if(out, "wind", c.wind);
    put_if(out, "gust_speed", c.gust_speed);
    put_if(out, "gust_length", c.gust_length);
    put_if(out, "air_density", c.air_density);
    put_if(out, "still_air", c.still_air);
    put_if(out, "drag", c.drag);
    if (c.fans) out["fans"] = json_of(*c.fans);
    put_if(out, "softness", c.softness);
    put_if(out, "budget_ms", c.budget_ms);
    if (c.over_budget) out["over_budget"] = name_of(*c.over_budget);
  }
  void operator()(const Advance& c) {
    out["n"] = c.n;
    if (c.frames) out["frames"] = name_of(*c.frames);
  }
  void operator()(const Query& c) {
    out["what"] = name_of(c.what);
    out["format"] = name_of(c.format);
    put_if(out, "viewer", c.viewer);
    put_if(out, "tree", c.tree);
    put_if(out, "level", c.level);
  }
  void operator()(const Ping& c) { out["t"] = c.t; }
  void operator()(const Load& c) {
    if (c.definition.empty())
      out["scene"] = c.scene;
    else
      out["scene"] = Json::parse(c.definition);
  }
  void operator()(const Halt& c) { out["cause"] = c.cause; }
  void operator()(const View& c) {
    put_if(out, "hz", c.hz);
    if (c.codec) out["codec"] = name_of(*c.codec);
    put_if(out, "error", c.error);
    put_if(out, "forces", c.forces);
  }
  template <class Plain>
  void operator()(const Plain&) {}
};

struct Name {
  const char* operator()(const Hello&) const { return "hello"; }
  const char* operator()(const Pick&) const { return "pick"; }
  const char* operator()(const DragStart&) const { return "drag"; }
  const char* operator()(const DragMove&) const { return "drag"; }
  const char* operator()(const DragEnd&) const { return "drag"; }
  const char* operator()(const Pin&) const { return "pin"; }
  const char* operator()(const ReleasePin&) const { return "release"; }
  const char* operator()(const ReleaseParticle&) const { return "release"; }
  const char* operator()(const ReleaseAll&) const { return "release"; }
  const char* operator()(const Camera&) const { return "camera"; }
  const char* operator()(const Pause&) const { return "pause"; }
  const char* operator()(const Resume&) const { return "resume"; }
  const char* operator()(const Step&) const { return "step"; }
  const char* operator()(const Reset&) const { return "reset"; }
  const char* operator()(const Speed&) const { return "speed"; }
  const char* operator()(const Move&) const { return "move"; }
  const char* operator()(const MoveEnd&) const { return "move"; }
  const char* operator()(const MovePin&) const { return "move"; }
  const char* operator()(const StopPin&) const { return "move"; }
  const char* operator()(const Gripper&) const { return "gripper"; }
  const char* operator()(const Set&) const { return "set"; }
  const char* operator()(const Advance&) const { return "advance"; }
  const char* operator()(const Query&) const { return "query"; }
  const char* operator()(const Hash&) const { return "hash"; }
  const char* operator()(const Ping&) const { return "ping"; }
  const char* operator()(const Load&) const { return "load"; }
  const char* operator()(const View&) const { return "view"; }
  const char* operator()(const Halt&) const { return "halt"; }
};

}  // namespace

const char* name_of(const Command& command) {
  return std::visit(Name{}, command);
}
const char* name_of(DragMode mode) {
  return kDragModeWords[static_cast<std::size_t>(mode)];
}
const char* name_of(OverBudget remedy) {
  return kOverBudgetWords[static_cast<std::size_t>(remedy)];
}
const char* name_of(AdvanceFrames frames) {
  return kAdvanceFramesWords[static_cast<std::size_t>(frames)];
}
const char* name_of(QueryWhat what) {
  return kQueryWhatWords[static_cast<std::size_t>(what)];
}
const char* name_of(QueryFormat f) {
  return kQueryFormatWords[static_cast<std::size_t>(f)];
}
const char* name_of(Codec codec) {
  return kCodecWords[static_cast<std::size_t>(codec)];
}

std::string encode_request(const Request& request) {
  Json out;
  out["op"] = name_of(request.command);
  if (request.id) put_id(out, *request.id);
  std::visit(FieldWriter{out}, request.command);
  return text_of(out);
}

}  // namespace weft::proto
