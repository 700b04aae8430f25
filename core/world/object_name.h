#pragma once

#include <cassert>
#include <string>

#include "core/world/world_def.h"

// Names of objects for people.

namespace weft {

/// Name of an object for messages; its number if it has none.
/// @param object  its place in the scene's list
inline std::string object_name(const WorldDef& def, std::size_t object) {
  assert(object < def.colliders.size());
  const std::string& name = def.colliders[object].name;
  return name.empty() ? "object " + std::to_string(object) : name;
}

}  // namespace weft
