#include "proto/replies.h"

#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "proto/data.h"
#include "proto/event_json.h"
#include "proto/json_output.h"

namespace weft::proto {

using Json = nlohmann::ordered_json;

Json json_of(const ViewerCamera& camera) {
  Json out = {{"viewer", camera.viewer}};
  put_fields(out, camera.camera);
  return out;
}

Json json_of(const StageWork& stage) {
  return {{"stage", stage.stage}, {"milliseconds", stage.milliseconds}, {"work", stage.work}};
}

Json json_of(const TreeInfo& tree) {
  return {{"tree", tree.tree}, {"levels", tree.levels}};
}

Json json_of(const ColliderPose& collider) {
  return {{"name", collider.name},         {"position", collider.position},
          {"rotation", collider.rotation}, {"force", collider.force},
          {"blocked", collider.blocked},   {"voided", collider.voided}};
}

Json json_of(const Measurements& measurements) {
  Json out = Json::object();
  for (const auto& [name, value] : measurements.values) out[name] = value;
  return out;
}

Json json_of(const ContactInfo& c) {
  Json out = Json::object();
  put_if(out, "collider", c.collider);
  out["particles"] = c.particles;
  out["weights"] = c.weights;
  out["point"] = c.point;
  out["normal"] = c.normal;
  out["gap"] = c.gap;
  out["normal_force"] = c.normal_force;
  out["friction"] = c.friction;
  return out;
}

Json json_of(const PinForce& pin) {
  return {{"pin", pin.pin}, {"force", pin.force}};
}

Json json_of(const GrabForce& grab) {
  return {{"grab", grab.grab}, {"viewer", grab.viewer}, {"force", grab.force}};
}

Json json_of(const ColliderForce& collider) {
  return {{"collider", collider.collider}, {"force", collider.force}};
}

Json json_of(const GripperInfo& gripper) {
  return {{"name", gripper.name},         {"position", gripper.position},
          {"rotation", gripper.rotation}, {"opening", gripper.opening},
          {"force", gripper.force},       {"gripping", gripper.gripping},
          {"reaction", gripper.reaction}};
}

Json json_of(const ReactionInfo& reactions) {
  Json out = Json::object();
  if (reactions.pins) out["pins"] = json_of(*reactions.pins);
  out["grabs"] = json_of(reactions.grabs);
  out["colliders"] = json_of(reactions.colliders);
  return out;
}

namespace {

struct DataName {
  QueryWhat operator()(const Energy&) const { return QueryWhat::energies; }
  QueryWhat operator()(const Strain&) const { return QueryWhat::strain; }
  QueryWhat operator()(const std::vector<PinInfo>&) const { return QueryWhat::pins; }
  QueryWhat operator()(const std::vector<GrabInfo>&) const { return QueryWhat::grabs; }
  QueryWhat operator()(const std::vector<ViewerCamera>&) const { return QueryWhat::camera; }
  QueryWhat operator()(const std::vector<ViewerInfo>&) const { return QueryWhat::roster; }
  QueryWhat operator()(const State&) const { return QueryWhat::state; }
  QueryWhat operator()(const std::vector<StageWork>&) const { return QueryWhat::work; }
  QueryWhat operator()(const std::vector<TreeInfo>&) const { return QueryWhat::trees; }
  QueryWhat operator()(const std::vector<ColliderPose>&) const { return QueryWhat::colliders; }
  QueryWhat operator()(const Measurements&) const { return QueryWhat::measurements; }
  QueryWhat operator()(const std::vector<ContactInfo>&) const { return QueryWhat::contacts; }
  QueryWhat operator()(const ReactionInfo&) const { return QueryWhat::reactions; }
  QueryWhat operator()(const std::vector<GripperInfo>&) const { return QueryWhat::grippers; }
  QueryWhat operator()(const Crossings&) const { return QueryWhat::crossings; }
};

struct ReplyWriter {
  Json& out;

  void start(const char* command, std::uint64_t tick) {
    out["command"] = command;
    out["tick"] = tick;
  }

  void operator()(const DoneReply& r) { start(r.command, r.tick); }
  void operator()(const HelloReply& r) {
    out["command"] = "hello";
    out["viewer"] = r.viewer;
    out["name"] = r.name;
    out["color"] = r.color;
    out["role"] = r.role;
  }
  void operator()(const PickReply& r) {
    start("pick", r.tick);
    out["hit"] = nullptr;
    if (!r.hit) return;
    out["hit"] = {{"triangle", r.hit->point.triangle},
                  {"barycentric", r.hit->point.barycentric},
                  {"position", r.hit->position},
                  {"particle", r.hit->particle},
                  {"distance", r.hit->distance}};
  }
  void operator()(const DragReply& r) {
    start("drag", r.tick);
    out["drag"] = r.drag;
    out["grab"] = r.grab;
    put_if(out, "target", r.target);
    put_if(out, "impulse", r.impulse);
  }
  void operator()(const PinReply& r) {
    start("pin", r.tick);
    out["pin"] = r.pin;
    out["particle"] = r.particle;
    out["count"] = r.count;
  }
  void operator()(const ReleaseReply& r) {
    start("release", r.tick);
    out["released"] = r.released;
  }
  void operator()(const PauseReply& r) {
    start(r.paused ? "pause" : "resume", r.tick);
    out["paused"] = r.paused;
  }
  void operator()(const StepReply& r) {
    start("step", r.tick);
    out["until"] = r.until;
  }
  void operator()(const SpeedReply& r) {
    start("speed", r.tick);
    out["speed"] = r.speed;
  }
  void operator()(const MoveReply& r) {
    start("move", r.tick);
    std::visit([this](const auto& collider) { out["collider"] = collider; }, r.collider);
  }
  void operator()(const MovePinReply& r) {
    start("move", r.tick);
    out["pin"] = r.pin;
    out["position"] = r.position;
  }
  void operator()(const GripperReply& r) {
    start("gripper", r.tick);
    out["gripper"] = r.gripper;
  }
  void operator()(const AdvanceReply& r) {
    start("advance", r.tick);
    out["hash"] = hash_text(r.hash);
  }
  void operator()(const HashReply& r) {
    start("hash", r.tick);
    out["hash"] = hash_text(r.hash);
  }
  void operator()(const PingReply& r) {
    out["command"] = "ping";
    out["t"] = r.t;
    out["received"] = r.received;
    out["sent"] = r.sent;
  }
  void operator()(const LoadReply& r) {
    start("load", r.tick);
    out["scene"] = r.scene;
    out["epoch"] = r.epoch;
  }
  void operator()(const ViewReply& r) {
    out["command"] = "view";
    out["hz"] = r.hz;
    out["codec"] = name_of(r.codec);
    if (r.codec == Codec::packed) out["error"] = r.error;
    out["forces"] = r.forces;
  }
  void operator()(const VectorsReply& r) {  // the data is appended as text
    start("query", r.tick);
    out["what"] = name_of(r.what);
  }
  void operator()(const BinaryReply& r) {
    start("query", r.tick);
    out["what"] = name_of(r.what);
    out["format"] = name_of(r.format);
    out["binary"] = {{"transfer", r.transfer},
                     {"count", r.count},
                     {"components", r.components},
                     {"bytes", data_message_bytes(r.format, r.count, r.components)}};
  }
  void operator()(const QueryReply& r) {
    start("query", r.tick);
    out["what"] = name_of(std::visit(DataName{}, r.data));
    out["data"] = std::visit([](const auto& data) { return json_of(data); }, r.data);
  }
};

// Written by hand because a tree of a hundred thousand nodes costs megabytes, and because the text
// of a float is half as long when it is formatted as a float.
template <class Real>
void append_rows(std::span<const Real> values, std::size_t components, std::string& out) {
  std::array<char, 32> buffer;
  out += '[';
  for (std::size_t i = 0; i + components <= values.size(); i += components) {
    if (i > 0) out += ',';
    for (std::size_t k = 0; k < components; ++k) {
      out += k == 0 ? '[' : ',';
      if (!std::isfinite(values[i + k])) {
        out += "null";  // as the library does: JSON has no such number
        continue;
      }
      const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), values[i + k]);
      out.append(buffer.data(), end.ptr);
    }
    out += ']';
  }
  out += ']';
}

Json json_of_limit(const Limit& limit) {
  Json out = Json::object();
  put_if(out, "minimum", limit.minimum);
  put_if(out, "maximum", limit.maximum);
  put_if(out, "length", limit.length);
  if (!limit.allowed.empty()) out["allowed"] = limit.allowed;
  return out;
}

}  // namespace

std::string encode_reply(const Id& id, const Reply& reply) {
  Json out = {{"op", "result"}};
  put_id(out, id);
  std::visit(ReplyWriter{out}, reply);
  std::string text = text_of(out);
  if (const auto* vectors = std::get_if<VectorsReply>(&reply)) {
    text.back() = ',';
    text += "\"data\":";
    std::visit([&](auto values) { append_rows(values, vectors->components, text); },
               vectors->values);
    text += '}';
  }
  return text;
}

std::string encode_error(const Error& error) {
  Json out = {{"op", "error"}};
  if (error.id) put_id(out, *error.id);
  if (!error.command.empty()) out["command"] = error.command;
  out["code"] = name_of(error.code);
  out["message"] = error.message;
  if (!error.field.empty()) out["field"] = error.field;
  if (!error.value.empty()) {
    Json value = Json::parse(error.value, nullptr, false);
    if (!value.is_discarded()) out["value"] = std::move(value);
  }
  if (error.limit) out["limit"] = json_of_limit(*error.limit);
  if (!error.hint.empty()) out["hint"] = error.hint;
  return text_of(out);
}

}  // namespace weft::proto
