// The broad phase of ClothGuard: pairs of features that could meet while all particles stay near
// their predicted paths.

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/contact/cloth_guard.h"

namespace weft {
namespace {

/// Gap that every step leaves between features, and the same in units of rounding of the largest
/// coordinate [m].
constexpr double kSmallestGap = 1e-5, kRoundings = 64;

/// Pairs are to hold while the mean particle moves by this part of an edge, but neither longer than
/// these seconds nor shorter than these substeps.
constexpr double kHorizonPart = 0.2, kLongestHorizon = 0.25, kFewestSubsteps = 4;

/// Pairs that are tested together.
constexpr std::size_t kPairsAtOnce = 1024;

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
  common_velocity_ = common / dt;
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
    velocity_[i] = path_velocity(i, dt);
    motion_.start[i] = legal_[i];
    motion_.end[i] = legal_[i] + (velocity_[i] - common_velocity_) * horizon_;
  }
  off_path_.setZero();
  off_path_now_.setZero();
  off_path_before_.setZero();
  ++collection_;
  ++counts_.collections;
  tree_.refit(motion_, true);
  pairs_.clear();
  open_pairs_ = 0;
  std::uint64_t tests = 0;
  changed_.assign(n, 1);
  tree_.for_each_near_pair([&](Index p, Index q) { tests += test_patches(p, q, true); });
  for (PairColumns<Real>& columns : columns_) keep_near(columns);
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

/// Gives particles that leave their paths new ones, and collects their pairs anew; the others go
/// on.
template <class Real>
void ClothGuard<Real>::collect_strays(Real dt, Profile& profile) {
  const StageTimer timer(profile, Stage::broad_phase, 0);
  const Real past = elapsed_ - dt;
  horizon_ -= past;
  changed_.assign(legal_.size(), 0);
  for (const Index k : strays_) {
    const auto i = static_cast<std::size_t>(k);
    changed_[i] = 1;
    velocity_[i] = path_velocity(i, dt);
  }
  for (std::size_t i = 0; i < legal_.size(); ++i) {
    if (changed_[i])
      motion_.start[i] = legal_[i] - off_path_before_;
    else
      motion_.start[i] += velocity_[i] * past;
    motion_.end[i] = motion_.start[i] + (velocity_[i] - common_velocity_) * horizon_;
  }
  elapsed_ = dt;
  ++collection_;
  ++counts_.renewals;
  const auto is_old = [&](const GuardedPair<Real>& pair) {
    return std::any_of(pair.particle.begin(), pair.particle.end(),
                       [&](Index i) { return changed_[static_cast<std::size_t>(i)] != 0; });
  };
  const auto gone = std::stable_partition(pairs_.begin(), pairs_.end(), std::not_fn(is_old));
  dropped_keys_.clear();
  for (auto pair = gone; pair != pairs_.end(); ++pair) dropped_keys_.push_back(key_of(*pair));
  std::sort(dropped_keys_.begin(), dropped_keys_.end());
  pairs_.erase(gone, pairs_.end());
  open_pairs_ = static_cast<std::size_t>(
      std::count_if(pairs_.begin(), pairs_.end(), [](const auto& pair) { return pair.open; }));
  const std::size_t kept = pairs_.size();
  tree_.refit_changed(motion_, changed_);
  std::uint64_t tests = 0;
  tree_.for_each_changed_pair([&](Index p, Index q) { tests += test_patches(p, q, false); });
  for (PairColumns<Real>& columns : columns_) keep_near(columns);
  profile[Stage::broad_phase].work += tests;
  was_active_.assign(legal_.size(), 0);
  for (const Index i : active_) was_active_[static_cast<std::size_t>(i)] = 1;
  join_pairs();
  admit_pairs(kept);
  // The rows of pairs that were found again hold as before.
  for (std::size_t k = kept; k < pairs_.size(); ++k) {
    const bool known =
        std::binary_search(dropped_keys_.begin(), dropped_keys_.end(), key_of(pairs_[k]));
    if (!known && !pairs_[k].open) arrived_.push_back(pairs_[k]);
  }
}

/// Gives room to particles that had no pairs, and lists for anchoring whoever has more than a new
/// pair allows.
/// @param first  new pair
template <class Real>
void ClothGuard<Real>::admit_pairs(std::size_t first) {
  const auto for_new = [&](auto&& visit) {
    for (std::size_t k = first; k < pairs_.size(); ++k) {
      if (!pairs_[k].open) visit(pairs_[k]);
    }
  };
  for_new([&](const GuardedPair<Real>& pair) {
    for (const Index k : pair.particle) {
      const auto i = static_cast<std::size_t>(k);
      if (was_active_[i]) continue;
      anchor_[i] = legal_[i];
      room_[i] = std::numeric_limits<Real>::infinity();
    }
  });
  for (std::size_t k = first; k < pairs_.size(); ++k)
    columns_of(pairs_[k].kind).add(static_cast<Index>(k), 0, pairs_[k].particle);
  for (PairColumns<Real>& columns : columns_) {
    separate_pairs(anchor_, anchor_, columns);
    for (std::size_t k = 0; k < columns.size(); ++k)
      pairs_[static_cast<std::size_t>(columns.a[k])].bound = columns.separation(k, anchor_).gap;
    columns.clear();
  }
  for_new([&](GuardedPair<Real>& pair) {
    const Real room = std::max(Real(0), pair.bound - smallest_gap_);
    const auto [one, other] = speeds(pair);
    const Real share = one / (one + other);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(pair.particle[k]);
      if (was_active_[i]) continue;
      room_[i] = std::min(room_[i], room * (k < first_side(pair.kind) ? share : 1 - share));
    }
  });
  for_new([&](const GuardedPair<Real>& pair) {
    Real side[2] = {0, 0};
    for (std::size_t k = 0; k < 4; ++k) {
      Real& most = side[k < first_side(pair.kind) ? 0 : 1];
      most = std::max(most, room_[static_cast<std::size_t>(pair.particle[k])]);
    }
    if (side[0] + side[1] + smallest_gap_ <= pair.bound) return;
    dirty_.insert(dirty_.end(), pair.particle.begin(), pair.particle.end());
  });
}

/// Velocity of a predicted path, which has to hold at least for the coming step [m/s].
template <class Real>
Vec3<Real> ClothGuard<Real>::path_velocity(std::size_t i, Real dt) const {
  const Vec3<Real> now = step_[i] / dt, v = steady(now, i);
  return (step_[i] - v * dt).squaredNorm() > reach_ * reach_ / 4 ? now : v;
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

/// Tests the features of two patches against each other.
/// @param all  or only pairs that have a changed particle
template <class Real>
std::uint64_t ClothGuard<Real>::test_patches(Index p, Index q, bool all) {
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
    pair.open = !(pair.bound > 0);
    open_pairs_ += pair.open ? 1 : 0;
    pairs_.push_back(pair);
  }
  columns.clear();
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
  template std::uint64_t ClothGuard<Real>::test_patches(Index, Index, bool);                      \
  template void ClothGuard<Real>::collect_strays(Real, Profile&);                                 \
  template void ClothGuard<Real>::admit_pairs(std::size_t);                                       \
  template Vec3<Real> ClothGuard<Real>::path_velocity(std::size_t, Real) const;                   \
  template void ClothGuard<Real>::test_pair(PairKind, Index, Index, const std::array<Index, 4>&); \
  template void ClothGuard<Real>::keep_near(PairColumns<Real>&);                                  \
  template Vec3<Real> ClothGuard<Real>::steady(const Vec3<Real>&, std::size_t) const;             \
  template void ClothGuard<Real>::join_pairs();                                                   \
  template void ClothGuard<Real>::share_all_gaps();
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
