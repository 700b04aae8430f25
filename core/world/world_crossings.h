#pragma once

#include "core/diagnostics/crossings.h"
#include "core/geometry/bvh.h"
#include "core/world/world.h"

namespace weft {

/// What crosses in a world now: edges through triangles, exactly.
struct WorldCrossings {
  Crossings cloths;   ///< of the cloths with themselves and each other
  Crossings objects;  ///< with boxes and meshes, and of triangles with the axes of rods

  /// All of them, those that only touch too.
  std::size_t total() const {
    return cloths.proper + cloths.touching + objects.proper + objects.touching;
  }
};

/// Counts them, objects where they are now. Balls and planes have neither edges nor axes: how deep
/// cloth is in those, World::deepest_penetration tells. All positions must be finite.
/// @param tree  over the triangles of the cloths, from an earlier count of the same world; built if
///              it is empty. Who counts often keeps one.
template <class Real>
WorldCrossings count_crossings(const World<Real>& world, Bvh<double>& tree);

}  // namespace weft
