// Pairs of features of two patches for ClothGuard.

#include <algorithm>

#include "core/contact/cloth_guard.h"

namespace weft {
namespace {

/// Pairs that are tested together.
constexpr std::size_t kPairsAtOnce = 1024;

bool share_particle(const std::array<Index, 4>& p, PairKind kind) {
  if (kind == PairKind::vertex_triangle) return p[0] == p[1] || p[0] == p[2] || p[0] == p[3];
  return p[0] == p[2] || p[0] == p[3] || p[1] == p[2] || p[1] == p[3];
}

}  // namespace

/// Boxes around the features of a patch, once a collection and when one of them has changed.
template <class Real>
void ClothGuard<Real>::box_patch(Index p) {
  if (boxed_[static_cast<std::size_t>(p)] >= full_collection_) return;
  boxed_[static_cast<std::size_t>(p)] = collection_;
  const auto box_of = [&](const auto& particles) {
    Aabb<Real> box;
    for (const Index i : particles) {
      box.add(motion_.start[static_cast<std::size_t>(i)]);
      box.add(motion_.end[static_cast<std::size_t>(i)]);
    }
    return box.grown(motion_.radius);
  };
  const auto& patch = tree_.patch(p);
  for (const Index i : patch.vertices)
    vertex_boxes_[static_cast<std::size_t>(i)] = box_of(std::array<Index, 1>{i});
  for (const Index e : patch.edges)
    edge_boxes_[static_cast<std::size_t>(e)] = box_of(edges_[static_cast<std::size_t>(e)]);
  for (const Index t : patch.triangles)
    triangle_boxes_[static_cast<std::size_t>(t)] = box_of(triangles_[static_cast<std::size_t>(t)]);
}

/// Tests the features of two patches against each other.
/// @param all  or only pairs that have a changed particle
template <class Real>
std::uint64_t ClothGuard<Real>::test_patches(Index p, Index q, bool all) {
  if (resting_[static_cast<std::size_t>(p)] && resting_[static_cast<std::size_t>(q)]) return 0;
  box_patch(p);
  box_patch(q);
  const auto& first = tree_.patch(p);
  const auto& second = tree_.patch(q);
  const auto vertex_changed = [&](Index i) { return changed_[static_cast<std::size_t>(i)] != 0; };
  const auto any_changed = [&](const auto& particles) {
    return std::any_of(particles.begin(), particles.end(), vertex_changed);
  };
  const auto edge_changed = [&](Index e) {
    return any_changed(edges_[static_cast<std::size_t>(e)]);
  };
  const auto triangle_changed = [&](Index t) {
    return any_changed(triangles_[static_cast<std::size_t>(t)]);
  };
  // The changed ones first; where the other patch has nothing changed these alone matter.
  const auto pick = [&](const std::vector<Index>& from, const std::vector<Aabb<Real>>& boxes,
                        const Aabb<Real>& box, bool others, auto&& is_changed, NearFeatures& into) {
    into.list.clear();
    into.rest.clear();
    for (const Index f : from) {
      if (!boxes[static_cast<std::size_t>(f)].overlaps(box)) continue;
      if (all || is_changed(f))
        into.list.push_back(f);
      else if (others)
        into.rest.push_back(f);
    }
    into.changed = into.list.size();
    into.list.insert(into.list.end(), into.rest.begin(), into.rest.end());
  };
  const bool first_rest = all || tree_.is_marked(q), second_rest = all || tree_.is_marked(p);
  auto& [vertices_a, edges_a, triangles_a, vertices_b, edges_b, triangles_b] = near_;
  pick(first.vertices, vertex_boxes_, tree_.box(q), first_rest, vertex_changed, vertices_a);
  pick(first.edges, edge_boxes_, tree_.box(q), first_rest, edge_changed, edges_a);
  pick(first.triangles, triangle_boxes_, tree_.box(q), first_rest, triangle_changed, triangles_a);
  pick(second.vertices, vertex_boxes_, tree_.box(p), second_rest, vertex_changed, vertices_b);
  pick(second.edges, edge_boxes_, tree_.box(p), second_rest, edge_changed, edges_b);
  pick(second.triangles, triangle_boxes_, tree_.box(p), second_rest, triangle_changed, triangles_b);
  std::uint64_t tests = 0;
  // Of each pair at least one has changed.
  const auto for_pairs = [&](const NearFeatures& a, const std::vector<Aabb<Real>>& boxes_a,
                             const NearFeatures& b, const std::vector<Aabb<Real>>& boxes_b,
                             auto&& visit) {
    for (std::size_t m = 0; m < a.list.size(); ++m) {
      const Aabb<Real>& box = boxes_a[static_cast<std::size_t>(a.list[m])];
      const std::size_t end = m < a.changed ? b.list.size() : b.changed;
      for (std::size_t n = 0; n < end; ++n) {
        if (box.overlaps(boxes_b[static_cast<std::size_t>(b.list[n])])) visit(a.list[m], b.list[n]);
      }
      tests += end;
    }
  };
  const auto test_vertex = [&](Index v, Index t) {
    const Triangle& c = triangles_[static_cast<std::size_t>(t)];
    test_pair(PairKind::vertex_triangle, v, t, {v, c[0], c[1], c[2]});
  };
  for_pairs(vertices_a, vertex_boxes_, triangles_b, triangle_boxes_, test_vertex);
  if (p != q) for_pairs(vertices_b, vertex_boxes_, triangles_a, triangle_boxes_, test_vertex);
  for_pairs(edges_a, edge_boxes_, edges_b, edge_boxes_, [&](Index e, Index f) {
    if (p == q && f <= e) return;
    const Edge &c = edges_[static_cast<std::size_t>(std::min(e, f))],
               &d = edges_[static_cast<std::size_t>(std::max(e, f))];
    test_pair(PairKind::edge_edge, std::min(e, f), std::max(e, f), {c[0], c[1], d[0], d[1]});
  });
  return tests;
}

/// Puts a pair among those that are to be tested.
template <class Real>
void ClothGuard<Real>::test_pair(PairKind kind, Index a, Index b,
                                 const std::array<Index, 4>& particle) {
  if (share_particle(particle, kind)) return;
  PairColumns<Real>& columns = columns_of(kind);
  columns.add(a, b, particle);
  if (columns.size() >= kPairsAtOnce) keep_near(columns);
}

/// Keeps pairs unless one axis separates the balls of their particles at both ends of the horizon,
/// and thereby all along.
template <class Real>
void ClothGuard<Real>::keep_near(PairColumns<Real>& columns) {
  separate_pairs(start_, end_, columns);
  const Real apart = 2 * motion_.radius;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns.gap[k] > apart && columns.end_gap[k] > apart) continue;
    GuardedPair<Real> pair;
    pair.kind = columns.kind;
    for (std::size_t n = 0; n < 4; ++n) pair.particle[n] = columns.particle[n][k];
    pair.a = columns.a[k];
    pair.b = columns.b[k];
    pair.bound = columns.separation(k, start_).gap;
    pair.open = !(pair.bound > 0);
    open_pairs_ += pair.open ? 1 : 0;
    pairs_.push_back(pair);
  }
  columns.clear();
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template void ClothGuard<Real>::box_patch(Index);                                               \
  template std::uint64_t ClothGuard<Real>::test_patches(Index, Index, bool);                      \
  template void ClothGuard<Real>::test_pair(PairKind, Index, Index, const std::array<Index, 4>&); \
  template void ClothGuard<Real>::keep_near(PairColumns<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
