#include "proto/events.h"

#include <array>

#include <nlohmann/json.hpp>

#include "proto/event_json.h"
#include "proto/json_output.h"

namespace weft::proto {

using Json = nlohmann::ordered_json;

namespace {

Json json_of_limits(const ServerLimits& limits) {
  return {{"message_bytes", limits.message_bytes},
          {"messages_per_second", limits.messages_per_second},
          {"viewers", limits.viewers},
          {"drags_per_viewer", limits.drags_per_viewer},
          {"drags", limits.drags},
          {"pins", limits.pins},
          {"step_ticks", static_cast<std::uint32_t>(kStepRange.maximum)},
          {"advance_ticks", static_cast<std::uint32_t>(kAdvanceRange.maximum)},
          {"lease_seconds", limits.lease_seconds},
          {"frames_in_flight", limits.frames_in_flight}};
}

Json json_of_cloth(const ClothInfo& cloth) {
  Json out = {{"name", cloth.name},
              {"first_vertex", cloth.first_vertex},
              {"vertices", cloth.vertices},
              {"first_triangle", cloth.first_triangle},
              {"triangles", cloth.triangles}};
  if (cloth.rows > 0) {
    out["rows"] = cloth.rows;
    out["columns"] = cloth.columns;
  }
  out["thickness"] = cloth.thickness;
  Json look = Json::object();
  if (!cloth.look.fabric.empty()) look["fabric"] = cloth.look.fabric;
  if (!cloth.look.color.empty()) look["color"] = cloth.look.color;
  if (!cloth.look.back.empty()) look["back"] = cloth.look.back;
  if (!look.empty()) out["look"] = std::move(look);
  return out;
}

struct ShapeWriter {
  Json& out;

  void operator()(const PlaneInfo& plane) {
    out["kind"] = "plane";
    out["point"] = plane.point;
    out["normal"] = plane.normal;
  }
  void operator()(const SphereInfo& sphere) {
    out["kind"] = "sphere";
    out["center"] = sphere.center;
    out["radius"] = sphere.radius;
  }
  void operator()(const CapsuleInfo& capsule) {
    out["kind"] = "capsule";
    out["a"] = capsule.a;
    out["b"] = capsule.b;
    out["radius"] = capsule.radius;
  }
  void operator()(const BoxInfo& box) {
    out["kind"] = "box";
    out["center"] = box.center;
    out["half_extents"] = box.half_extents;
    out["orientation"] = box.orientation;
  }
  void operator()(const MeshInfo& mesh) {
    out["kind"] = "mesh";
    out["vertices"] = mesh.vertices;
    out["triangles"] = mesh.triangles;
  }
};

Json json_of_collider(const ColliderInfo& collider) {
  Json out = {{"name", collider.name}};
  std::visit(ShapeWriter{out}, collider.shape);
  out["pivot"] = collider.pivot;
  return out;
}

Json json_of_guarantee(const Guarantee& guarantee) {
  return {{"state", name_of(guarantee.state)},
          {"covers", guarantee.covers},
          {"pairs", guarantee.pairs},
          {"reasons", guarantee.reasons}};
}

}  // namespace

const char* name_of(GuaranteeState state) {
  static constexpr std::array kStates = {"held", "bad_start", "void", "none"};
  return kStates[static_cast<std::size_t>(state)];
}

Json json_of(const Strain& strain) {
  return {{"largest", strain.largest}, {"p99", strain.p99}};
}

Json json_of(const Energy& energy) {
  return {{"kinetic", energy.kinetic},
          {"stretch", energy.stretch},
          {"bending", energy.bending},
          {"gravity", energy.gravity},
          {"total", energy.total}};
}

Json json_of(const Crossings& crossings) {
  Json out = {{"count", crossings.count}, {"tick", crossings.tick}, {"smallest_gap", nullptr}};
  put_if(out, "smallest_gap", crossings.smallest_gap);
  return out;
}

Json json_of(const State& state) {
  return {{"tick", state.tick},
          {"time", state.time},
          {"paused", state.paused},
          {"speed", state.speed},
          {"pace", state.pace},
          {"softness", state.softness},
          {"budget_ms", state.budget_ms},
          {"over_budget", name_of(state.over_budget)},
          {"scene", state.scene},
          {"tick_rate", state.tick_rate},
          {"gravity", state.gravity},
          {"wind", state.wind},
          {"gust_speed", state.gust_speed},
          {"gust_length", state.gust_length},
          {"air_density", state.air_density},
          {"still_air", state.still_air},
          {"drag", state.drag},
          {"fans", CommandWriter::json_of(state.fans)},
          {"fabric", state.fabric},
          {"solver", state.solver},
          {"substeps", state.substeps},
          {"particles", state.particles},
          {"step_ms", state.step_ms},
          {"real_time_factor", state.real_time_factor},
          {"sleeping", {{"islands", state.sleeping.islands}, {"cloths", state.sleeping.cloths}}},
          {"guarantee", json_of_guarantee(state.guarantee)},
          {"crossings", state.crossings ? json_of(*state.crossings) : Json()},
          {"strain", json_of(state.strain)},
          {"energy", json_of(state.energy)}};
}

Json json_of(const ViewerInfo& viewer) {
  Json out = {{"id", viewer.id},
              {"name", viewer.name},
              {"color", viewer.color},
              {"role", viewer.role},
              {"camera", nullptr}};
  if (viewer.camera) put_fields(out["camera"], *viewer.camera);
  return out;
}

Json json_of(const PinInfo& pin) {
  Json out = {{"id", pin.id},         {"viewer", pin.viewer},     {"particle", pin.particle},
              {"radius", pin.radius}, {"position", pin.position}, {"count", pin.count}};
  if (pin.target) {
    out["target"] = *pin.target;
    out["behind"] = pin.behind;
  }
  return out;
}

Json json_of(const GrabInfo& grab) {
  Json out = {{"id", grab.id},
              {"viewer", grab.viewer},
              {"drag", grab.drag},
              {"triangle", grab.point.triangle},
              {"barycentric", grab.point.barycentric},
              {"radius", grab.radius},
              {"stiffness", grab.stiffness},
              {"max_force", grab.max_force},
              {"held", grab.held},
              {"target", grab.target},
              {"mode", name_of(grab.mode)}};
  put_if(out, "force", grab.force);
  return out;
}

std::string encode_welcome(const Welcome& welcome) {
  return text_of({{"op", "welcome"},
                  {"protocol", kSubprotocol},
                  {"server", "weft"},
                  {"version", welcome.version},
                  {"session", welcome.session},
                  {"viewer", welcome.viewer},
                  {"name", welcome.name},
                  {"color", welcome.color},
                  {"role", welcome.role},
                  {"room", welcome.room},
                  {"scene", welcome.scene},
                  {"tick_rate", welcome.tick_rate},
                  {"clock", welcome.clock},
                  {"codecs", welcome.codecs},
                  {"limits", json_of_limits(welcome.limits)},
                  {"capabilities", welcome.capabilities}});
}

std::string encode_mesh(const MeshAnnouncement& mesh) {
  Json out = {{"op", "mesh"},
              {"epoch", mesh.epoch},
              {"scene", mesh.scene},
              {"hash", hash_text(mesh.hash)},
              {"url", mesh_url(mesh.hash)},
              {"bytes", mesh.bytes},
              {"vertices", mesh.vertices},
              {"triangles", mesh.triangles},
              {"cloths", Json::array()},
              {"colliders", Json::array()}};
  if (mesh.view)
    out["view"] = {{"target", mesh.view->target},
                   {"direction", mesh.view->direction},
                   {"radius", mesh.view->radius}};
  for (const ClothInfo& cloth : mesh.cloths) out["cloths"].push_back(json_of_cloth(cloth));
  for (const ColliderInfo& c : mesh.colliders) out["colliders"].push_back(json_of_collider(c));
  return text_of(out);
}

std::string encode_state(const State& state) {
  Json out = {{"op", "state"}};
  out.update(json_of(state));
  return text_of(out);
}

std::string encode_roster(const std::vector<ViewerInfo>& viewers) {
  return text_of({{"op", "roster"}, {"viewers", json_of(viewers)}});
}

std::string encode_pins(std::uint64_t tick, const std::vector<PinInfo>& pins) {
  return text_of({{"op", "pins"}, {"tick", tick}, {"pins", json_of(pins)}});
}

std::string encode_grabs(std::uint64_t tick, const std::vector<GrabInfo>& grabs) {
  return text_of({{"op", "grabs"}, {"tick", tick}, {"grabs", json_of(grabs)}});
}

std::string encode_notice(const Notice& notice) {
  static constexpr std::array kLevels = {"info", "warning", "error"};
  Json out = {{"op", "notice"},
              {"level", kLevels[static_cast<std::size_t>(notice.level)]},
              {"code", notice.code},
              {"message", notice.message}};
  put_if(out, "tick", notice.tick);
  put_if(out, "viewer", notice.viewer);
  put_if(out, "drag", notice.drag);
  put_if(out, "count", notice.count);
  put_if(out, "value", notice.value);
  return text_of(out);
}

std::string encode_bye(const Bye& bye) {
  return text_of({{"op", "bye"}, {"code", bye.code}, {"reason", bye.reason}});
}

std::string hash_text(std::uint64_t hash) {
  constexpr int kDigits = 16;
  std::string text(kDigits, '0');
  for (int i = kDigits - 1; i >= 0; --i, hash >>= 4U)
    text[static_cast<std::size_t>(i)] = "0123456789abcdef"[hash & 15U];
  return text;
}

std::string mesh_url(std::uint64_t hash) {
  return "/api/v1/mesh/" + hash_text(hash);
}

}  // namespace weft::proto
