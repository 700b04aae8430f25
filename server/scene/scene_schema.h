#pragma once

#include <string>

namespace weft::server {

/// Path that serves the schema.
inline constexpr const char* kSceneSchemaPath = "/api/v1/scene-schema";

/// The JSON Schema (draft 7) of scene files, equal to server/scene.schema.json.
std::string scene_schema();

}  // namespace weft::server
