// Patches of cloth look up the blocks of a mesh's features once for all their own; vector code then
// searches those whose boxes are within reach of a feature.

#include "core/contact/objects/object_pairs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/feature_distance.h"
#include "core/contact/parts.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

template <class Real>
using Measure = std::size_t (*)(const FeatureTable<Real>&);

/// Calls visit(feature, distance) for each of the mesh's features within reach of number f of the
/// cloth's.
template <class Real, class Visit>
void for_each_near(const FoundFeatures<Real>& found, const FeatureBlocks<Real>& mesh, std::size_t f,
                   Visit&& visit) {
  for (Index n = f == 0 ? 0 : found.ends[f - 1]; n < found.ends[f]; ++n) {
    const auto k = at_index(n);
    const Index feature = mesh.feature[at_index(found.hits[k])];
    // Empty lanes lie 1e9 m away; the reach of cloth that flies apart may include them all the
    // same.
    if (feature != kNone) visit(feature, std::sqrt(found.hits2[k]));
  }
}

/// How far every point of a box is from the outside of one around it, at least.
template <class Real>
Real distance_to_border(const Aabb<Real>& inner, const Aabb<Real>& outer) {
  return std::min((inner.lower - outer.lower).minCoeff(), (outer.upper - inner.upper).minCoeff());
}

/// Finds what of a mesh is within reach of features of the cloth, and how far each of these may go
/// before it can touch what is beyond its reach.
/// @param near  blocks of the mesh's features in the box
template <class Real>
void find_near(const PairFeatures<Real>& cloth, const FeatureBlocks<Real>& mesh,
               const NearBlocks<Real>& near, const Aabb<Real>& box, Real thickness,
               Measure<Real> measure, FoundFeatures<Real>& found, std::uint64_t& tests,
               std::vector<Real>& free) {
  static_assert(sizeof(Aabb<Real>) == 6 * sizeof(Real));
  assert(cloth.reach2.size() == cloth.number.size());
  const std::size_t count = cloth.number.size(), stride = near.list.size();
  if (count == 0) return;
  const std::size_t most = std::max(found.hits.size(), count * stride * kFeatureLanes);
  found.hits.resize(most);
  found.hits2.resize(most);
  found.ends.resize(count);
  found.beyond2.resize(count);
  const FeatureTable<Real> table{count,
                                 cloth.values.data(),
                                 cloth.boxes.front().lower.data(),
                                 cloth.reach2.data(),
                                 stride,
                                 near.list.data(),
                                 near.boxes.data(),
                                 mesh.values.data(),
                                 found.hits.data(),
                                 found.hits2.data(),
                                 found.ends.data(),
                                 found.beyond2.data()};
  tests += measure(table) * kFeatureLanes;
  for (std::size_t f = 0; f < count; ++f) {
    const Real beyond =
        std::min(std::sqrt(found.beyond2[f]), distance_to_border(cloth.boxes[f], box));
    Real& known = free[at_index(cloth.number[f])];
    known = std::min(known, beyond - cloth.rounding[f] - thickness);
  }
}

/// All pairs within reach of one kind of features.
template <class Real>
void pair_all(const PairFeatures<Real>& cloth, const FeatureBlocks<Real>& mesh,
              const NearBlocks<Real>& near, const Aabb<Real>& box, Real thickness,
              Measure<Real> measure, FoundFeatures<Real>& found, std::uint64_t& tests,
              std::vector<ContactCandidate<Real>>& pairs, std::vector<Real>& free) {
  find_near(cloth, mesh, near, box, thickness, measure, found, tests, free);
  for (std::size_t f = 0; f < cloth.number.size(); ++f) {
    for_each_near(found, mesh, f, [&](Index feature, Real distance) {
      pairs.push_back({cloth.number[f], feature, distance - cloth.rounding[f]});
    });
  }
}

/// The nearest of the triangles that a particle is paired with. Those that rounding leaves in doubt
/// are measured: one that only comes out nearest may tell the wrong side.
/// @param most  distance, less its rounding, beyond which none is the nearest [m]
template <class Real>
MeshDistance<Real> nearest_of(std::span<const ContactCandidate<Real>> pairs, Real most,
                              const MeshShape<Real>& mesh, const Vec3<Real>& x) {
  MeshDistance<Real> nearest;
  for (const ContactCandidate<Real>& pair : pairs) {
    if (pair.distance > most) continue;
    const MeshDistance<Real> d = distance_to_triangle(mesh, pair.feature, x);
    if (nearest.triangle == kNone || d.size < nearest.size) nearest = d;
  }
  return nearest;
}

/// Particles against triangles; measures their clearance on the way.
template <class Real>
void pair_particles(const PairPass<Real>& pass, const Neighbourhood<Real>& about,
                    PairRoom<Real>& room, FoundPairs<Real>& found) {
  const auto& [cloths, mesh, near, x, c, free, fresh] = pass;
  const PairFeatures<Real>& particles = room.particles;
  std::vector<ContactCandidate<Real>>& pairs = found.pairs.particles;
  find_near<Real>(particles, mesh.triangle_blocks, about.triangles, about.box, cloths.thickness,
                  measure_points_from_triangles, room.near, found.tests, free.particle);
  for (std::size_t f = 0; f < particles.number.size(); ++f) {
    const auto p = at_index(particles.number[f]);
    const Real rounding = particles.rounding[f];
    const std::size_t first = pairs.size();
    Real least = std::numeric_limits<Real>::infinity();
    for_each_near(room.near, mesh.triangle_blocks, f, [&](Index triangle, Real distance) {
      pairs.push_back({particles.number[f], triangle, distance - rounding});
      least = std::min(least, distance);
    });
    MeshDistance<Real> nearest;
    if (pairs.size() > first) {
      nearest = nearest_of<Real>({pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end()},
                                 least + rounding, mesh, x[p]);
    } else if (mesh.closed && c.distance[p] < 0) {
      // Deep inside a solid nothing is within reach, yet the particle must find its way out.
      nearest = distance_to_mesh(mesh, x[p], Real(kFarAway));
      if (nearest.triangle != kNone && nearest.distance < 0)
        pairs.push_back({particles.number[f], nearest.triangle, Real(0)});
      else
        nearest.triangle = kNone;
    }
    if (nearest.triangle == kNone) {
      fresh[p] = std::min(fresh[p], cloths.thickness + c.skin[p]);
      continue;
    }
    c.has_pairs[p] = 1;
    fresh[p] = std::min(fresh[p], nearest.distance - rounding);
  }
}

/// All pairs of one patch with one mesh.
template <class Real>
void pair_patch(const PairPass<Real>& pass, const NearPatch& patch, Neighbourhood<Real>& about,
                PairRoom<Real>& room, FoundPairs<Real>& found) {
  load_particles(pass, patch, room.particles);
  load_edges(pass, patch, room.edges);
  load_triangles(pass, patch, room.triangles);
  Aabb<Real> around = room.particles.around;
  around.add(room.edges.around);
  around.add(room.triangles.around);
  if (!about.box.contains(around)) {
    about.box = around.grown(pass.mesh.triangle_size * Real(kNeighbourhoodMargin));
    list_blocks(pass.mesh, about);
  }
  const Real thickness = pass.cloths.thickness;
  pair_particles(pass, about, room, found);
  pair_all<Real>(room.edges, pass.mesh.ridge_blocks, about.ridges, about.box, thickness,
                 measure_segments, room.near, found.tests, found.pairs.edges, pass.free.edge);
  pair_all<Real>(room.triangles, pass.mesh.corner_blocks, about.corners, about.box, thickness,
                 measure_triangles_from_points, room.near, found.tests, found.pairs.triangles,
                 pass.free.triangle);
}

/// Joins what the parts have found for a mesh, in their order.
template <class Real>
void join_found(std::size_t mesh, ObjectPairs<Real>& pairs, Profile& profile) {
  for (std::size_t kind = 0; kind < 3; ++kind) {
    std::vector<ContactCandidate<Real>>& all = *pairs.of_mesh[mesh].kinds()[kind];
    all.clear();
    for (FoundPairs<Real>& found : pairs.found) {
      const std::vector<ContactCandidate<Real>>& part = *found.pairs.kinds()[kind];
      all.insert(all.end(), part.begin(), part.end());
    }
    profile[Stage::broad_phase].work += all.size();
  }
  for (const FoundPairs<Real>& found : pairs.found)
    profile[Stage::narrow_phase].work += found.tests;
}

/// Calls work(particle) for each near particle, which does not depend on others.
template <class Real, class Work>
void for_near_particles(const NearFeatures<Real>& near, Executor* executor, Work&& work) {
  const std::size_t count = near.particles.size();
  run_parts(executor, count, parts_of(count, kMadeAtLeast),
            [&](std::size_t, std::size_t first, std::size_t last) {
              for (std::size_t n = first; n < last; ++n) work(at_index(near.particles[n]));
            });
}

/// Lets particles go farther than was asked for, as far as is known now: until one of their
/// features may touch what it has no pair with.
template <class Real>
void extend_skins(const ContactCloths<Real>& cloths, const NearFeatures<Real>& near,
                  FreeDistance<Real>& free, Clearance<Real>& clearance) {
  const auto limit = [&](Index i, Real most) {
    Real& known = free.particle[at_index(i)];
    known = std::min(known, most);
  };
  for (const Index e : near.edges) {
    for (const Index i : cloths.patches.edges[at_index(e)]) limit(i, free.edge[at_index(e)]);
  }
  for (const Index t : near.triangles) {
    for (const Index i : cloths.patches.triangles[at_index(t)])
      limit(i, free.triangle[at_index(t)]);
  }
  for (const Index i : near.particles) {
    const auto p = at_index(i);
    Real most = free.particle[p];
    // A particle that is only joined to near ones has features that are in no list.
    if (!clearance.near[p])
      most = std::min(most, clearance.distance[p] - cloths.thickness - clearance.span[p]);
    Real& skin = clearance.skin[p];
    skin = std::max(skin, std::min(most, skin * Real(kMostSkin)));
  }
}

}  // namespace

template <class Real>
ObjectPairs<Real> object_pairs(std::size_t meshes, std::size_t patches) {
  ObjectPairs<Real> pairs;
  pairs.of_mesh.resize(meshes);
  pairs.found.resize(kContactParts);
  pairs.rooms.resize(kContactParts);
  pairs.neighbourhoods.assign(meshes, std::vector<Neighbourhood<Real>>(patches));
  return pairs;
}

template <class Real>
void forget_neighbourhoods(ObjectPairs<Real>& pairs) {
  for (std::vector<Neighbourhood<Real>>& of_mesh : pairs.neighbourhoods) {
    for (Neighbourhood<Real>& about : of_mesh) about.box = {};
  }
}

template <class Real>
void collect_pairs(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                   const NearFeatures<Real>& near, const Vec3Array<Real>& x, Executor* executor,
                   Clearance<Real>& clearance, ObjectPairs<Real>& pairs, Profile& profile) {
  assert(pairs.of_mesh.size() == shapes.meshes.size());
  const Real thickness = cloths.thickness;
  std::vector<Real>& fresh = pairs.fresh;
  fresh.resize(x.size());
  for_near_particles(near, executor, [&](std::size_t p) {
    fresh[p] = analytic_clearance(shapes, x[p], thickness + clearance.skin[p]);
    clearance.has_pairs[p] = 0;
  });
  constexpr Real kUnlimited = std::numeric_limits<Real>::infinity();
  pairs.free.particle.assign(x.size(), kUnlimited);
  pairs.free.edge.assign(cloths.patches.edges.size(), kUnlimited);
  pairs.free.triangle.assign(cloths.patches.triangles.size(), kUnlimited);
  const std::size_t count = near.patches.size();
  for (std::size_t m = 0; m < shapes.meshes.size(); ++m) {
    const PairPass<Real> pass{cloths,    *shapes.meshes[m], near, in_frame_of(shapes, near, m, x),
                              clearance, pairs.free,        fresh};
    run_parts(executor, count, kContactParts,
              [&](std::size_t c, std::size_t first, std::size_t last) {
                FoundPairs<Real>& found = pairs.found[c];
                PairRoom<Real>& room = pairs.rooms[executor ? c : 0];
                for (auto* list : found.pairs.kinds()) list->clear();
                found.tests = 0;
                for (std::size_t n = first; n < last; ++n) {
                  stop_point();
                  const NearPatch& patch = near.patches[n];
                  pair_patch(pass, patch, pairs.neighbourhoods[m][patch.patch], room, found);
                }
              });
    join_found(m, pairs, profile);
  }
  // The pairs have measured the clearance, up to the reach; both this and the old one are bounds.
  for_near_particles(near, executor, [&](std::size_t p) {
    Real& distance = clearance.distance[p];
    distance = fresh[p] < thickness + clearance.skin[p] ? fresh[p] : std::max(distance, fresh[p]);
  });
  extend_skins(cloths, near, pairs.free, clearance);
}

template <class Real>
void mark_paired(const ContactCloths<Real>& cloths, const ObjectShapes<Real>& shapes,
                 const Clearance<Real>& clearance, const ObjectPairs<Real>& pairs,
                 NearFeatures<Real>& near) {
  const ClothPatches& patches = cloths.patches;
  near.paired.assign(near.active.size(), 0);
  const auto mark = [&](Index i) { near.paired[at_index(i)] = 1; };
  for (const Index i : near.particles) {
    const auto p = at_index(i);
    if (clearance.distance[p] <= cloths.thickness + clearance.skin[p]) mark(i);
  }
  for (const MeshCandidates<Real>& of_mesh : pairs.of_mesh) {
    for (const auto& pair : of_mesh.particles) mark(pair.cloth);
    for (const auto& pair : of_mesh.edges) {
      for (const Index i : patches.edges[at_index(pair.cloth)]) mark(i);
    }
    for (const auto& pair : of_mesh.triangles) {
      for (const Index i : patches.triangles[at_index(pair.cloth)]) mark(i);
    }
  }
  if (shapes.rounds.empty()) return;
  // Edges and triangles meet round shapes without pairs, so all near ones may.
  for (const Index e : near.edges) {
    for (const Index i : patches.edges[at_index(e)]) mark(i);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(object_pairs, forget_neighbourhoods, collect_pairs, mark_paired)

}  // namespace weft
