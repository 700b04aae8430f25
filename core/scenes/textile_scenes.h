#pragma once

#include <string>

#include "core/world/world_def.h"

// Scenes that measure a fabric as textile laboratories do. Each modifies a world of one cloth with
// default settings; the mesh directory is not used.

namespace weft {

/// Cusick's drape test: a round specimen of 30 cm on a disc of 18 cm.
void build_drape_test(WorldDef& def, const std::string& mesh_directory);

/// The bending test of ASTM D1388: a strip of 25 mm overhangs an edge by 60 mm.
void build_cantilever_test(WorldDef& def, const std::string& mesh_directory);

}  // namespace weft
