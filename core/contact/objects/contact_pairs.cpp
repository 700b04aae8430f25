// The broad phase of Contact, second half: which features of the cloth are near which of a mesh.
// Patches of the cloth look up the mesh's triangles once for all their features; vector code then
// measures every feature against everything found.

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/objects/contact.h"
#include "core/contact/objects/feature_distance.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

std::size_t padded(std::size_t count) {
  return (count + kFeaturePadding - 1) / kFeaturePadding * kFeaturePadding;
}

/// Puts vector k of feature n into columns.
template <class Real>
void put(const Vec3<Real>& v, std::size_t k, std::size_t stride, std::size_t n,
         std::vector<Real>& columns) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    columns[(3 * k + axis) * stride + n] = v[static_cast<Index>(axis)];
}

/// How far around a patch its neighbourhood reaches, in sizes of the mesh's triangles: more of it
/// is looked up less often, but has more to measure.
constexpr double kNeighbourhoodMargin = 0.3;

/// Calls visit(n, distance) for each of the `others` of row f that are within reach.
template <class Real, class Visit>
void for_each_near(const FeatureTable<Real>& table, std::size_t f, std::size_t others,
                   Visit&& visit) {
  if (table.nearest2[f] > table.reach2[f]) return;
  const Real* row = table.distance2 + f * table.stride;
  for (std::size_t n = 0; n < others; ++n) {
    if (row[n] <= table.reach2[f]) visit(n, std::sqrt(row[n]));
  }
}

/// How far every point of a box is from the outside of one around it, at least.
template <class Real>
Real distance_to_border(const Aabb<Real>& inner, const Aabb<Real>& outer) {
  return std::min((inner.lower - outer.lower).minCoeff(), (outer.upper - inner.upper).minCoeff());
}

}  // namespace

/// Particles against triangles, edges against ridges and triangles against corners of the meshes;
/// measures the clearance of particles on the way.
template <class Real>
void Contact<Real>::collect_pairs(const ClothState<Real>& state, Profile& profile) {
  fresh_clearance_.resize(state.x.size());
  for (const Index i : active_particles_) {
    const auto p = static_cast<std::size_t>(i);
    fresh_clearance_[p] = analytic_clearance(state.x[p], thickness_ + skin_[p]);
    has_pairs_[p] = 0;
  }
  constexpr Real kUnlimited = std::numeric_limits<Real>::infinity();
  particle_room_.assign(state.x.size(), kUnlimited);
  edge_room_.assign(patches_.edges.size(), kUnlimited);
  triangle_room_.assign(patches_.triangles.size(), kUnlimited);
  take_to_own(state.x);
  const std::size_t count = near_patches_.size();
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    run_chunks(executor_, kChunks, [&](int chunk) {
      const auto c = static_cast<std::size_t>(chunk);
      Found& found = found_[c];
      for (Pairs* pairs : {&found.particle_pairs, &found.edge_pairs, &found.triangle_pairs})
        pairs->clear();
      found.tests = 0;
      for (std::size_t n = count * c / kChunks; n < count * (c + 1) / kChunks; ++n) {
        stop_point();
        pair_patch(m, near_patches_[n], own, found);
      }
    });
    join_found(m, profile);
  }
  // The pairs have measured the clearance, up to the reach; both this and the old one are bounds.
  for (const Index i : active_particles_) {
    const auto p = static_cast<std::size_t>(i);
    const Real fresh = fresh_clearance_[p];
    clearance_[p] = fresh < thickness_ + skin_[p] ? fresh : std::max(clearance_[p], fresh);
  }
}

/// Joins what the chunks have found, in their order.
template <class Real>
void Contact<Real>::join_found(std::size_t mesh, Profile& profile) {
  const auto join = [&](Pairs Found::*pairs, Pairs& into) {
    into.clear();
    for (const Found& found : found_)
      into.insert(into.end(), (found.*pairs).begin(), (found.*pairs).end());
    profile[Stage::broad_phase].work += into.size();
  };
  join(&Found::particle_pairs, particle_pairs_[mesh]);
  join(&Found::edge_pairs, edge_pairs_[mesh]);
  join(&Found::triangle_pairs, triangle_pairs_[mesh]);
  for (const Found& found : found_) profile[Stage::narrow_phase].work += found.tests;
}

template <class Real>
void Contact<Real>::Features::add(Index feature, Real reach, Real error, const Aabb<Real>& box,
                                  std::initializer_list<Vec3<Real>> vectors) {
  number.push_back(feature);
  reach2.push_back(reach * reach);
  rounding.push_back(error);
  boxes.push_back(box);
  around.add(box.grown(reach));
  for (const Vec3<Real>& v : vectors) values.insert(values.end(), {v[0], v[1], v[2]});
}

template <class Real>
void Contact<Real>::Features::clear() {
  number.clear();
  values.clear();
  reach2.clear();
  rounding.clear();
  boxes.clear();
  around = {};
}

/// The near particles of a patch that may have pairs.
template <class Real>
void Contact<Real>::load_particles(const MeshShape<Real>& mesh, const NearPatch& near,
                                   const Vec3Array<Real>& x, Features& into) {
  into.clear();
  for (Index k = near.particles.first; k < near.particles.end(); ++k) {
    const Index i = active_particles_[static_cast<std::size_t>(k)];
    const auto p = static_cast<std::size_t>(i);
    const Real reach = thickness_ + skin_[p];
    if (clearance_[p] > reach) {
      particle_room_[p] = clearance_[p] - thickness_;
      continue;
    }
    Aabb<Real> box;
    box.add(x[p]);
    into.add(i, reach, mesh.rounding, box, {x[p]});
  }
}

/// The near edges of a patch that may have pairs.
template <class Real>
void Contact<Real>::load_edges(const MeshShape<Real>& mesh, const NearPatch& near,
                               const Vec3Array<Real>& x, Features& into) {
  into.clear();
  for (Index k = near.edges.first; k < near.edges.end(); ++k) {
    const Index e = near_edges_[static_cast<std::size_t>(k)];
    const Edge& ends = patches_.edges[static_cast<std::size_t>(e)];
    const auto i = static_cast<std::size_t>(ends[0]), j = static_cast<std::size_t>(ends[1]);
    const Real reach = thickness_ + std::max(skin_[i], skin_[j]);
    const Vec3<Real> way = x[j] - x[i];
    // No point of the edge is nearer than this, by the clearances of its ends.
    const Real length = way.norm(), clear = (clearance_[i] + clearance_[j] - length) / 2;
    if (clear > reach) {
      edge_room_[static_cast<std::size_t>(e)] = clear - thickness_;
      continue;
    }
    Aabb<Real> box;
    box.add(x[i]);
    box.add(x[j]);
    into.add(e, reach, rounding_of_segments(length, mesh.longest_edge), box, {x[i], way});
  }
}

/// The near triangles of a patch that may have pairs.
template <class Real>
void Contact<Real>::load_triangles(const NearPatch& near, const Vec3Array<Real>& x,
                                   Features& into) {
  into.clear();
  for (Index k = near.triangles.first; k < near.triangles.end(); ++k) {
    const Index t = near_triangles_[static_cast<std::size_t>(k)];
    const Triangle& corners = patches_.triangles[static_cast<std::size_t>(t)];
    const auto a = static_cast<std::size_t>(corners[0]), b = static_cast<std::size_t>(corners[1]),
               c = static_cast<std::size_t>(corners[2]);
    const Real reach = thickness_ + std::max({skin_[a], skin_[b], skin_[c]});
    const Real clear = std::min({clearance_[a], clearance_[b], clearance_[c]}) -
                       std::max({span_[a], span_[b], span_[c]});
    if (clear > reach) {
      triangle_room_[static_cast<std::size_t>(t)] = clear - thickness_;
      continue;
    }
    Aabb<Real> box;
    for (const std::size_t corner : {a, b, c}) box.add(x[corner]);
    const Vec3<Real> ab = x[b] - x[a], ac = x[c] - x[a];
    const Real longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    const Real error = rounding_of_triangle(std::sqrt(longest2), ab.cross(ac).norm());
    into.add(t, reach, error, box, {x[a], ab, ac});
  }
}

/// The mesh's features about the neighbourhood's box, as columns.
template <class Real>
void Contact<Real>::load_mesh(const MeshShape<Real>& mesh, Neighbourhood& about) const {
  Features &triangles = about.triangles, &edges = about.edges, &vertices = about.vertices;
  for (Features* features : {&triangles, &edges, &vertices}) features->number.clear();
  const auto take = [](const OwnedFeatures& owned, std::size_t t, std::vector<Index>& into) {
    into.insert(into.end(), owned.list.begin() + owned.first[t],
                owned.list.begin() + owned.first[t + 1]);
  };
  mesh.triangle_tree.for_each_overlap(about.box, [&](Index t) {
    triangles.number.push_back(t);
    take(mesh.sharp_edges, static_cast<std::size_t>(t), edges.number);
    take(mesh.sharp_vertices, static_cast<std::size_t>(t), vertices.number);
  });
  const auto at = [&](Index v) { return mesh.positions[static_cast<std::size_t>(v)]; };
  // Padding is far away, yet near enough for its square to be a number.
  constexpr Real kFar = Real(1e9);
  std::size_t stride = padded(triangles.number.size());
  triangles.values.assign(kTriangleNumbers * stride, kFar);
  for (std::size_t n = 0; n < triangles.number.size(); ++n) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(triangles.number[n])];
    put<Real>(at(t[0]), 0, stride, n, triangles.values);
    put<Real>(at(t[1]) - at(t[0]), 1, stride, n, triangles.values);
    put<Real>(at(t[2]) - at(t[0]), 2, stride, n, triangles.values);
  }
  prepare_triangles(stride, triangles.values.data());
  stride = padded(edges.number.size());
  edges.values.assign(6 * stride, kFar);
  for (std::size_t n = 0; n < edges.number.size(); ++n) {
    const MeshEdge& e = mesh.edges[static_cast<std::size_t>(edges.number[n])];
    put<Real>(at(e.a), 0, stride, n, edges.values);
    put<Real>(at(e.b) - at(e.a), 1, stride, n, edges.values);
  }
  stride = padded(vertices.number.size());
  vertices.values.assign(3 * stride, kFar);
  for (std::size_t n = 0; n < vertices.number.size(); ++n)
    put<Real>(at(vertices.number[n]), 0, stride, n, vertices.values);
}

/// All pairs of one patch with one mesh.
/// @param x  particles in the frame of the mesh
template <class Real>
void Contact<Real>::pair_patch(std::size_t m, const NearPatch& near, const Vec3Array<Real>& x,
                               Found& found) {
  const MeshShape<Real>& mesh = meshes_[m];
  load_particles(mesh, near, x, found.particles);
  load_edges(mesh, near, x, found.edges);
  load_triangles(near, x, found.triangles);
  Aabb<Real> around = found.particles.around;
  around.add(found.edges.around);
  around.add(found.triangles.around);
  Neighbourhood& about = neighbourhoods_[m][near.patch];
  if (!about.box.contains(around)) {
    about.box = around.grown(mesh.triangle_size * Real(kNeighbourhoodMargin));
    load_mesh(mesh, about);
  }
  pair_particles(mesh, x, about, found);
  pair_all(found.edges, about.edges, about.box, measure_segments, found, found.edge_pairs,
           edge_room_);
  pair_all(found.triangles, about.vertices, about.box, measure_triangles_from_points, found,
           found.triangle_pairs, triangle_room_);
}

/// Measures all of `cloth` against all of `mesh`, and how far each of the cloth's may go before it
/// can touch what is beyond its reach.
template <class Real>
FeatureTable<Real> Contact<Real>::measure_all(const Features& cloth, const Features& mesh,
                                              const Aabb<Real>& box, Measure measure, Found& found,
                                              std::vector<Real>& room) const {
  FeatureTable<Real> table;
  table.count = cloth.number.size();
  table.stride = padded(mesh.number.size());
  found.distance2.resize(table.count * (table.stride + 2));
  table.cloth = cloth.values.data();
  table.mesh = mesh.values.data();
  table.reach2 = cloth.reach2.data();
  table.distance2 = found.distance2.data();
  table.nearest2 = table.distance2 + table.count * table.stride;
  table.beyond2 = table.nearest2 + table.count;
  measure(table);
  found.tests += table.count * mesh.number.size();
  for (std::size_t f = 0; f < table.count; ++f) {
    const Real beyond =
        std::min(std::sqrt(table.beyond2[f]), distance_to_border(cloth.boxes[f], box));
    Real& known = room[static_cast<std::size_t>(cloth.number[f])];
    known = std::min(known, beyond - cloth.rounding[f] - thickness_);
  }
  return table;
}

/// All pairs within reach of one kind of features.
template <class Real>
void Contact<Real>::pair_all(const Features& cloth, const Features& mesh, const Aabb<Real>& box,
                             Measure measure, Found& found, Pairs& pairs, std::vector<Real>& room) {
  const FeatureTable<Real> table = measure_all(cloth, mesh, box, measure, found, room);
  for (std::size_t f = 0; f < table.count; ++f) {
    for_each_near(table, f, mesh.number.size(), [&](std::size_t n, Real distance) {
      pairs.push_back({cloth.number[f], mesh.number[n], distance - cloth.rounding[f]});
    });
  }
}

/// Particles against triangles; measures their clearance on the way.
template <class Real>
void Contact<Real>::pair_particles(const MeshShape<Real>& mesh, const Vec3Array<Real>& x,
                                   const Neighbourhood& about, Found& found) {
  const Features &particles = found.particles, &triangles = about.triangles;
  Pairs& pairs = found.particle_pairs;
  const FeatureTable<Real> table = measure_all(
      particles, triangles, about.box, measure_points_from_triangles, found, particle_room_);
  for (std::size_t f = 0; f < table.count; ++f) {
    const auto p = static_cast<std::size_t>(particles.number[f]);
    ContactCandidate<Real> best;
    best.feature = kNone;
    for_each_near(table, f, triangles.number.size(), [&](std::size_t n, Real distance) {
      pairs.push_back({particles.number[f], triangles.number[n], distance - particles.rounding[f]});
      if (best.feature == kNone || distance < best.distance) best = pairs.back();
    });
    MeshDistance<Real> nearest;
    if (best.feature != kNone) {
      nearest = distance_to_triangle(mesh, best.feature, x[p]);
    } else if (mesh.closed && clearance_[p] < 0) {
      // Deep inside a solid nothing is within reach, yet the particle must find its way out.
      nearest = distance_to_mesh(mesh, x[p], Real(1000));
      if (nearest.triangle != kNone && nearest.distance < 0)
        pairs.push_back({particles.number[f], nearest.triangle, Real(0)});
      else
        nearest.triangle = kNone;
    }
    if (nearest.triangle == kNone) {
      fresh_clearance_[p] = std::min(fresh_clearance_[p], thickness_ + skin_[p]);
      continue;
    }
    has_pairs_[p] = 1;
    fresh_clearance_[p] = std::min(fresh_clearance_[p], nearest.distance - particles.rounding[f]);
  }
}

/// Lets particles go farther than was looked for, as far as is known now: until one of their
/// features may touch what it has no pair with.
template <class Real>
void Contact<Real>::extend_skins() {
  constexpr Real kMost = 4;  // times the skin: far ones shall not stay in the lists for ever
  const auto limit = [&](Index i, Real room) {
    Real& known = particle_room_[static_cast<std::size_t>(i)];
    known = std::min(known, room);
  };
  for (const Index e : near_edges_) {
    for (const Index i : patches_.edges[static_cast<std::size_t>(e)])
      limit(i, edge_room_[static_cast<std::size_t>(e)]);
  }
  for (const Index t : near_triangles_) {
    for (const Index i : patches_.triangles[static_cast<std::size_t>(t)])
      limit(i, triangle_room_[static_cast<std::size_t>(t)]);
  }
  for (const Index i : active_particles_) {
    const auto p = static_cast<std::size_t>(i);
    Real room = particle_room_[p];
    // Who is only joined to near ones has features that are in no list.
    if (!near_[p]) room = std::min(room, clearance_[p] - thickness_ - span_[p]);
    skin_[p] = std::max(skin_[p], std::min(room, skin_[p] * kMost));
  }
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template void Contact<Real>::collect_pairs(const ClothState<Real>&, Profile&);                 \
  template void Contact<Real>::join_found(std::size_t, Profile&);                                \
  template void Contact<Real>::Features::clear();                                                \
  template void Contact<Real>::Features::add(Index, Real, Real, const Aabb<Real>&,               \
                                             std::initializer_list<Vec3<Real>>);                 \
  template void Contact<Real>::load_particles(const MeshShape<Real>&, const NearPatch&,          \
                                              const Vec3Array<Real>&, Features&);                \
  template void Contact<Real>::load_edges(const MeshShape<Real>&, const NearPatch&,              \
                                          const Vec3Array<Real>&, Features&);                    \
  template void Contact<Real>::load_triangles(const NearPatch&, const Vec3Array<Real>&,          \
                                              Features&);                                        \
  template void Contact<Real>::load_mesh(const MeshShape<Real>&, Neighbourhood&) const;          \
  template void Contact<Real>::pair_patch(std::size_t, const NearPatch&, const Vec3Array<Real>&, \
                                          Found&);                                               \
  template FeatureTable<Real> Contact<Real>::measure_all(                                        \
      const Features&, const Features&, const Aabb<Real>&, Measure, Found&, std::vector<Real>&)  \
      const;                                                                                     \
  template void Contact<Real>::pair_all(const Features&, const Features&, const Aabb<Real>&,     \
                                        Measure, Found&, Pairs&, std::vector<Real>&);            \
  template void Contact<Real>::pair_particles(const MeshShape<Real>&, const Vec3Array<Real>&,    \
                                              const Neighbourhood&, Found&);                     \
  template void Contact<Real>::extend_skins();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
