// Makes the rows of edges and triangles of the cloth with ridges and corners of meshes.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "core/contact/feature_pair.h"
#include "core/contact/objects/apart.h"
#include "core/contact/objects/bad_starts.h"
#include "core/contact/objects/constants.h"
#include "core/contact/objects/corners.h"
#include "core/contact/objects/object_rows.h"
#include "core/contact/objects/row_parts.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Beyond this distance two features cannot meet while the rows hold [m].
/// @param reach  of the cloth's feature [m]
template <class Real>
Real beyond(const ObjectRowSource<Real>& source, Real reach) {
  return reach + source.clearance.smallest_gap + source.cloths.thickness * Real(kRoomForPush);
}

/// What all pairs of one feature of the cloth have in common.
template <class Real>
struct ClothFeature {
  Index number = kNone;
  Real reach = 0;         ///< none of its particles goes beyond it while the rows hold [m]
  Real moved = 0;         ///< by a particle or the object since the collection, at most [m]
  Real far = -1;          ///< pairs that were farther apart then cannot meet [m]
  bool measured = false;  ///< what follows is known
  Corners<Real> lying;    ///< as it would lie on the object
};

/// Looks at a feature of the cloth, whose pairs follow each other in the list.
/// @param particles  of the feature
template <class Real, std::size_t Count>
ClothFeature<Real> look_at(Index number, const ObjectRowSource<Real>& source,
                           const RowScratch<Real>& scratch,
                           const std::array<Index, Count>& particles, std::size_t collider) {
  ClothFeature<Real> feature;
  feature.number = number;
  bool inside = false;
  for (const Index i : particles) {
    const auto p = at_index(i);
    feature.reach = std::max(feature.reach, source.reach[p]);
    feature.moved = std::max(feature.moved, scratch.moved[p]);
    inside |= is_inside(i, collider, scratch.inside);
  }
  feature.moved += source.shapes.frames[collider].travel_since_pairs;
  if (!inside) feature.far = source.cloths.thickness + feature.reach + feature.moved;
  return feature;
}

/// Measures the feature if that has not been done: most are too far from all that they are paired
/// with. Compiled for edges and for triangles: with spans of any length it would be called, not
/// inlined.
/// @param span  kEdgeSpan or kTriangleSpan
template <class Real, std::size_t Count>
void measure(const ObjectRowSource<Real>& source, const RowScratch<Real>& scratch,
             const std::array<Index, Count>& particles, double span, ClothFeature<Real>& feature) {
  if (feature.measured) return;
  feature.measured = true;
  // From a mesh they lie off by the thickness, whatever their gap is now: what carries in one step
  // and not in the next never rests.
  const Real off = thickness_at(source.cloths, particles[0]);
  feature.lying = corners_of(source, scratch.gap, particles).as_lying(span, off);
}

/// Beyond this distance a pair needs no row [m].
template <class Real>
Real farthest_row(const ObjectRowSource<Real>& source, const ClothFeature<Real>& feature,
                  bool responds) {
  return responds ? source.cloths.thickness + feature.reach : beyond(source, feature.reach);
}

/// Whether a pair could meet while the rows hold.
/// @param carried  particles alone keep the cloth off: it is only certified
template <class Real>
bool may_meet(const ObjectRowSource<Real>& source, const ClothFeature<Real>& feature,
              const ContactCandidate<Real>& pair, bool carried) {
  assert(feature.number == pair.cloth && pair.distance <= feature.far);
  return !carried || pair.distance - feature.moved <= beyond(source, feature.reach);
}

/// Calls visit(pair, feature, carried) for the pairs that could meet while the rows hold.
/// @param features,pairs  of one kind
/// @param rises           of what is paired with them
/// @param span            kEdgeSpan or kTriangleSpan
template <class Real, std::size_t Count, class Visit>
void for_pairs_that_may_meet(const ObjectRowSource<Real>& source, const RowScratch<Real>& scratch,
                             const std::vector<std::array<Index, Count>>& features,
                             std::span<const ContactCandidate<Real>> pairs,
                             const std::vector<Rise<Real>>& rises, double span,
                             std::size_t collider, Visit&& visit) {
  ClothFeature<Real> feature;
  for (const ContactCandidate<Real>& pair : pairs) {
    const std::array<Index, Count>& particles = features[at_index(pair.cloth)];
    if (pair.cloth != feature.number)
      feature = look_at(pair.cloth, source, scratch, particles, collider);
    if (pair.distance > feature.far) continue;
    measure(source, scratch, particles, span, feature);
    const bool carried = feature.lying.clear(rises[at_index(pair.feature)]);
    if (may_meet(source, feature, pair, carried)) visit(pair, feature, carried);
  }
}

/// Whether segments are farther from each other than `far` [m], rounding allowed for.
/// @param longest  that the second may be [m]
template <class Real>
bool are_apart(const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c, const Vec3<Real>& d,
               Real far, Real longest) {
  const SegmentPoints<Real> closest = closest_of_segments<Real>(a, b, c, d);
  const Real most = far + rounding_of_segments((b - a).norm(), longest);
  return (closest.p - closest.q).squaredNorm() > most * most;
}

/// Whether what lies on the inner side of a ridge or a corner of a closed mesh goes on outward: its
/// cloth is just leaving the object, or it is inside by itself, as where it cuts a ridge between
/// particles that are outside. What lies beside a blade is outside, and stays on its side.
/// @param particles,weights  of the point of the cloth there
template <class Real>
bool goes_outward(const ObjectRowSource<Real>& source, std::span<const Index> particles,
                  const std::array<Real, 3>& weights, std::size_t collider, RowList<Real>& rows) {
  if (still_leaves(cloth_of(source.cloths, particles[0]), collider, rows.exits)) return true;
  Vec3<Real> point = Vec3<Real>::Zero();
  for (std::size_t k = 0; k < particles.size(); ++k)
    point += source.state.x[at_index(particles[k])] * weights[k];
  return distance_from(source.shapes, collider, point) < 0;
}

/// Adds the rows of pairs of edges of the cloth with ridges of mesh m. @return closest points
/// computed
template <class Real>
std::uint64_t add_edges_on_mesh(const ObjectRowSource<Real>& source, std::size_t m,
                                std::span<const ContactCandidate<Real>> pairs,
                                const RowScratch<Real>& scratch, RowList<Real>& rows) {
  std::uint64_t tests = 0;
  const MeshShape<Real>& mesh = *source.shapes.meshes[m];
  const std::size_t collider = source.shapes.mesh_collider[m];
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  const Vec3Array<Real>& own = in_frame_of(source.shapes, source.near, m, source.state.x);
  const auto at = [&](Index i) { return in_double(own[at_index(i)]); };
  const auto corner = [&](Index v) { return in_double(mesh.positions[at_index(v)]); };
  const auto add = [&](const ContactCandidate<Real>& pair, const ClothFeature<Real>& feature,
                       bool carried) {
    const Edge& e = source.cloths.patches.edges[at_index(pair.cloth)];
    const std::size_t ridge = at_index(pair.feature);
    const MeshEdge& other = mesh.edges[ridge];
    ++tests;
    if (are_apart<Real>(own[at_index(e[0])], own[at_index(e[1])], mesh.positions[at_index(other.a)],
                        mesh.positions[at_index(other.b)], farthest_row(source, feature, !carried),
                        mesh.longest_edge))
      return;
    const PairSeparation<double> s = separate_pair<double>(
        PairKind::edge_edge, {at(e[0]), at(e[1]), corner(other.a), corner(other.b)});
    const Real distance = static_cast<Real>(s.gap);
    const bool responds = !carried && s.inside;
    if (distance > farthest_row(source, feature, responds)) return;
    const Vec3<Real>& outward = mesh.edge_normals[ridge];
    Vec3<Real> normal = s.normal.template cast<Real>();
    ContactBarrier<Real> barrier;
    barrier.distance = std::max(distance, Real(0));
    if (!(s.gap > kNoDirection)) normal = outward;
    const std::array<Real, 3> weights = {static_cast<Real>(s.weight[0]),
                                         static_cast<Real>(s.weight[1]), 0};
    if (mesh.closed && s.inside && normal.dot(outward) < 0 &&
        goes_outward<Real>(source, e, weights, collider, rows)) {
      normal = -normal;
      barrier.distance = -barrier.distance;
    }
    barrier.normal = frame.world_direction(normal);
    barrier.top = top_of(source.shapes, m, barrier.normal, {other.a, other.b});
    add_row(source, {e[0], e[1]}, weights, barrier, collider, responds, rows);
  };
  for_pairs_that_may_meet(source, scratch, source.cloths.patches.edges, pairs, mesh.edge_rises,
                          kEdgeSpan, collider, add);
  return tests;
}

/// Adds the rows of pairs of triangles of the cloth with corners of mesh m. @return closest points
/// computed
template <class Real>
std::uint64_t add_triangles_on_mesh(const ObjectRowSource<Real>& source, std::size_t m,
                                    std::span<const ContactCandidate<Real>> pairs,
                                    const RowScratch<Real>& scratch, RowList<Real>& rows) {
  std::uint64_t tests = 0;
  const MeshShape<Real>& mesh = *source.shapes.meshes[m];
  const std::size_t collider = source.shapes.mesh_collider[m];
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  const Vec3Array<Real>& own = in_frame_of(source.shapes, source.near, m, source.state.x);
  const auto at = [&](Index i) { return in_double(own[at_index(i)]); };
  const auto add = [&](const ContactCandidate<Real>& pair, const ClothFeature<Real>& feature,
                       bool carried) {
    const Triangle& t = source.cloths.patches.triangles[at_index(pair.cloth)];
    const std::size_t v = at_index(pair.feature);
    ++tests;
    const PairSeparation<double> s = separate_pair<double>(
        PairKind::vertex_triangle, {in_double(mesh.positions[v]), at(t[0]), at(t[1]), at(t[2])});
    const Real distance = static_cast<Real>(s.gap);
    const bool responds = !carried && s.inside;
    if (distance > farthest_row(source, feature, responds)) return;
    const Vec3<Real>& outward = mesh.vertex_normals[v];
    ContactBarrier<Real> barrier;
    barrier.distance = std::max(distance, Real(0));
    Vec3<Real> normal = s.gap > kNoDirection ? (-s.normal).template cast<Real>().eval() : outward;
    std::array<Real, 3> weights;
    for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(-s.weight[n + 1]);
    if (mesh.closed && s.inside && normal.dot(outward) < 0 &&
        goes_outward<Real>(source, t, weights, collider, rows)) {
      normal = -normal;
      barrier.distance = -barrier.distance;
    }
    barrier.normal = frame.world_direction(normal);
    barrier.top = top_of(source.shapes, m, barrier.normal, {pair.feature});
    add_row(source, {t[0], t[1], t[2]}, weights, barrier, collider, responds, rows);
  };
  for_pairs_that_may_meet(source, scratch, source.cloths.patches.triangles, pairs,
                          mesh.vertex_rises, kTriangleSpan, collider, add);
  return tests;
}

}  // namespace

template <class Real>
void add_features_on_meshes(const ObjectRowSource<Real>& source, Executor* executor,
                            RowScratch<Real>& scratch, RowList<Real>& rows, Profile& profile) {
  assert(scratch.inside.size() == source.state.x.size() && "rows of particles come first");
  const std::size_t meshes = source.shapes.meshes.size();
  const auto add = [&](const std::vector<ContactCandidate<Real>>& pairs, auto&& add_pairs) {
    profile[Stage::narrow_phase].work += make_in_parts(
        executor, pairs.size(), scratch, rows,
        [&](std::size_t first, std::size_t last, ObjectRowPart<Real>& part, RowList<Real>& into) {
          part.tests = add_pairs(std::span(pairs).subspan(first, last - first), into);
        });
  };
  for (std::size_t m = 0; m < meshes; ++m)
    add(source.pairs.of_mesh[m].edges, [&](auto pairs, RowList<Real>& into) {
      return add_edges_on_mesh<Real>(source, m, pairs, scratch, into);
    });
  for (std::size_t m = 0; m < meshes; ++m)
    add(source.pairs.of_mesh[m].triangles, [&](auto pairs, RowList<Real>& into) {
      return add_triangles_on_mesh<Real>(source, m, pairs, scratch, into);
    });
}

WEFT_INSTANTIATE_FUNCTIONS(add_features_on_meshes)

}  // namespace weft
