#pragma once

#include <string>

namespace weft::server {

/// Where the schema is served.
inline constexpr const char* kSceneSchemaPath = "/api/v1/scene-schema";

/// The JSON Schema (draft 7) of scene files; server/scene.schema.json holds the same.
std::string scene_schema();

}  // namespace weft::server
