// The narrow phase of Contact: edges and triangles of the cloth against ridges and corners of
// meshes (those against round objects are in contact_rounds.cpp). Each pair that could meet while
// the rows hold gets a plane that proves it apart; whether it responds besides is a matter of where
// particles alone do not carry the cloth.

#include <algorithm>
#include <cmath>

#include "core/contact/feature_pair.h"
#include "core/contact/objects/apart.h"
#include "core/contact/objects/contact.h"
#include "core/contact/objects/corners.h"

namespace weft {

/// What the corners of an edge or a triangle keep to while the rows hold.
template <class Real>
Corners<Real> Contact<Real>::corners_of(const ClothState<Real>& state, const Index* first,
                                        int count) const {
  Corners<Real> corners;
  corners.unseen = smallest_gap_;
  Real longest = 0, reach = 0;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(first[k]),
               j = static_cast<std::size_t>(first[(k + 1) % count]);
    longest = std::max(longest, (state.x[i] - state.x[j]).squaredNorm());
    reach = std::max(reach, row_reach_[i]);
    corners.gap = std::min(corners.gap, gap_[i] - row_reach_[i]);
  }
  corners.reach = reach;
  corners.span = (std::sqrt(longest) + 2 * reach) * Real(count == 2 ? kEdgeSpan : kTriangleSpan);
  return corners;
}

/// What a pair of features of the cloth and a mesh needs; nothing if they cannot meet while the
/// rows hold.
/// @param particles  of the cloth's feature
/// @param span       kEdgeSpan or kTriangleSpan
/// @param rise       of the mesh about its feature
template <class Real>
std::optional<typename Contact<Real>::Look> Contact<Real>::look_at(
    const ClothState<Real>& state, const ContactCandidate<Real>& pair,
    std::span<const Index> particles, double span, const Rise<Real>& rise,
    std::size_t collider) const {
  const auto most = [&](const std::vector<Real>& values) {
    Real largest = values[static_cast<std::size_t>(particles[0])];
    for (const Index i : particles)
      largest = std::max(largest, values[static_cast<std::size_t>(i)]);
    return largest;
  };
  const Real reach = most(row_reach_);
  const Real bound = pair.distance - most(moved_) - frames_[collider].travel_since_pairs;
  if (bound > thickness_ + reach) return {};
  if (std::any_of(particles.begin(), particles.end(),
                  [&](Index i) { return is_inside(i, collider); }))
    return {};
  const Corners<Real> corners =
      corners_of(state, particles.data(), static_cast<int>(particles.size()));
  // From a mesh they lie off by the thickness, whatever their gap is now: what carries in one step
  // and not in the next never rests.
  const bool carried = corners.as_lying(span, thickness_of(particles[0])).clear(rise);
  if (carried && bound > beyond_reach(reach)) return {};
  return Look{reach, carried};
}

template <class Real>
void Contact<Real>::add_edges_on_meshes(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const std::size_t collider = mesh_collider_[m];
    const ColliderFrame<Real>& frame = frames_[collider];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    const auto at = [&](Index i) { return in_double(own[static_cast<std::size_t>(i)]); };
    const auto corner = [&](Index v) {
      return in_double(mesh.positions[static_cast<std::size_t>(v)]);
    };
    for (const ContactCandidate<Real>& pair : edge_pairs_[m]) {
      const Edge& e = patches_.edges[static_cast<std::size_t>(pair.cloth)];
      const auto ridge = static_cast<std::size_t>(pair.feature);
      const std::optional<Look> look =
          look_at(state, pair, e, kEdgeSpan, mesh.edge_rises[ridge], collider);
      if (!look) continue;
      const MeshEdge& other = mesh.edges[ridge];
      ++tests;
      const PairSeparation<double> s = separate_pair<double>(
          PairKind::edge_edge, {at(e[0]), at(e[1]), corner(other.a), corner(other.b)});
      const Real distance = static_cast<Real>(s.gap);
      const bool responds = !look->carried && s.inside;
      if (distance > (responds ? thickness_ + look->reach : beyond_reach(look->reach))) continue;
      const Vec3<Real>& outward = mesh.edge_normals[ridge];
      Vec3<Real> normal = s.normal.template cast<Real>();
      Barrier barrier;
      barrier.distance = std::max(distance, Real(0));
      if (!(s.gap > kNoDirection)) normal = outward;
      // An edge that cuts a ridge of what its cloth is just leaving goes on outward.
      if (mesh.closed && s.inside && normal.dot(outward) < 0 && still_leaves(e[0], collider)) {
        normal = -normal;
        barrier.distance = -barrier.distance;
      }
      barrier.normal = frame.world_direction(normal);
      barrier.top = top_of(m, barrier.normal, {other.a, other.b});
      add_row(state, {e[0], e[1]},
              {static_cast<Real>(s.weight[0]), static_cast<Real>(s.weight[1]), 0}, barrier,
              collider, responds);
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

template <class Real>
void Contact<Real>::add_triangles_on_meshes(const ClothState<Real>& state, Profile& profile) {
  std::uint64_t tests = 0;
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const MeshShape<Real>& mesh = meshes_[m];
    const std::size_t collider = mesh_collider_[m];
    const ColliderFrame<Real>& frame = frames_[collider];
    const Vec3Array<Real>& own = in_frame_of(m, state.x);
    const auto at = [&](Index i) { return in_double(own[static_cast<std::size_t>(i)]); };
    for (const ContactCandidate<Real>& pair : triangle_pairs_[m]) {
      const Triangle& t = patches_.triangles[static_cast<std::size_t>(pair.cloth)];
      const auto v = static_cast<std::size_t>(pair.feature);
      const std::optional<Look> look =
          look_at(state, pair, t, kTriangleSpan, mesh.vertex_rises[v], collider);
      if (!look) continue;
      ++tests;
      const PairSeparation<double> s = separate_pair<double>(
          PairKind::vertex_triangle, {in_double(mesh.positions[v]), at(t[0]), at(t[1]), at(t[2])});
      const Real distance = static_cast<Real>(s.gap);
      const bool responds = !look->carried && s.inside;
      if (distance > (responds ? thickness_ + look->reach : beyond_reach(look->reach))) continue;
      Barrier barrier;
      barrier.distance = std::max(distance, Real(0));
      const Vec3<Real> normal =
          s.gap > kNoDirection ? (-s.normal).template cast<Real>().eval() : mesh.vertex_normals[v];
      barrier.normal = frame.world_direction(normal);
      barrier.top = top_of(m, barrier.normal, {pair.feature});
      std::array<Real, 3> weights;
      for (std::size_t n = 0; n < 3; ++n) weights[n] = static_cast<Real>(-s.weight[n + 1]);
      add_row(state, {t[0], t[1], t[2]}, weights, barrier, collider, responds);
    }
  }
  profile[Stage::narrow_phase].work += tests;
}

#define WEFT_INSTANTIATE(Real)                                                                 \
  template Corners<Real> Contact<Real>::corners_of(const ClothState<Real>&, const Index*, int) \
      const;                                                                                   \
  template std::optional<typename Contact<Real>::Look> Contact<Real>::look_at(                 \
      const ClothState<Real>&, const ContactCandidate<Real>&, std::span<const Index>, double,  \
      const Rise<Real>&, std::size_t) const;                                                   \
  template void Contact<Real>::add_edges_on_meshes(const ClothState<Real>&, Profile&);         \
  template void Contact<Real>::add_triangles_on_meshes(const ClothState<Real>&, Profile&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
