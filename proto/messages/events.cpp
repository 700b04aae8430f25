#include "proto/messages/events.h"

#include <array>

#include <nlohmann/json.hpp>

#include "proto/messages/event_json.h"
#include "proto/messages/json_output.h"

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

template <class Event>
std::string encode_event(const Event& event) {
  Json out = {{"op", Event::kOp}};
  put_fields(out, event);
  return text_of(out);
}

}  // namespace

std::string encode_welcome(const Welcome& welcome) {
  return text_of({{"op", "welcome"},
                  {"protocol", kSubprotocol},
                  {"server", "weft"},
                  {"version", welcome.version},
                  {"session", welcome.session},
                  {"viewer", welcome.viewer},
                  {"name", welcome.name},
                  {"color", welcome.color},
                  {"role", name_of(welcome.role)},
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
  return encode_event(state);
}

std::string encode_roster(const std::vector<ViewerInfo>& viewers) {
  return text_of({{"op", "roster"}, {"viewers", json_of(viewers)}});
}

std::string encode_presence(const std::vector<PresenceInfo>& viewers) {
  return text_of({{"op", "presence"}, {"viewers", json_of(viewers)}});
}

std::string encode_pins(std::uint64_t tick, const std::vector<PinInfo>& pins) {
  return text_of({{"op", "pins"}, {"tick", tick}, {"pins", json_of(pins)}});
}

std::string encode_grabs(std::uint64_t tick, const std::vector<GrabInfo>& grabs) {
  return text_of({{"op", "grabs"}, {"tick", tick}, {"grabs", json_of(grabs)}});
}

std::string encode_notice(const Notice& notice) {
  return encode_event(notice);
}

std::string encode_bye(const Bye& bye) {
  return encode_event(bye);
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
