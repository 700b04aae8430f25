// The broad phase of ClothGuard: pairs of features that could meet while all particles stay near
// their predicted paths.

#include <algorithm>
#include <cmath>

#include "core/contact/cloth_guard.h"

namespace weft {
namespace {

/// Gap that every step leaves between features, and the same in units of rounding of the largest
/// coordinate [m].
constexpr double kSmallestGap = 1e-5, kRoundings = 64;

/// Pairs are to hold while the mean particle moves by this part of an edge, but neither longer than
/// these seconds nor shorter than these substeps.
constexpr double kHorizonPart = 0.2, kLongestHorizon = 0.25, kFewestSubsteps = 4;

bool share_particle(const std::array<Index, 4>& p, PairKind kind) {
  if (kind == PairKind::vertex_triangle) return p[0] == p[1] || p[0] == p[2] || p[0] == p[3];
  return p[0] == p[2] || p[0] == p[3] || p[1] == p[2] || p[1] == p[3];
}

}  // namespace

/// Collects pairs anew around the paths on which all particles go on as they move now.
template <class Real>
void ClothGuard<Real>::collect(Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  const std::size_t n = legal_.size();
  // A motion common to all changes nothing between them.
  Vec3<Real> common = Vec3<Real>::Zero();
  for (const Vec3<Real>& step : step_) common += step;
  common /= static_cast<Real>(n);
  Real largest = 0, sum2 = 0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, legal_[i].cwiseAbs().maxCoeff());
    sum2 += (step_[i] - common).squaredNorm();
  }
  smallest_gap_ = std::max(static_cast<Real>(kSmallestGap),
                           largest * std::numeric_limits<Real>::epsilon() * Real(kRoundings));
  const Real speed = std::sqrt(sum2 / static_cast<Real>(n)) / dt;
  const Real shortest = dt * Real(kFewestSubsteps);
  horizon_ = std::clamp(finest_ * Real(kHorizonPart) / std::max(speed, Real(1e-6)), shortest,
                        std::max(static_cast<Real>(kLongestHorizon), shortest));
  motion_.radius = reach_ + smallest_gap_;
  for (std::size_t i = 0; i < n; ++i) {
    velocity_[i] = steady(step_[i] / dt, i);
    // The path has to hold at least for the coming step.
    if ((step_[i] - velocity_[i] * dt).squaredNorm() > reach_ * reach_ / 4)
      velocity_[i] = step_[i] / dt;
    motion_.start[i] = legal_[i];
    motion_.end[i] = legal_[i] + (velocity_[i] - common / dt) * horizon_;
  }
  off_path_.setZero();
  off_path_now_.setZero();
  ++collection_;
  ++counts_.collections;
  tree_.refit(motion_, true);
  pairs_.clear();
  open_pairs_ = 0;
  std::uint64_t tests = 0;
  tree_.for_each_near_pair([&](Index p, Index q) { tests += test_patches(p, q); });
  profile[Stage::broad_phase].work += tests;
  join_pairs();
  for (const Index i : active_) {
    anchor_[static_cast<std::size_t>(i)] = legal_[static_cast<std::size_t>(i)];
    anchored_at_[static_cast<std::size_t>(i)] = 0;
  }
  share_all_gaps();
  elapsed_ = dt;
  collected_ = true;
  rows_built_ = false;
}

/// What of a velocity is not jitter: the smaller of it and of the mean velocity since the last
/// collection, by components, and nothing where they disagree.
template <class Real>
Vec3<Real> ClothGuard<Real>::steady(const Vec3<Real>& v, std::size_t i) const {
  if (!collected_ || !(elapsed_ > 0)) return v;
  const Vec3<Real> mean = (legal_[i] - motion_.start[i]) / elapsed_;
  Vec3<Real> result = Vec3<Real>::Zero();
  for (int k = 0; k < 3; ++k) {
    if (v[k] * mean[k] > 0) result[k] = std::abs(v[k]) < std::abs(mean[k]) ? v[k] : mean[k];
  }
  return result;
}

/// Boxes around the features of a patch, once a collection.
template <class Real>
void ClothGuard<Real>::box_patch(Index p) {
  if (boxed_[static_cast<std::size_t>(p)] == collection_) return;
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

template <class Real>
std::uint64_t ClothGuard<Real>::test_patches(Index p, Index q) {
  box_patch(p);
  box_patch(q);
  const auto& first = tree_.patch(p);
  const auto& second = tree_.patch(q);
  const auto pick = [](const std::vector<Index>& from, const std::vector<Aabb<Real>>& boxes,
                       const Aabb<Real>& box, std::vector<Index>& into) {
    into.clear();
    for (const Index f : from) {
      if (boxes[static_cast<std::size_t>(f)].overlaps(box)) into.push_back(f);
    }
  };
  pick(first.vertices, vertex_boxes_, tree_.box(q), near_[0]);
  pick(first.edges, edge_boxes_, tree_.box(q), near_[1]);
  pick(first.triangles, triangle_boxes_, tree_.box(q), near_[2]);
  pick(second.vertices, vertex_boxes_, tree_.box(p), near_[3]);
  pick(second.edges, edge_boxes_, tree_.box(p), near_[4]);
  pick(second.triangles, triangle_boxes_, tree_.box(p), near_[5]);
  const auto vertices_against = [&](const std::vector<Index>& vertices,
                                    const std::vector<Index>& triangles) {
    for (const Index v : vertices) {
      for (const Index t : triangles) {
        if (!vertex_boxes_[static_cast<std::size_t>(v)].overlaps(
                triangle_boxes_[static_cast<std::size_t>(t)]))
          continue;
        const Triangle& c = triangles_[static_cast<std::size_t>(t)];
        test_pair(PairKind::vertex_triangle, v, t, {v, c[0], c[1], c[2]});
      }
    }
  };
  vertices_against(near_[0], near_[5]);
  if (p != q) vertices_against(near_[3], near_[2]);
  for (const Index e : near_[1]) {
    for (const Index f : near_[4]) {
      if ((p == q && f <= e) || !edge_boxes_[static_cast<std::size_t>(e)].overlaps(
                                    edge_boxes_[static_cast<std::size_t>(f)]))
        continue;
      const Edge &a = edges_[static_cast<std::size_t>(std::min(e, f))],
                 &b = edges_[static_cast<std::size_t>(std::max(e, f))];
      test_pair(PairKind::edge_edge, std::min(e, f), std::max(e, f), {a[0], a[1], b[0], b[1]});
    }
  }
  return near_[0].size() * near_[5].size() + near_[1].size() * near_[4].size() +
         (p != q ? near_[3].size() * near_[2].size() : 0);
}

/// Keeps a pair unless one axis separates the balls of its particles at both ends of the horizon,
/// and thereby all along.
template <class Real>
void ClothGuard<Real>::test_pair(PairKind kind, Index a, Index b,
                                 const std::array<Index, 4>& particle) {
  if (share_particle(particle, kind)) return;
  GuardedPair<Real> pair;
  pair.kind = kind;
  pair.particle = particle;
  pair.a = a;
  pair.b = b;
  const PairSeparation<Real> s = separate_pair(kind, points(pair, motion_.start));
  if (s.gap > 2 * motion_.radius &&
      gap_along(kind, points(pair, motion_.end), s.normal) > 2 * motion_.radius)
    return;
  pair.bound = s.gap;
  pair.open = !(s.gap > 0);
  open_pairs_ += pair.open ? 1 : 0;
  pairs_.push_back(pair);
}

/// Lists the pairs of each particle.
template <class Real>
void ClothGuard<Real>::join_pairs() {
  const std::size_t n = legal_.size();
  pairs_begin_.assign(n + 1, 0);
  for (const GuardedPair<Real>& pair : pairs_) {
    if (pair.open) continue;
    for (const Index i : pair.particle) ++pairs_begin_[static_cast<std::size_t>(i) + 1];
  }
  active_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    if (pairs_begin_[i + 1] > 0) active_.push_back(static_cast<Index>(i));
    pairs_begin_[i + 1] += pairs_begin_[i];
  }
  pairs_of_.resize(static_cast<std::size_t>(pairs_begin_[n]));
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    if (pairs_[k].open) continue;
    // Filled from the back of each particle's list, whose begin then stands where it shall.
    for (const Index i : pairs_[k].particle)
      pairs_of_[static_cast<std::size_t>(--pairs_begin_[static_cast<std::size_t>(i) + 1])] =
          static_cast<Index>(k);
  }
  for (std::size_t i = 0; i < n; ++i) pairs_begin_[i] = pairs_begin_[i + 1];
  pairs_begin_[n] = static_cast<Index>(pairs_of_.size());
}

/// Shares the gap of each pair by the speeds of its sides.
template <class Real>
void ClothGuard<Real>::share_all_gaps() {
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    room_[i] = std::numeric_limits<Real>::infinity();
  }
  for (const GuardedPair<Real>& pair : pairs_) {
    if (pair.open) continue;
    const Real room = std::max(Real(0), pair.bound - smallest_gap_);
    const auto [first, second] = speeds(pair);
    const Real share = first / (first + second);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(pair.particle[k]);
      room_[i] = std::min(room_[i], room * (k < first_side(pair.kind) ? share : 1 - share));
    }
  }
  dirty_.clear();
}

#define WEFT_INSTANTIATE(Real)                                                                    \
  template void ClothGuard<Real>::collect(Real, Profile&);                                        \
  template void ClothGuard<Real>::box_patch(Index);                                               \
  template std::uint64_t ClothGuard<Real>::test_patches(Index, Index);                            \
  template void ClothGuard<Real>::test_pair(PairKind, Index, Index, const std::array<Index, 4>&); \
  template Vec3<Real> ClothGuard<Real>::steady(const Vec3<Real>&, std::size_t) const;             \
  template void ClothGuard<Real>::join_pairs();                                                   \
  template void ClothGuard<Real>::share_all_gaps();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
