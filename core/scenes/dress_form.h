#pragma once

#include "core/geometry/triangle_mesh.h"

// The dress form of the default scene.

namespace weft {

/// A dressmaker's form of 1,418 triangles (the size of the seed's static model): a closed surface
/// of foot, pole and body with hips, waist, bust, shoulders and neck. It stands on y = 0 at the
/// origin, 1.52 m high, and faces +z.
TriangleMesh make_dress_form();

}  // namespace weft
