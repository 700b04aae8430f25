// Pairs of features of two patches for ClothGuard.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/contact/guard/cloth_guard.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Pairs that are tested together.
constexpr std::size_t kPairsAtOnce = 1024;

/// A part of the search has at least so many pairs of patches: fewer are not worth a thread.
constexpr std::size_t kPatchesAtLeast = 128;
/// And so many patches are fitted together.
constexpr std::size_t kFitsAtLeast = 128;

/// A gap of less than so many roundings of its particles' coordinates is none: cloths that start in
/// one plane, pulled off it by 1e-28 m, would change sides by rounding. What was apart once keeps
/// eight times as much.
constexpr double kRoundingsOfNoGap = 8;

/// Calls visit(number) for each bit that is set.
template <class Visit>
void for_each_bit(std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

/// Which features of a patch have a changed particle.
/// @param all  all have
template <class Real>
PatchMarks ClothGuard<Real>::changed_in(Index p, bool all) const {
  if (all) return {~0u, ~0u, ~0u};
  return tree_.is_marked(p) ? boxes_.changed(p) : PatchMarks{};
}

/// Tests the features of all patches that are near each other, in parts that know nothing of each
/// other, and adds what they find to the pairs, in their order.
/// @param all  or only pairs that have a changed particle
template <class Real>
void ClothGuard<Real>::test_near_patches(bool all, Profile& profile) {
  const StageTimer timer(profile, Stage::pairs, 0);
  const std::size_t count = near_patches_.size(), parts = parts_of(count, kPatchesAtLeast);
  profile[Stage::broad_phase].work += count;
  fit_near_patches();
  run_parts(executor_, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    search(from, to, all, searches_[n]);
  });
  for (std::size_t n = 0; n < parts; ++n) {
    PairSearch<Real>& s = searches_[n];
    profile[Stage::pairs].work += s.tests;
    pairs_.insert(pairs_.end(), s.found.begin(), s.found.end());
    for (const GuardedPair<Real>& pair : s.found) open_pairs_ += pair.open ? 1 : 0;
    s.found.clear();
  }
}

/// Fits the boxes of all these patches.
template <class Real>
void ClothGuard<Real>::fit_near_patches() {
  to_fit_.clear();
  for (const auto& [p, q] : near_patches_) {
    if (!boxes_.mark_fitted(p)) to_fit_.push_back(p);
    if (!boxes_.mark_fitted(q)) to_fit_.push_back(q);
  }
  const std::size_t count = to_fit_.size(), parts = parts_of(count, kFitsAtLeast);
  run_parts(executor_, count, parts, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      boxes_.fit(to_fit_[k], tree_.patch(to_fit_[k]), motion_, changed_);
  });
}

/// Tests the features of a part of the patches that are near each other.
template <class Real>
void ClothGuard<Real>::search(std::size_t first, std::size_t last, bool all,
                              PairSearch<Real>& s) const {
  s.tests = 0;
  for (std::size_t k = first; k < last; ++k) {
    stop_point(k);
    test_patches(near_patches_[k].first, near_patches_[k].second, all, s);
  }
  for (PairColumns<Real>& columns : s.columns) keep_near(columns, s);
}

template <class Real>
void ClothGuard<Real>::test_patches(Index p, Index q, bool all, PairSearch<Real>& s) const {
  if (resting_[static_cast<std::size_t>(p)] && resting_[static_cast<std::size_t>(q)]) return;
  if (in_heap(p) || in_heap(q)) return;
  overlap_patches(boxes_.columns(p), boxes_.columns(q), changed_in(p, all), changed_in(q, all),
                  s.overlaps);
  leave_out_incident<Real>(tree_.patch(p), tree_.patch(q), s.overlaps);
  test_triangles(p, q, s.overlaps.first_vertices, s);
  if (p != q) test_triangles(q, p, s.overlaps.second_vertices, s);
  test_edges(p, q, s);
}

/// Particles of one patch against triangles of another one.
template <class Real>
void ClothGuard<Real>::test_triangles(Index p, Index q, const PatchOverlaps::Bits& overlaps,
                                      PairSearch<Real>& s) const {
  const auto& vertices = tree_.patch(p).vertices;
  const auto& triangles = tree_.patch(q).triangles;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    for_each_bit(overlaps[k], [&](std::size_t n) {
      const Index v = vertices[k], t = triangles[n];
      const Triangle& c = triangles_[static_cast<std::size_t>(t)];
      test_pair(PairKind::vertex_triangle, v, t, {v, c[0], c[1], c[2]}, s);
    });
  }
  s.tests += vertices.size() * triangles.size();
}

/// Edges of two patches, or of one with each other.
template <class Real>
void ClothGuard<Real>::test_edges(Index p, Index q, PairSearch<Real>& s) const {
  const auto &first = tree_.patch(p).edges, &second = tree_.patch(q).edges;
  for (std::size_t k = 0; k < first.size(); ++k) {
    std::uint32_t near = s.overlaps.first_edges[k];
    if (p == q) near &= ~0u << k << 1;  // each two once
    for_each_bit(near, [&](std::size_t n) {
      const auto [e, f] = std::minmax(first[k], second[n]);
      const Edge &c = edges_[static_cast<std::size_t>(e)], &d = edges_[static_cast<std::size_t>(f)];
      test_pair(PairKind::edge_edge, e, f, {c[0], c[1], d[0], d[1]}, s);
    });
  }
  s.tests += first.size() * second.size();
}

/// Puts a pair among those that are to be tested.
template <class Real>
void ClothGuard<Real>::test_pair(PairKind kind, Index a, Index b,
                                 const std::array<Index, 4>& particle, PairSearch<Real>& s) const {
  PairColumns<Real>& columns = s.columns[kind];
  columns.add(a, b, particle);
  if (columns.size() >= kPairsAtOnce) keep_near(columns, s);
}

/// Keeps pairs unless one axis separates the balls of their particles at both ends of the horizon,
/// and thereby all along.
template <class Real>
void ClothGuard<Real>::keep_near(PairColumns<Real>& columns, PairSearch<Real>& s) const {
  separate_pairs(motion_.start, motion_.end, columns);
  const Real apart = 2 * motion_.radius;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns.gap[k] > apart && columns.end_gap[k] > apart) continue;
    GuardedPair<Real> pair;
    pair.kind = columns.kind;
    for (std::size_t n = 0; n < 4; ++n) pair.particle[n] = columns.particle[n][k];
    pair.a = columns.a[k];
    pair.b = columns.b[k];
    pair.bound = columns.certified_gap(k, motion_.start);
    pair.open = !is_apart(pair) || tangles_.frees(pair.kind, pair.particle);
    s.found.push_back(pair);
  }
  columns.clear();
}

/// Whether a gap is so wide that the rounding of positions cannot close it.
template <class Real>
bool ClothGuard<Real>::is_apart(const GuardedPair<Real>& pair) const {
  if (pair.bound >= smallest_gap_) return true;
  Real largest = 0;
  for (const Index i : pair.particle) {
    for (int k = 0; k < 3; ++k)
      largest = std::max(largest, std::abs(legal_[static_cast<std::size_t>(i)][k]));
  }
  return pair.bound > largest * std::numeric_limits<Real>::epsilon() * Real(kRoundingsOfNoGap);
}

#define WEFT_INSTANTIATE(Real)                                                                     \
  template PatchMarks ClothGuard<Real>::changed_in(Index, bool) const;                             \
  template void ClothGuard<Real>::test_near_patches(bool, Profile&);                               \
  template void ClothGuard<Real>::fit_near_patches();                                              \
  template void ClothGuard<Real>::search(std::size_t, std::size_t, bool, PairSearch<Real>&) const; \
  template void ClothGuard<Real>::test_patches(Index, Index, bool, PairSearch<Real>&) const;       \
  template void ClothGuard<Real>::test_triangles(Index, Index, const PatchOverlaps::Bits&,         \
                                                 PairSearch<Real>&) const;                         \
  template void ClothGuard<Real>::test_edges(Index, Index, PairSearch<Real>&) const;               \
  template void ClothGuard<Real>::test_pair(PairKind, Index, Index, const std::array<Index, 4>&,   \
                                            PairSearch<Real>&) const;                              \
  template void ClothGuard<Real>::keep_near(PairColumns<Real>&, PairSearch<Real>&) const;          \
  template bool ClothGuard<Real>::is_apart(const GuardedPair<Real>&) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
