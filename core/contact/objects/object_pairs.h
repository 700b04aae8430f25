#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/objects/clearance.h"
#include "core/contact/objects/contact_cloths.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/object_shapes.h"
#include "core/contact/objects/pair_features.h"
#include "core/executor.h"
#include "core/profile.h"
#include "core/types.h"

// Pairs of features of cloths and meshes that may meet before the next collection.

namespace weft {

/// What the vector code finds near the features of a patch, as a FeatureTable has it.
template <class Real>
struct FoundFeatures {
  std::vector<Index> hits, ends;
  std::vector<Real> hits2, beyond2;
};

/// Room in which a part of the collection works.
template <class Real>
struct PairRoom {
  PairFeatures<Real> particles, edges, triangles;
  FoundFeatures<Real> near;
};

/// Pairs of the cloths' particles, edges and triangles with a mesh.
template <class Real>
struct MeshCandidates {
  std::vector<ContactCandidate<Real>> particles, edges, triangles;

  auto kinds() { return std::array{&particles, &edges, &triangles}; }
};

/// What a part of the collection finds.
template <class Real>
struct FoundPairs {
  MeshCandidates<Real> pairs;
  std::uint64_t tests = 0;
};

/// Candidate pairs of each mesh.
template <class Real>
struct ObjectPairs {
  std::vector<MeshCandidates<Real>> of_mesh;
  std::vector<std::vector<Neighbourhood<Real>>> neighbourhoods;  ///< of each mesh and patch
  std::vector<FoundPairs<Real>> found;                           ///< by each part
  std::vector<PairRoom<Real>> rooms;  ///< of each part; all use the first one where none waits
  FreeDistance<Real> free;
  std::vector<Real> fresh;  ///< clearances that the pairs have measured, of active particles [m]
};

/// @param meshes   their number
/// @param patches  of cloth
template <class Real>
ObjectPairs<Real> object_pairs(std::size_t meshes, std::size_t patches);

/// Forgets what meshes have about patches: how far that reaches decides how long pairs hold, and
/// with it the coming ticks.
template <class Real>
void forget_neighbourhoods(ObjectPairs<Real>& pairs);

/// Collects the pairs of near features: particles with triangles, edges with ridges and triangles
/// with corners of the meshes. Measures the clearances of particles on the way, and lets them go
/// farther than was asked for, as far as is known.
template <class Real>
void collect_pairs(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                   const NearFeatures<Real>& near, const Vec3Array<Real>& x, Executor* executor,
                   Clearance<Real>& clearance, ObjectPairs<Real>& pairs, Profile& profile);

/// Marks particles in a pair, or near an analytic shape: only these need rows that follow them
/// closely.
template <class Real>
void mark_paired(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                 const Clearance<Real>& clearance, const ObjectPairs<Real>& pairs,
                 NearFeatures<Real>& near);

}  // namespace weft
