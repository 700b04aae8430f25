#include "proto/messages/http.h"

#include <nlohmann/json.hpp>

#include "proto/messages/json_output.h"

namespace weft::proto {

using Json = nlohmann::ordered_json;

std::string encode_version(const VersionInfo& version) {
  return text_of({{"server", "weft"},
                  {"version", version.version},
                  {"commit", version.commit},
                  {"compiler", version.compiler},
                  {"simd", version.simd},
                  {"protocols", Json::array({kSubprotocol})}});
}

std::string encode_scenes(const std::vector<SceneListing>& scenes) {
  Json list = Json::array();
  for (const SceneListing& scene : scenes)
    list.push_back({{"name", scene.name}, {"description", scene.description}});
  Json out = Json::object();
  out["scenes"] = std::move(list);
  return text_of(out);
}

std::string encode_rooms(const std::vector<RoomInfo>& rooms, std::uint32_t most) {
  Json out = Json::object();
  out["rooms"] = CommandWriter::json_of(rooms);
  out["most"] = most;
  return text_of(out);
}

std::string encode_readiness(const Readiness& readiness) {
  Json body = {{"ready", readiness.ready},
               {"room", readiness.room},
               {"scene", readiness.scene},
               {"tick", readiness.tick},
               {"real_time_factor", readiness.real_time_factor}};
  if (readiness.stalled > 0) body["stalled"] = readiness.stalled;
  return text_of(body);
}

std::string encode_http_error(const HttpError& error) {
  Json body = {{"code", error.code}, {"message", error.message}};
  if (!error.value.empty()) body["value"] = error.value;
  if (!error.offered.empty()) body["offered"] = error.offered;
  if (!error.hint.empty()) body["hint"] = error.hint;
  Json out = Json::object();
  out["error"] = std::move(body);
  return text_of(out);
}

}  // namespace weft::proto
