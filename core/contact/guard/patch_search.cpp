// Finds pairs of features: patches that are near each other, boxes that overlap, gaps on the paths.

#include "core/contact/guard/patch_search.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/contact/guard/constants.h"
#include "core/contact/parts.h"
#include "core/instantiate.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Calls visit(number) for each bit that is set.
template <class Visit>
void for_each_bit(std::uint32_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Which features of a patch have a particle with a new path.
template <class Real>
PatchMarks changed_in(const PatchSearch<Real>& search, Index p, bool all) {
  if (all) return {~0u, ~0u, ~0u};
  return search.tree.is_marked(p) ? search.boxes.changed(p) : PatchMarks{};
}

/// Fits the boxes of all patches that are near others.
template <class Real>
void fit_near_patches(PatchSearch<Real>& search, Executor* executor) {
  std::vector<Index>& to_fit = search.to_fit;
  to_fit.clear();
  for (const auto& [p, q] : search.near) {
    if (!search.boxes.mark_fitted(p)) to_fit.push_back(p);
    if (!search.boxes.mark_fitted(q)) to_fit.push_back(q);
  }
  const std::size_t count = to_fit.size();
  run_parts(executor, count, parts_of(count, kFitsAtLeast),
            [&](std::size_t, std::size_t from, std::size_t to) {
              for (std::size_t k = from; k < to; ++k)
                search.boxes.fit(to_fit[k], search.tree.patch(to_fit[k]), search.motion,
                                 search.changed);
            });
}

/// Keeps pairs unless one axis separates the balls of their particles at both ends of the motion,
/// and therefore all along.
template <class Real>
void keep_near(const PredictedMotion<Real>& motion, const GuardedCloths<Real>& cloths,
               const ClothTangles<Real>& tangles, PairColumns<Real>& columns,
               std::vector<GuardedPair<Real>>& found) {
  separate_pairs(motion.start, motion.end, columns);
  const Real meet = 2 * motion.radius, widest = meet + 2 * motion.margin;
  const auto beyond = [&](std::size_t k, Real apart) {
    return columns.gap[k] > apart && columns.end_gap[k] > apart;
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (beyond(k, widest)) continue;
    GuardedPair<Real> pair;
    pair.kind = columns.kind;
    for (std::size_t n = 0; n < 4; ++n) pair.particle[n] = columns.particle[n][k];
    if (motion.margin > 0 && beyond(k, std::max(meet, seen_from(cloths, pair.particle)))) continue;
    pair.a = columns.a[k];
    pair.b = columns.b[k];
    pair.bound = columns.certified_gap(k, motion.start);
    pair.open = !(pair.bound > 0) || tangles.frees(pair.kind, pair.particle);
    found.push_back(pair);
  }
  columns.clear();
}

/// One part of a search: it reads all of these, and writes only `part`.
template <class Real>
struct SearchPass {
  const PatchSearch<Real>& search;
  const GuardedCloths<Real>& cloths;
  const LeftOut<Real>& left_out;
  PairSearch<Real>& part;
};

/// Puts a pair among those that are to be tested.
template <class Real>
void test_pair(const SearchPass<Real>& pass, PairKind kind, Index a, Index b,
               const std::array<Index, 4>& particle) {
  PairColumns<Real>& columns = pass.part.columns[kind];
  columns.add(a, b, particle);
  if (columns.size() >= kPairsAtOnce)
    keep_near(pass.search.motion, pass.cloths, pass.left_out.tangled.tangles, columns,
              pass.part.found);
}

/// Particles of one patch against triangles of another one.
template <class Real>
void test_triangles(const SearchPass<Real>& pass, Index p, Index q,
                    const PatchOverlaps::Bits& overlaps) {
  const std::vector<Index>& vertices = pass.search.tree.patch(p).vertices;
  const std::vector<Index>& triangles = pass.search.tree.patch(q).triangles;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    for_each_bit(overlaps[k], [&](std::size_t n) {
      const Index v = vertices[k], t = triangles[n];
      const Triangle& c = pass.cloths.triangles[at_index(t)];
      test_pair(pass, PairKind::vertex_triangle, v, t, {v, c[0], c[1], c[2]});
    });
  }
  pass.part.tests += vertices.size() * triangles.size();
}

/// Edges of two patches, or of one with each other.
template <class Real>
void test_edges(const SearchPass<Real>& pass, Index p, Index q) {
  const std::vector<Index>& first = pass.search.tree.patch(p).edges;
  const std::vector<Index>& second = pass.search.tree.patch(q).edges;
  const std::vector<Edge>& edges = pass.cloths.edges;
  for (std::size_t k = 0; k < first.size(); ++k) {
    std::uint32_t near = pass.part.overlaps.first_edges[k];
    if (p == q) near &= ~0u << k << 1;  // each two once
    for_each_bit(near, [&](std::size_t n) {
      const auto [e, f] = std::minmax(first[k], second[n]);
      const Edge &c = edges[at_index(e)], &d = edges[at_index(f)];
      test_pair(pass, PairKind::edge_edge, e, f, {c[0], c[1], d[0], d[1]});
    });
  }
  pass.part.tests += first.size() * second.size();
}

template <class Real>
void test_patches(const SearchPass<Real>& pass, Index p, Index q) {
  const auto& [search, cloths, left_out, part] = pass;
  const auto &first = search.tree.patch(p), &second = search.tree.patch(q);
  const std::vector<char>& resting = left_out.resting;
  if (resting[at_index(p)] && resting[at_index(q)]) return;
  if (in_heap(left_out.tangled, cloths, first) || in_heap(left_out.tangled, cloths, second)) return;
  overlap_patches(search.boxes.columns(p, first), search.boxes.columns(q, second),
                  changed_in(search, p, left_out.all), changed_in(search, q, left_out.all),
                  part.overlaps);
  leave_out_incident<Real>(first, second, part.overlaps);
  test_triangles(pass, p, q, part.overlaps.first_vertices);
  if (p != q) test_triangles(pass, q, p, part.overlaps.second_vertices);
  test_edges(pass, p, q);
}

/// Lists the patches that visit_all(visit) visits, but for those that are stretched out together.
template <class Real, class VisitAll>
void list_near_patches(PatchSearch<Real>& search, VisitAll&& visit_all) {
  search.near.clear();
  visit_all([&](Index p, Index q) {
    stop_point(search.near.size());
    if (!search.tree.are_spread(p, q, search.motion)) search.near.push_back({p, q});
  });
}

}  // namespace

template <class Real>
PatchSearch<Real> patch_search(const ClothModel<Real>& model) {
  PatchSearch<Real> search;
  search.tree = PatchTree<Real>(model);
  search.boxes = PatchBoxes<Real>(search.tree);
  search.motion.start.assign(model.mass.size(), {});
  search.motion.end.assign(model.mass.size(), {});
  search.parts.resize(kMostParts);
  return search;
}

template <class Real>
void forget_found(PatchSearch<Real>& search) {
  search.tree.forget();
  for (PairSearch<Real>& part : search.parts) {
    part.columns.clear();
    part.found.clear();
  }
}

template <class Real>
void find_near_patches(PatchSearch<Real>& search) {
  search.changed.assign(search.motion.start.size(), 1);
  list_near_patches(search, [&](auto&& visit) { search.tree.for_each_near_pair(visit); });
}

template <class Real>
void find_near_patches_of(const std::vector<Index>& particles, PatchSearch<Real>& search) {
  search.changed.assign(search.motion.start.size(), 0);
  for (const Index i : particles) search.changed[at_index(i)] = 1;
  search.tree.refit_changed(search.motion, particles, search.changed);
  for (const Index p : search.tree.marked()) search.boxes.forget(p);
  list_near_patches(search, [&](auto&& visit) { search.tree.for_each_changed_pair(visit); });
}

template <class Real>
void test_near_patches(PatchSearch<Real>& search, const GuardedCloths<Real>& cloths,
                       const LeftOut<Real>& left_out, Executor* executor, GuardedPairs<Real>& pairs,
                       Profile& profile) {
  assert(left_out.resting.size() == search.tree.patch_count());
  const StageTimer timer(profile, Stage::pairs, 0);
  const std::size_t count = search.near.size(), parts = parts_of(count, kPatchesAtLeast);
  profile[Stage::broad_phase].work += count;
  fit_near_patches(search, executor);
  run_parts(executor, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    const SearchPass<Real> pass{search, cloths, left_out, search.parts[n]};
    pass.part.tests = 0;
    for (std::size_t k = from; k < to; ++k) {
      stop_point(k);
      test_patches(pass, search.near[k].first, search.near[k].second);
    }
    for (PairColumns<Real>& columns : pass.part.columns)
      keep_near(search.motion, cloths, left_out.tangled.tangles, columns, pass.part.found);
  });
  for (std::size_t n = 0; n < parts; ++n) {
    PairSearch<Real>& part = search.parts[n];
    profile[Stage::pairs].work += part.tests;
    pairs.all.insert(pairs.all.end(), part.found.begin(), part.found.end());
    for (const GuardedPair<Real>& pair : part.found) pairs.open += pair.open ? 1 : 0;
    part.found.clear();
  }
}

WEFT_INSTANTIATE_FUNCTIONS(patch_search, forget_found, find_near_patches, find_near_patches_of,
                           test_near_patches)

}  // namespace weft
