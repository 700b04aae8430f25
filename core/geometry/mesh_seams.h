#pragma once

#include "core/geometry/mesh_file.h"

// Seams of a mesh whose two sides differ by rounding.

namespace weft {

/// Merges vertices on the border that lie closer than kOpenSeam of the border's mean edge, or than
/// two roundings of float, into the first of them: a tube whose last column was computed at an
/// angle of 2 pi is closed. What belongs to one triangle stays apart. Where the two had different
/// uv, `corner_uv` keeps both.
void close_seams(MeshFile& file);

}  // namespace weft
