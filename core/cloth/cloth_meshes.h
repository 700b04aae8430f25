#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/geometry/mesh_file.h"

// Cloths as meshes for a file.

namespace weft {

/// The cloths at particle positions `x`, with the places of their corners in the fabric as uv [m].
template <class Real>
std::vector<NamedMesh> cloth_meshes(const ClothModel<Real>& model, const Vec3Array<Real>& x);

}  // namespace weft
