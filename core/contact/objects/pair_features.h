#pragma once

#include <cstddef>
#include <vector>

#include "core/contact/objects/clearance.h"
#include "core/contact/objects/contact_cloths.h"
#include "core/contact/objects/feature_distance.h"
#include "core/contact/objects/mesh_shape.h"
#include "core/geometry/aabb.h"
#include "core/types.h"

// Features of cloths and meshes, loaded for the vector code that measures their distances.

namespace weft {

/// Features of a cloth's patch as the rows of a FeatureTable.
template <class Real>
struct PairFeatures {
  std::vector<Index> number;
  std::vector<Real> values;
  std::vector<Real> reach2;       ///< how near the other of a pair is [m^2]
  std::vector<Real> rounding;     ///< by which distances may come out too large [m]
  std::vector<Aabb<Real>> boxes;  ///< of each
  Aabb<Real> around;              ///< the reach of all
};

/// Blocks of a mesh's features, as a FeatureTable has them.
template <class Real>
struct NearBlocks {
  std::vector<Index> list;  ///< padded
  std::vector<Real> boxes;
};

/// What a mesh has about a patch of the cloth; valid until the patch leaves the box.
template <class Real>
struct Neighbourhood {
  Aabb<Real> box;
  NearBlocks<Real> triangles, ridges, corners;
};

/// How far each of the near features may go before it can touch what it has no pair with [m].
template <class Real>
struct FreeDistance {
  std::vector<Real> particle, edge, triangle;
};

/// One mesh in a collection: all that its parts read, and what they write, each for its own
/// patches.
template <class Real>
struct PairPass {
  const ContactCloths<Real>& cloths;
  const MeshShape<Real>& mesh;
  const NearFeatures<Real>& near;
  const Vec3Array<Real>& x;  ///< active particles in the frame of the mesh [m]
  Clearance<Real>& clearance;
  FreeDistance<Real>& free;
  std::vector<Real>& fresh;
};

/// Loads the near particles of a patch that may have pairs.
template <class Real>
void load_particles(const PairPass<Real>& pass, const NearPatch& patch, PairFeatures<Real>& into);

/// Loads the near edges of a patch that may have pairs.
template <class Real>
void load_edges(const PairPass<Real>& pass, const NearPatch& patch, PairFeatures<Real>& into);

/// Loads the near triangles of a patch that may have pairs.
template <class Real>
void load_triangles(const PairPass<Real>& pass, const NearPatch& patch, PairFeatures<Real>& into);

/// Lists the mesh's features about the neighbourhood's box.
template <class Real>
void list_blocks(const MeshShape<Real>& mesh, Neighbourhood<Real>& about);

}  // namespace weft
