#pragma once

#include <string>

#include "core/world/world_def.h"

// Scenes that measure a fabric as textile laboratories do. Each modifies a world of one cloth with
// default settings; the mesh directory is not used.

namespace weft {

/// Cusick's drape test: a round specimen of 30 cm on a disc of 18 cm.
void build_drape_test(WorldDef& def, const std::string& mesh_directory);

/// The drape test of a fabric on a grid or a mesh of other fineness than the scene's. The disc is
/// as large whatever the fineness: the pins end where the fabric is clamped at its edge.
/// @param side   particles across the specimen, 11 to 401
/// @param rings  of particles between disc and hem, 2 to 100
WorldDef drape_test_on_grid(const FabricDef& fabric, int side);
WorldDef drape_test_on_rings(const FabricDef& fabric, int rings);

/// The bending test of ASTM D1388: a strip of 25 mm overhangs an edge by 60 mm.
void build_cantilever_test(WorldDef& def, const std::string& mesh_directory);
void build_decay_test(WorldDef& def, const std::string& mesh_directory);

}  // namespace weft
