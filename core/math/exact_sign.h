#pragma once

#include "core/types.h"

// Exact geometric predicates.

namespace weft {

/// Sign of the volume of tetrahedron a b c d: +1 if d lies below the plane through a, b, c, seen
/// from where these run counter-clockwise; -1 above, 0 on it. Exact for all finite coordinates
/// whose products neither overflow nor underflow: floating point where its error bound allows,
/// exact expansions otherwise (Shewchuk 1997).
int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

}  // namespace weft
