#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/messages/rooms_commands.h"

// Bodies of the HTTP responses, README.md section 2.

namespace weft::proto {

struct VersionInfo {
  std::string version, commit, compiler, simd;
};

struct SceneListing {
  std::string name, description;
};

struct Readiness {
  bool ready = false;
  std::string room;  ///< that the rest is about: the first that is not ready, else the default one
  std::string scene;
  std::uint64_t tick = 0;
  double real_time_factor = 0;
  double stalled = 0;  ///< time since the room's last turn [s]; 0 below a second
};

struct HttpError {
  std::string code, message, hint;
  std::string value;                 ///< as requested; may be empty
  std::vector<std::string> offered;  ///< accepted alternatives; may be empty
};

std::string encode_version(const VersionInfo& version);
std::string encode_scenes(const std::vector<SceneListing>& scenes);
std::string encode_rooms(const std::vector<RoomInfo>& rooms, std::uint32_t most);
std::string encode_readiness(const Readiness& readiness);
std::string encode_http_error(const HttpError& error);

}  // namespace weft::proto
