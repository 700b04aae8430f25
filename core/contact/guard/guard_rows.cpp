// The rows of ClothGuard: contacts of near pairs, frozen for some steps.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/guard/cloth_guard.h"

namespace weft {
namespace {

/// Rows are made for pairs that lack no more of touching than this part of the thickness, or than
/// they come nearer in twice the time that rows last.
constexpr double kRowMargin = 0.1;

/// The rows of a particle are made anew when it moved by this part of the thickness, which is
/// looked at every so many steps; after this time [s], by a smaller part, within the margin: what
/// rests keeps its rows, which turn with their features.
constexpr double kLongestRows = 1.0 / 120, kRowMotion = 0.5, kRestMotion = 0.05;
constexpr int kStepsBetweenMotions = 4;

/// If more than this part of all have moved, all pairs are gone through.
constexpr std::size_t kManyMoved = 8;

/// No row is made for a gap beyond this part of the thickness: so much that what comes fast has one
/// before it arrives, as else the regions would have to stop it.
constexpr double kRowReach = 2;

/// Edges keep less than the thickness, so that particles and triangles respond first.
constexpr double kEdgeRadius = 0.85;

/// A particle that goes over the border of a triangle takes its impulses along if the directions
/// are so much alike: cosine between them.
constexpr double kSameWay = 0.99;

/// What lies so near in the fabric keeps no more than this part of its distance there.
constexpr double kFabricPart = 0.8;

}  // namespace

/// Lists the particles whose rows have to be made anew.
/// @return whether there are any
template <class Real>
bool ClothGuard<Real>::find_moved() {
  moved_particles_.clear();
  if (!rows_built_) {
    moved_particles_ = active_;
    passed_.clear();
    rows_time_ = 0;
    rows_steps_ = 0;
    return true;
  }
  if (rows_steps_ % kStepsBetweenMotions != 0) return false;
  const bool old = rows_time_ > static_cast<Real>(kLongestRows);
  if (old) rows_time_ = 0;
  const Real most = thickest_ * static_cast<Real>(old ? kRestMotion : kRowMotion);
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    const Quad<Real> way = legal_[i] - x_rows_[i];
    if (!(dot(way, way) <= most * most)) moved_particles_.push_back(k);
  }
  moved_particles_.insert(moved_particles_.end(), passed_.begin(), passed_.end());
  passed_.clear();
  return !moved_particles_.empty();
}

/// Makes the rows anew of the particles that have moved.
template <class Real>
void ClothGuard<Real>::renew_rows(const ClothState<Real>& state, Profile& profile) {
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  for (const Index k : moved_particles_) is_moved_[static_cast<std::size_t>(k)] = 1;
  drop_moved_rows();
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    moved_[i] = length(legal_[i] - anchor_[i]);
  }
  const auto look_at = [&](const GuardedPair<Real>& pair) {
    if (!is_beyond(pair))
      columns_of(pair.kind).add(static_cast<Index>(&pair - pairs_.data()), 0, pair.particle);
  };
  if (moved_particles_.size() > active_.size() / kManyMoved) {
    for (const GuardedPair<Real>& pair : pairs_) {
      if (!pair.open && !pair.gone && has_moved(pair.particle)) look_at(pair);
    }
  } else {
    ++listing_;
    for (const Index k : moved_particles_) {
      for_pairs_of(static_cast<std::size_t>(k), [&](GuardedPair<Real>& pair) {
        if (std::exchange(pair.listed, listing_) != listing_) look_at(pair);
      });
    }
  }
  for (const Index k : moved_particles_) {
    const auto i = static_cast<std::size_t>(k);
    is_moved_[i] = 0;
    x_rows_[i] = legal_[i];
  }
  if (!rows_built_) arrived_.clear();
  rows_built_ = true;
  add_near_rows(state, profile);
}

template <class Real>
bool ClothGuard<Real>::has_moved(const std::array<Index, 4>& particles) const {
  return std::any_of(particles.begin(), particles.end(),
                     [&](Index i) { return is_moved_[static_cast<std::size_t>(i)] != 0; });
}

/// Drops the rows of particles that have moved, and notes what they pushed.
template <class Real>
void ClothGuard<Real>::drop_moved_rows() {
  old_rows_.clear();
  old_keys_.clear();
  std::size_t kept = 0;
  for (const GuardRow<Real>& row : rows_) {
    if (rows_built_ && !has_moved(row.particle)) {
      rows_[kept++] = row;
    } else if (row.push > 0 || dot(row.slip, row.slip) > 0) {
      old_keys_.push_back({row.key, static_cast<Index>(old_rows_.size())});
      old_rows_.push_back(row);
    }
  }
  rows_.resize(kept);
  std::sort(old_keys_.begin(), old_keys_.end());
  busy_rows_.visit_particles(nullptr, [this](Index k) {
    const auto i = static_cast<std::size_t>(k);
    in_rows_[i] = 0;
    first_row_[i] = kNone;
  });
  busy_rows_.clear_particles();
  next_row_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r) list_row(r);
}

/// Lists a row with its first particle, and its particles.
template <class Real>
void ClothGuard<Real>::list_row(std::size_t r) {
  const auto first = static_cast<std::size_t>(rows_[r].particle[0]);
  next_row_.push_back(std::exchange(first_row_[first], static_cast<Index>(r)));
  for (const Index i : rows_[r].particle) {
    if (std::exchange(in_rows_[static_cast<std::size_t>(i)], 1)) continue;
    busy_rows_.add_particle(i);
    pressure_[static_cast<std::size_t>(i)] = 0;
  }
}

/// Adds the rows of the pairs in the columns.
template <class Real>
void ClothGuard<Real>::add_near_rows(const ClothState<Real>& state, Profile& profile) {
  for (PairColumns<Real>& columns : columns_) {
    profile[Stage::narrow_phase].work += columns.size();
    separate_pairs(legal_, legal_, columns, executor_);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns.gap[k] > thickest_ * Real(kRowReach)) continue;
      add_row(state, pairs_[static_cast<std::size_t>(columns.a[k])], columns.separation(k, legal_));
    }
    columns.clear();
  }
}

/// Distance that the features of a pair shall keep: the mean of their thicknesses, but no more than
/// the fabric leaves to neighbours.
template <class Real>
Real ClothGuard<Real>::radius_of(const GuardedPair<Real>& pair, Index p, Index q) const {
  Real radius =
      (thickness_[static_cast<std::size_t>(p)] + thickness_[static_cast<std::size_t>(q)]) / 2;
  if (pair.kind == PairKind::edge_edge) radius *= Real(kEdgeRadius);
  if (p != q) return radius;
  const PairPoints<Real> rest = points(pair, rest_positions_);
  const Real near = 2 * radius + 2 * cell_[static_cast<std::size_t>(p)];
  if ((rest[0] - rest[2]).squaredNorm() > near * near) return radius;
  return std::min(radius, separate_pair(pair.kind, rest).gap * Real(kFabricPart));
}

/// Rows of pairs that were collected since rows were built.
template <class Real>
void ClothGuard<Real>::add_arrived(const ClothState<Real>& state, Profile& profile) {
  const StageTimer timer(profile, Stage::narrow_phase, arrived_.size());
  for (const GuardedPair<Real>& pair : arrived_) {
    const std::size_t before = rows_.size();
    if (has_row(pair)) continue;
    add_row(state, pair, separate_pair(pair.kind, points(pair, legal_)));
    if (rows_.size() > before) {
      busy_rows_.add(static_cast<Index>(before), busy_rows_.list_of(pair.particle));
    }
  }
  arrived_.clear();
}

template <class Real>
bool ClothGuard<Real>::has_row(const GuardedPair<Real>& pair) const {
  const std::uint64_t key = key_of(pair);
  Index r = first_row_[static_cast<std::size_t>(pair.particle[0])];
  while (r != kNone && rows_[static_cast<std::size_t>(r)].key != key)
    r = next_row_[static_cast<std::size_t>(r)];
  return r != kNone;
}

/// Whether the gap that a pair had, less what its particles have moved since, is too much for a
/// row.
template <class Real>
bool ClothGuard<Real>::is_beyond(const GuardedPair<Real>& pair) const {
  Real side[2] = {0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    Real& most = side[k < first_side(pair.kind) ? 0 : 1];
    most = std::max(most, moved_[static_cast<std::size_t>(pair.particle[k])]);
  }
  return pair.bound - side[0] - side[1] > thickest_ * Real(kRowReach);
}

template <class Real>
void ClothGuard<Real>::add_row(const ClothState<Real>& state, const GuardedPair<Real>& pair,
                               const PairSeparation<Real>& s) {
  if (s.gap > thickest_ * Real(kRowReach) || !(s.gap > 0)) return;
  if (!s.inside && (pair.kind == PairKind::edge_edge || !owns_nearest(pair.b, pair.particle, s)))
    return;
  Real approach = 0;
  for (std::size_t k = 0; k < 4; ++k)
    approach -= s.weight[k] * s.normal.dot(state.v[static_cast<std::size_t>(pair.particle[k])]);
  const Real soon = std::max(Real(0), approach) * Real(2 * kLongestRows);
  const Real margin = std::max(thickest_ * Real(kRowMargin), soon);
  if (s.gap > thickest_ + margin) return;
  const Index p = part_of(pair.particle[0]), q = part_of(pair.particle[2]);
  GuardRow<Real> row;
  row.radius = radius_of(pair, p, q);
  if (s.gap > row.radius + margin) return;
  row.particle = pair.particle;
  if (!weigh(state, s, row)) return;
  row.friction =
      (friction_[static_cast<std::size_t>(p)] + friction_[static_cast<std::size_t>(q)]) / 2;
  row.key = key_of(pair);
  row.apart = weighted(row, legal_);
  remember(row);
  rows_.push_back(row);
  list_row(rows_.size() - 1);
}

/// Direction and weights of a row.
/// @return whether anybody can move in it
template <class Real>
bool ClothGuard<Real>::weigh(const ClothState<Real>& state, const PairSeparation<Real>& s,
                             GuardRow<Real>& row) const {
  Real mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    row.weight[k] = s.weight[k];
    row.share[k] = s.weight[k] * state.inverse_mass[static_cast<std::size_t>(row.particle[k])];
    mobility += row.share[k] * row.weight[k];
  }
  row.inertia = mobility > 0 ? 1 / mobility : Real(0);
  row.normal = to_quad(s.normal);
  return mobility > 0;
}

/// Turns the rows that push with their features. Frozen until rows are built anew they jump there,
/// and what rests on them never comes to rest.
template <class Real>
void ClothGuard<Real>::turn_rows(const ClothState<Real>& state, Profile& profile) {
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  const bool few = busy_rows_.count() < RowSlabs<Real>::kFewRows;
  run_chunks(few ? nullptr : executor_, static_cast<int>(turn_parts_.size()),
             [&](int list) { turn_rows(state, static_cast<std::size_t>(list)); });
  for (TurnPart<Real>& part : turn_parts_) {
    passed_.insert(passed_.end(), part.passed.begin(), part.passed.end());
    part.passed.clear();
    for (PairColumns<Real>& columns : part.columns) {
      profile[Stage::narrow_phase].work += columns.size();
      columns.clear();
    }
  }
}

/// Turns the rows of a list.
template <class Real>
void ClothGuard<Real>::turn_rows(const ClothState<Real>& state, std::size_t list) {
  TurnPart<Real>& part = turn_parts_[list];
  for (const Index k : busy_rows_.list(list)) {
    const GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    if (row.push > 0) part.columns[static_cast<std::size_t>(kind_of(row))].add(k, 0, row.particle);
  }
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(legal_, legal_, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      GuardRow<Real>& row = rows_[static_cast<std::size_t>(columns.a[k])];
      const PairSeparation<Real> s = columns.separation(k, legal_);
      turn(state, s, row);
      if (columns.kind == PairKind::edge_edge || s.inside) continue;
      // Who has gone over a border is carried by the triangle beyond, and by none that tilts.
      if (!owns_nearest(triangle_of(row), row.particle, s)) part.passed.push_back(row.particle[0]);
    }
  }
}

template <class Real>
void ClothGuard<Real>::turn(const ClothState<Real>& state, const PairSeparation<Real>& s,
                            GuardRow<Real>& row) const {
  if (!(s.gap > 0)) return;
  const Quad<Real> slipped = row.slip + (weighted(row, legal_) - row.apart);
  // Edges that are nearest at an end leave it to the particle there.
  if ((kind_of(row) == PairKind::edge_edge && !s.inside) || !weigh(state, s, row)) {
    row.push = 0;
    row.slip = {};
    return;
  }
  row.drag = tangential(row, row.drag);
  row.slip = tangential(row, slipped);
  row.apart = weighted(row, legal_);
}

/// The row that was there before: of the same pair or, where a particle went over the border of a
/// triangle, of the same particle in nearly the same direction. Null if there was none.
template <class Real>
GuardRow<Real>* ClothGuard<Real>::row_before(const GuardRow<Real>& row) {
  const auto from = [&](std::uint64_t key) {
    return std::lower_bound(old_keys_.begin(), old_keys_.end(),
                            std::pair<std::uint64_t, Index>{key, 0});
  };
  const auto at = [&](auto found) { return &old_rows_[static_cast<std::size_t>(found->second)]; };
  const auto same = from(row.key);
  if (same != old_keys_.end() && same->first == row.key) return at(same);
  if (kind_of(row) == PairKind::edge_edge) return nullptr;
  const std::uint64_t particle = row.key >> 31;
  for (auto found = from(particle << 31);
       found != old_keys_.end() && found->first >> 31 == particle; ++found) {
    if (dot(at(found)->normal, row.normal) > static_cast<Real>(kSameWay)) return at(found);
  }
  return nullptr;
}

/// Goes on with the impulses and the anchor of the row before, which are given once.
template <class Real>
void ClothGuard<Real>::remember(GuardRow<Real>& row) {
  GuardRow<Real>* old = row_before(row);
  if (!old) return;
  row.push = std::exchange(old->push, Real(0));
  row.drag = tangential(row, std::exchange(old->drag, {}));
  // What it slipped since it was last aimed counts too.
  const Quad<Real> apart = weighted(*old, legal_);
  row.slip = tangential(row, std::exchange(old->slip, {}) + (apart - old->apart));
  old->apart = apart;
}

#define WEFT_INSTANTIATE(Real)                                                                \
  template void ClothGuard<Real>::turn_rows(const ClothState<Real>&, Profile&);               \
  template void ClothGuard<Real>::turn_rows(const ClothState<Real>&, std::size_t);            \
  template void ClothGuard<Real>::turn(const ClothState<Real>&, const PairSeparation<Real>&,  \
                                       GuardRow<Real>&) const;                                \
  template bool ClothGuard<Real>::weigh(const ClothState<Real>&, const PairSeparation<Real>&, \
                                        GuardRow<Real>&) const;                               \
  template bool ClothGuard<Real>::find_moved();                                               \
  template void ClothGuard<Real>::renew_rows(const ClothState<Real>&, Profile&);              \
  template bool ClothGuard<Real>::has_moved(const std::array<Index, 4>&) const;               \
  template void ClothGuard<Real>::drop_moved_rows();                                          \
  template void ClothGuard<Real>::list_row(std::size_t);                                      \
  template void ClothGuard<Real>::add_near_rows(const ClothState<Real>&, Profile&);           \
  template bool ClothGuard<Real>::has_row(const GuardedPair<Real>&) const;                    \
  template void ClothGuard<Real>::add_arrived(const ClothState<Real>&, Profile&);             \
  template bool ClothGuard<Real>::is_beyond(const GuardedPair<Real>&) const;                  \
  template void ClothGuard<Real>::add_row(const ClothState<Real>&, const GuardedPair<Real>&,  \
                                          const PairSeparation<Real>&);                       \
  template Real ClothGuard<Real>::radius_of(const GuardedPair<Real>&, Index, Index) const;    \
  template GuardRow<Real>* ClothGuard<Real>::row_before(const GuardRow<Real>&);               \
  template void ClothGuard<Real>::remember(GuardRow<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
