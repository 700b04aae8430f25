#pragma once

#include <cassert>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/contact/objects/contact_cloths.h"
#include "core/contact/objects/object_motion.h"
#include "core/contact/objects/object_shapes.h"
#include "core/executor.h"
#include "core/profile.h"
#include "core/types.h"

// How far each particle is from all objects, and which are so near that they need pairs.

namespace weft {

/// Clearances of all particles when pairs were collected, or later for those that need none.
template <class Real>
struct Clearance {
  bool collected = false;       ///< all that follows is known
  std::size_t collections = 0;  ///< since nothing was known
  Real smallest_gap = 0;        ///< left between cloth and objects after every step [m]
  std::vector<char> resting;    ///< 1 for each particle of a cloth that sleeps; empty if none does
  Vec3Array<Real> x;            ///< positions then [m]
  std::vector<Real> distance;   ///< lower bound of each one's distance from all objects [m]
  std::vector<Real> skin;       ///< how far each may move before pairs are collected again [m]
  std::vector<Real> span;       ///< how far its features' points may be from it [m]
  std::vector<char> near;       ///< whether each, or its edges and triangles, may touch an object
  std::vector<char> has_pairs;  ///< of each, with triangles of meshes
};

/// Features of a patch of cloth that are near objects, as ranges of their lists.
struct NearPatch {
  std::size_t patch = 0;
  IndexRange particles, edges, triangles;
};

/// What is near objects.
template <class Real>
struct NearFeatures {
  std::vector<char> active;  ///< of each particle: near, or joined to one that is
  std::vector<char> paired;  ///< in a candidate pair, or near an analytic shape
  std::vector<Index> particles, edges, triangles;
  std::vector<Index> place;  ///< of each active particle in their list
  std::vector<NearPatch> patches;
  std::vector<Vec3Array<Real>> x_own;  ///< active particles in the frame of each displaced mesh [m]
};

/// Brings each particle's clearance up to date. Measures it anew only where the old one, less what
/// it has moved since, no longer says that nothing is near.
template <class Real>
void measure_clearance(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                       const ObjectMotion<Real>& motion, const ClothState<Real>& state, Real dt,
                       Executor* executor, Clearance<Real>& clearance, Profile& profile);

/// Lists what is near. Particles joined to a near one may move as little as that; the others may go
/// as far as they are clear.
template <class Real>
void mark_near(const ContactCloths<Real>& cloths, Clearance<Real>& clearance,
               NearFeatures<Real>& near);

/// Measures the clearance of a particle that is in no list, and neither are its edges and
/// triangles.
/// @param reach  how far each particle may go before its rows are made again; the particle's and
///               its neighbours' are changed [m]
/// @return whether they are still clear of everything
template <class Real>
bool renew_clearance(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                     const ClothState<Real>& state, std::size_t particle, Real dt,
                     Clearance<Real>& clearance, std::vector<Real>& reach);

/// Transforms active particles to the frames of displaced meshes.
template <class Real>
void take_to_own(const ObjectShapes<Real>& shapes, const Vec3Array<Real>& x,
                 NearFeatures<Real>& near);

/// The particles in the frame of a mesh, after `take_to_own`; only the active ones may be read.
template <class Real>
const Vec3Array<Real>& in_frame_of(const ObjectShapes<Real>& shapes, const NearFeatures<Real>& near,
                                   std::size_t mesh, const Vec3Array<Real>& x) {
  assert(!shapes.mesh_frame(mesh).displaced || near.x_own[mesh].size() == x.size());
  return shapes.mesh_frame(mesh).displaced ? near.x_own[mesh] : x;
}

}  // namespace weft
