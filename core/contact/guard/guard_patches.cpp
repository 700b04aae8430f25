// Pairs of features of two patches for ClothGuard.

#include <algorithm>
#include <bit>

#include "core/contact/guard/cloth_guard.h"

namespace weft {
namespace {

/// Pairs that are tested together.
constexpr std::size_t kPairsAtOnce = 1024;

bool share_particle(const std::array<Index, 4>& p, PairKind kind) {
  if (kind == PairKind::vertex_triangle) return p[0] == p[1] || p[0] == p[2] || p[0] == p[3];
  return p[0] == p[2] || p[0] == p[3] || p[1] == p[2] || p[1] == p[3];
}

/// Calls visit(number) for each bit that is set.
template <class Visit>
void for_each_bit(std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

/// Which features of a patch have a changed particle.
/// @param all  all have
template <class Real>
typename PatchBoxes<Real>::Marks ClothGuard<Real>::changed_in(Index p, bool all) const {
  if (all) return {~0u, ~0u, ~0u};
  return tree_.is_marked(p) ? boxes_.changed(p) : typename PatchBoxes<Real>::Marks{};
}

/// Tests the features of two patches against each other.
/// @param all  or only pairs that have a changed particle
/// @return number of tests
template <class Real>
std::uint64_t ClothGuard<Real>::test_patches(Index p, Index q, bool all) {
  if (resting_[static_cast<std::size_t>(p)] && resting_[static_cast<std::size_t>(q)]) return 0;
  if (in_heap(p) || in_heap(q)) return 0;
  boxes_.fit(p, tree_.patch(p), motion_, changed_);
  boxes_.fit(q, tree_.patch(q), motion_, changed_);
  overlap_patches(boxes_.columns(p), boxes_.columns(q), overlaps_);
  std::uint64_t tests = test_triangles(p, q, all, overlaps_.first_vertices);
  if (p != q) tests += test_triangles(q, p, all, overlaps_.second_vertices);
  return tests + test_edges(p, q, all, overlaps_.first_edges);
}

/// Tests the features of all patches that are near each other.
/// @param all  see test_patches
template <class Real>
void ClothGuard<Real>::test_near_patches(bool all, Profile& profile) {
  const StageTimer timer(profile, Stage::pairs, 0);
  profile[Stage::broad_phase].work += near_patches_.size();
  std::uint64_t tests = 0;
  for (const auto& [p, q] : near_patches_) tests += test_patches(p, q, all);
  for (PairColumns<Real>& columns : columns_) keep_near(columns);
  profile[Stage::pairs].work += tests;
}

/// Particles of one patch against triangles of another one.
template <class Real>
std::uint64_t ClothGuard<Real>::test_triangles(Index p, Index q, bool all,
                                               const PatchOverlaps::Bits& overlaps) {
  const auto& vertices = tree_.patch(p).vertices;
  const auto& triangles = tree_.patch(q).triangles;
  const std::uint32_t changed = changed_in(p, all).vertices, others = changed_in(q, all).triangles;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const std::uint32_t near = overlaps[k] & (((changed >> k) & 1) != 0 ? ~0u : others);
    for_each_bit(near, [&](std::size_t n) {
      const Index v = vertices[k], t = triangles[n];
      const Triangle& c = triangles_[static_cast<std::size_t>(t)];
      test_pair(PairKind::vertex_triangle, v, t, {v, c[0], c[1], c[2]});
    });
  }
  return vertices.size() * triangles.size();
}

/// Edges of two patches, or of one with each other.
template <class Real>
std::uint64_t ClothGuard<Real>::test_edges(Index p, Index q, bool all,
                                           const PatchOverlaps::Bits& overlaps) {
  const auto &first = tree_.patch(p).edges, &second = tree_.patch(q).edges;
  const std::uint32_t changed = changed_in(p, all).edges, others = changed_in(q, all).edges;
  for (std::size_t k = 0; k < first.size(); ++k) {
    std::uint32_t near = overlaps[k] & (((changed >> k) & 1) != 0 ? ~0u : others);
    if (p == q) near &= ~0u << k << 1;  // each two once
    for_each_bit(near, [&](std::size_t n) {
      const auto [e, f] = std::minmax(first[k], second[n]);
      const Edge &c = edges_[static_cast<std::size_t>(e)], &d = edges_[static_cast<std::size_t>(f)];
      test_pair(PairKind::edge_edge, e, f, {c[0], c[1], d[0], d[1]});
    });
  }
  return first.size() * second.size();
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
  separate_pairs(motion_.start, motion_.end, columns);
  const Real apart = 2 * motion_.radius;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns.gap[k] > apart && columns.end_gap[k] > apart) continue;
    GuardedPair<Real> pair;
    pair.kind = columns.kind;
    for (std::size_t n = 0; n < 4; ++n) pair.particle[n] = columns.particle[n][k];
    pair.a = columns.a[k];
    pair.b = columns.b[k];
    pair.bound = columns.separation(k, motion_.start).gap;
    pair.open = !(pair.bound > 0) || tangles_.frees(pair.kind, pair.particle);
    open_pairs_ += pair.open ? 1 : 0;
    pairs_.push_back(pair);
  }
  columns.clear();
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template typename PatchBoxes<Real>::Marks ClothGuard<Real>::changed_in(Index, bool) const;      \
  template std::uint64_t ClothGuard<Real>::test_patches(Index, Index, bool);                      \
  template void ClothGuard<Real>::test_near_patches(bool, Profile&);                              \
  template std::uint64_t ClothGuard<Real>::test_triangles(Index, Index, bool,                     \
                                                          const PatchOverlaps::Bits&);            \
  template std::uint64_t ClothGuard<Real>::test_edges(Index, Index, bool,                         \
                                                      const PatchOverlaps::Bits&);                \
  template void ClothGuard<Real>::test_pair(PairKind, Index, Index, const std::array<Index, 4>&); \
  template void ClothGuard<Real>::keep_near(PairColumns<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
