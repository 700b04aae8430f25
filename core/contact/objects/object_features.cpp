// Makes the rows of edges and triangles of the cloth with ridges and corners of meshes.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "core/contact/feature_pair.h"
#include "core/contact/objects/apart.h"
#include "core/contact/objects/bad_starts.h"
#include "core/contact/objects/constants.h"
#include "core/contact/objects/corners.h"
#include "core/contact/objects/object_rows.h"

namespace weft {
namespace {

/// What is to be done about features of the cloth and a mesh that could meet.
template <class Real>
struct ContactLook {
  Real reach = 0;        ///< none of the cloth's particles goes beyond it [m]
  bool carried = false;  ///< particles alone keep the cloth off: it is only certified
};

/// Beyond this distance two features cannot meet while the rows hold [m].
/// @param reach  of the cloth's feature [m]
template <class Real>
Real beyond(const ObjectRowSource<Real>& source, Real reach) {
  return reach + source.clearance.smallest_gap + source.cloths.thickness * Real(kRoomForPush);
}

/// What a pair of features of the cloth and a mesh needs; nothing if they cannot meet while the
/// rows hold. Compiled for edges and for triangles, as each pair comes here: with spans of any
/// length it would be called, not inlined.
/// @param particles  of the cloth's feature
/// @param span       kEdgeSpan or kTriangleSpan
/// @param rise       of the mesh about its feature
template <class Real, std::size_t Count>
std::optional<ContactLook<Real>> look_at(const ObjectRowSource<Real>& source,
                                         const RowScratch<Real>& scratch,
                                         const ContactCandidate<Real>& pair,
                                         const std::array<Index, Count>& particles, double span,
                                         const Rise<Real>& rise, std::size_t collider) {
  const auto most = [&](const std::vector<Real>& values) {
    Real largest = values[static_cast<std::size_t>(particles[0])];
    for (const Index i : particles)
      largest = std::max(largest, values[static_cast<std::size_t>(i)]);
    return largest;
  };
  const Real reach = most(source.reach);
  const Real bound =
      pair.distance - most(scratch.moved) - source.shapes.frames[collider].travel_since_pairs;
  if (bound > source.cloths.thickness + reach) return {};
  if (std::any_of(particles.begin(), particles.end(),
                  [&](Index i) { return is_inside(i, collider, scratch.inside); }))
    return {};
  const Corners<Real> corners = corners_of(source, scratch.gap, particles);
  // From a mesh they lie off by the thickness, whatever their gap is now: what carries in one step
  // and not in the next never rests.
  const Real lying = thickness_at(source.cloths, particles[0]);
  const bool carried = corners.as_lying(span, lying).clear(rise);
  if (carried && bound > beyond(source, reach)) return {};
  return ContactLook<Real>{reach, carried};
}

/// Beyond this distance a pair needs no row [m].
template <class Real>
Real farthest_row(const ObjectRowSource<Real>& source, const ContactLook<Real>& look,
                  bool responds) {
  return responds ? source.cloths.thickness + look.reach : beyond(source, look.reach);
}

/// Adds the rows of edges of the cloth with ridges of mesh m. @return closest points computed
template <class Real>
std::uint64_t add_edges_on_mesh(const ObjectRowSource<Real>& source,
                                const RowScratch<Real>& scratch, std::size_t m,
                                ObjectRows<Real>& rows) {
  std::uint64_t tests = 0;
  const MeshShape<Real>& mesh = source.shapes.meshes[m];
  const std::size_t collider = source.shapes.mesh_collider[m];
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  const Vec3Array<Real>& own = in_frame_of(source.shapes, source.near, m, source.state.x);
  const auto at = [&](Index i) { return in_double(own[static_cast<std::size_t>(i)]); };
  const auto corner = [&](Index v) {
    return in_double(mesh.positions[static_cast<std::size_t>(v)]);
  };
  for (const ContactCandidate<Real>& pair : source.pairs.edge[m]) {
    const Edge& e = source.cloths.patches.edges[static_cast<std::size_t>(pair.cloth)];
    const auto ridge = static_cast<std::size_t>(pair.feature);
    const std::optional<ContactLook<Real>> look =
        look_at(source, scratch, pair, e, kEdgeSpan, mesh.edge_rises[ridge], collider);
    if (!look) continue;
    const MeshEdge& other = mesh.edges[ridge];
    ++tests;
    const PairSeparation<double> s = separate_pair<double>(
        PairKind::edge_edge, {at(e[0]), at(e[1]), corner(other.a), corner(other.b)});
    const Real distance = static_cast<Real>(s.gap);
    const bool responds = !look->carried && s.inside;
    if (distance > farthest_row(source, *look, responds)) continue;
    const Vec3<Real>& outward = mesh.edge_normals[ridge];
    Vec3<Real> normal = s.normal.template cast<Real>();
    ContactBarrier<Real> barrier;
    barrier.distance = std::max(distance, Real(0));
    if (!(s.gap > kNoDirection)) normal = outward;
    // An edge that cuts a ridge of what its cloth is just leaving goes on outward.
    if (mesh.closed && s.inside && normal.dot(outward) < 0 &&
        still_leaves(cloth_of(source.cloths, e[0]), collider, rows.exits)) {
      normal = -normal;
      barrier.distance = -barrier.distance;
    }
    barrier.normal = frame.world_direction(normal);
    barrier.top = top_of(source.shapes, m, barrier.normal, {other.a, other.b});
    add_row(source, {e[0], e[1]},
            {static_cast<Real>(s.weight[0]), static_cast<Real>(s.weight[1]), 0}, barrier, collider,
            responds, rows);
  }
  return tests;
}

/// Adds the rows of triangles of the cloth with corners of mesh m. @return closest points computed
template <class Real>
std::uint64_t add_triangles_on_mesh(const ObjectRowSource<Real>& source,
                                    const RowScratch<Real>& scratch, std::size_t m,
                                    ObjectRows<Real>& rows) {
  std::uint64_t tests = 0;
  const MeshShape<Real>& mesh = source.shapes.meshes[m];
  const std::size_t collider = source.shapes.mesh_collider[m];
  const ColliderFrame<Real>& frame = source.shapes.frames[collider];
  const Vec3Array<Real>& own = in_frame_of(source.shapes, source.near, m, source.state.x);
  const auto at = [&](Index i) { return in_double(own[static_cast<std::size_t>(i)]); };
  for (const ContactCandidate<Real>& pair : source.pairs.triangle[m]) {
    const Triangle& t = source.cloths.patches.triangles[static_cast<std::size_t>(pair.cloth)];
    const auto v = static_cast<std::size_t>(pair.feature);
    const std::optional<ContactLook<Real>> look =
        look_at(source, scratch, pair, t, kTriangleSpan, mesh.vertex_rises[v], collider);
    if (!look) continue;
    ++tests;
    const PairSeparation<double> s = separate_pair<double>(
        PairKind::vertex_triangle, {in_double(mesh.positions[v]), at(t[0]), at(t[1]), at(t[2])});
    const Real distance = static_cast<Real>(s.gap);
    const bool responds = !look->carried && s.inside;
    if (distance > farthest_row(source, *look, responds)) continue;
    ContactBarrier<Real> barrier;
    barrier.distance = std::max(distance, Real(0));
    const Vec3<Real> normal =
        s.gap > kNoDirection ? (-s.normal).template cast<Real>().eval() : mesh.vertex_normals[v];
    barrier.normal = frame.world_direction(normal);
    barrier.top = top_of(source.shapes, m, barrier.normal, {pair.feature});
    std::array<Real, 3> weights;
    for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(-s.weight[n + 1]);
    add_row(source, {t[0], t[1], t[2]}, weights, barrier, collider, responds, rows);
  }
  return tests;
}

}  // namespace

template <class Real>
void add_features_on_meshes(const ObjectRowSource<Real>& source, const RowScratch<Real>& scratch,
                            ObjectRows<Real>& rows, Profile& profile) {
  assert(scratch.inside.size() == source.state.x.size() && "rows of particles come first");
  const std::size_t meshes = source.shapes.meshes.size();
  std::uint64_t tests = 0;
  for (std::size_t m = 0; m < meshes; ++m) tests += add_edges_on_mesh(source, scratch, m, rows);
  for (std::size_t m = 0; m < meshes; ++m) tests += add_triangles_on_mesh(source, scratch, m, rows);
  profile[Stage::narrow_phase].work += tests;
}

template decltype(add_features_on_meshes<float>) add_features_on_meshes<float>;
template decltype(add_features_on_meshes<double>) add_features_on_meshes<double>;

}  // namespace weft
