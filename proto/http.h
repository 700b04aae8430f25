#pragma once

#include <cstdint>
#include <string>
#include <vector>

// Bodies of the HTTP answers, README.md section 2.

namespace weft::proto {

struct VersionInfo {
  std::string version, commit, compiler, simd;
};

struct SceneListing {
  std::string name, description;
};

struct Readiness {
  bool ready = false;
  std::string scene;
  std::uint64_t tick = 0;
  double real_time_factor = 0;
  double stalled = 0;  ///< for how long the room has not turned over [s]; below a second 0
};

struct HttpError {
  std::string code, message, hint;
  std::string value;                 ///< what was asked for; may be empty
  std::vector<std::string> offered;  ///< what would be taken in its place; may be empty
};

std::string encode_version(const VersionInfo& version);
std::string encode_scenes(const std::vector<SceneListing>& scenes);
std::string encode_readiness(const Readiness& readiness);
std::string encode_http_error(const HttpError& error);

}  // namespace weft::proto
