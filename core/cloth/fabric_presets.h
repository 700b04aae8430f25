#pragma once

#include <string>
#include <vector>

#include "core/cloth/fabric.h"

namespace weft {

/// A fabric by name.
struct FabricPreset {
  const char* name;
  const char* description;
  FabricDef fabric;
};

/// cotton, silk, wool, denim, leather, nylon. Sources of the values stand beside them.
const std::vector<FabricPreset>& fabric_presets();

/// Throws DefinitionError on field "fabric" if there is none of this name.
FabricDef make_fabric(const std::string& name);

/// The preset that has exactly these values; "default" for those of a FabricDef as it is made;
/// "custom" for all others.
std::string fabric_name(const FabricDef& fabric);

}  // namespace weft
