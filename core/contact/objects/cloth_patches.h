#pragma once

#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/neighbours.h"
#include "core/types.h"

// Patches of cloth in the search for objects.

namespace weft {

/// Neighbouring features of a cloth that are looked up together; each feature is in one patch. The
/// ranges count in the lists of ClothPatches.
struct ClothPatch {
  IndexRange particles, edges, triangles;
};

/// The features of all cloths in the order of their patches.
struct ClothPatches {
  std::vector<Index> particles;
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
  std::vector<ClothPatch> list;
  Neighbours neighbours;  ///< their edges count as given, not as in the list here
};

/// Groups triangles that are near each other by splitting at the median of the longest side, as
/// patches of up to eight. Particles go with the first triangle that they belong to, and edges with
/// their first end.
/// @param positions  of all particles, by which neighbours are found; any will do [m]
/// @param edges,triangles  of all cloths; ends and corners are numbers of particles. Those of no
///                         triangle get patches of their own.
template <class Real>
ClothPatches make_patches(const Vec3Array<Real>& positions, const std::vector<Edge>& edges,
                          const std::vector<Triangle>& triangles);

}  // namespace weft
