#pragma once

#include <cassert>
#include <vector>

#include "core/contact/objects/object_rows.h"
#include "core/types.h"

// Cloth that starts inside an object: found, and led out as a whole.

namespace weft {

/// What particles are inside of: the number of a collider, or one of these.
inline constexpr Index kOutside = -1, kInsideSeveral = -2;

/// Notes that a particle is inside a collider.
inline void note_inside(Index particle, std::size_t collider, std::vector<Index>& inside) {
  assert(at_index(particle) < inside.size());
  Index& known = inside[at_index(particle)];
  const auto number = static_cast<Index>(collider);
  known = known == kOutside || known == number ? number : kInsideSeveral;
}

inline bool is_inside(Index particle, std::size_t collider, const std::vector<Index>& inside) {
  assert(at_index(particle) < inside.size());
  const Index known = inside[at_index(particle)];
  return known == static_cast<Index>(collider) || known == kInsideSeveral;
}

/// Whether a cloth is just leaving an object in which it started: what cuts a corner of that goes
/// on outward. Counts one more of its features that are inside.
template <class Real>
bool still_leaves(Index cloth, std::size_t collider, std::vector<BadStart<Real>>& exits);

/// Adds the row of a particle inside a solid. Pressed in a little, it goes back to the nearest
/// surface. What started inside is led out in one direction with all of the cloth that is inside
/// too: the ways to the nearest surface would part it on two sides.
/// @param normal    out of the nearest surface
/// @param distance  from it, negative [m]
template <class Real>
void add_inside(const ObjectRowSource<Real>& source, Index particle, const Vec3<Real>& normal,
                Real distance, std::size_t collider, std::vector<Index>& inside,
                RowList<Real>& rows);

}  // namespace weft
