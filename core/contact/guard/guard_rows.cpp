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

/// The rows of a particle are made anew when it moved by this part of the thickness; after this
/// time [s], by a smaller part, within the margin: what rests keeps its rows, which turn with their
/// features.
constexpr double kLongestRows = 1.0 / 120, kRowMotion = 0.5, kRestMotion = 0.05;

/// Pairs are looked at in parts with at least so many.
constexpr std::size_t kPairsAtLeast = 512;

/// If more than this part of all have moved, all pairs are gone through.
constexpr std::size_t kManyMoved = 8;

/// No row is made for a gap beyond this part of the thickness: so much that what comes fast has one
/// before it arrives, as else the regions would have to stop it.
constexpr double kRowReach = 2;

/// Edges keep less than the thickness, so that particles and triangles respond first.
constexpr double kEdgeRadius = 0.85;

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
  if (rows_steps_ % kStepsBetweenLooks != 0) return false;
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
  looked_at_.clear();
  const bool many = moved_particles_.size() > active_.size() / kManyMoved;
  if (!many) list_moved_pairs();
  const std::size_t count = many ? pairs_.size() : looked_at_.size();
  const std::size_t parts = parts_of(count, kPairsAtLeast);
  run_parts(executor_, count, parts, [&](std::size_t n, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const std::size_t at = many ? k : static_cast<std::size_t>(looked_at_[k]);
      const GuardedPair<Real>& pair = pairs_[at];
      if (many && (pair.open || pair.gone || !has_moved(pair.particle))) continue;
      if (is_beyond(pair)) continue;
      row_parts_[n].columns[pair.kind].add(static_cast<Index>(at), 0, pair.particle);
    }
    make_near_rows(state, row_parts_[n]);
  });
  for (const Index k : moved_particles_) {
    const auto i = static_cast<std::size_t>(k);
    is_moved_[i] = 0;
    x_rows_[i] = legal_[i];
  }
  if (!rows_built_) arrived_.clear();
  rows_built_ = true;
  rows_listed_ = false;
  for (const PairKind kind : {PairKind::vertex_triangle, PairKind::edge_edge}) {
    for (std::size_t n = 0; n < parts; ++n) {
      PairColumns<Real>& columns = row_parts_[n].columns[kind];
      profile[Stage::narrow_phase].work += columns.size();
      columns.clear();
      std::vector<GuardRow<Real>>& rows = row_parts_[n].rows[static_cast<std::size_t>(kind)];
      for (GuardRow<Real>& row : rows) add_row(row);
      rows.clear();
    }
  }
}

/// Lists the pairs of the particles that have moved, each once.
template <class Real>
void ClothGuard<Real>::list_moved_pairs() {
  ++listing_;
  for (const Index k : moved_particles_) {
    for_pairs_of(static_cast<std::size_t>(k), [&](GuardedPair<Real>& pair) {
      if (std::exchange(pair.listed, listing_) != listing_)
        looked_at_.push_back(static_cast<Index>(&pair - pairs_.data()));
    });
  }
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
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const GuardRow<Real>& row = rows_[k];
    if (rows_built_ && !has_moved(row.particle)) {
      if (kept != k) rows_[kept] = row;
      ++kept;
    } else if (row.push > 0 || dot(row.slip, row.slip) > 0) {
      old_keys_.push_back({row.key, static_cast<Index>(old_rows_.size())});
      old_rows_.push_back(row);
    }
  }
  rows_.resize(kept);
  std::sort(old_keys_.begin(), old_keys_.end());
  row_slabs_.visit_particles(nullptr, [this](Index k) {
    const auto i = static_cast<std::size_t>(k);
    in_rows_[i] = 0;
    first_row_[i] = kNone;
  });
  row_slabs_.clear_particles();
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
    row_slabs_.add_particle(i);
    pressure_[static_cast<std::size_t>(i)] = 0;
  }
}

/// Makes the rows of the pairs in the columns.
template <class Real>
void ClothGuard<Real>::make_near_rows(const ClothState<Real>& state, RowPart<Real>& part) const {
  for (PairColumns<Real>& columns : part.columns) {
    separate_pairs(legal_, legal_, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns.gap[k] > thickest_ * Real(kRowReach)) continue;
      GuardRow<Real> row;
      if (make_row(state, pairs_[static_cast<std::size_t>(columns.a[k])],
                   columns.separation(k, legal_), row))
        part.rows[static_cast<std::size_t>(columns.kind)].push_back(row);
    }
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
    GuardRow<Real> row;
    if (has_row(pair)) continue;
    if (!make_row(state, pair, separate_pair(pair.kind, points(pair, legal_)), row)) continue;
    const auto number = static_cast<Index>(rows_.size());
    const std::size_t list = row_slabs_.add(number, pair.particle);
    add_row(row);
    row_deals_.add(list, number, rows_);
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

/// @return whether a pair is near enough for a row, and nobody else's
template <class Real>
bool ClothGuard<Real>::make_row(const ClothState<Real>& state, const GuardedPair<Real>& pair,
                                const PairSeparation<Real>& s, GuardRow<Real>& row) const {
  if (s.gap > thickest_ * Real(kRowReach) || !(s.gap > 0)) return false;
  if (!s.inside && (pair.kind == PairKind::edge_edge || !owns_nearest(pair.b, pair.particle, s)))
    return false;
  Real approach = 0;
  for (std::size_t k = 0; k < 4; ++k)
    approach -= s.weight[k] * s.normal.dot(state.v[static_cast<std::size_t>(pair.particle[k])]);
  const Real soon = std::max(Real(0), approach) * Real(2 * kLongestRows);
  const Real margin = std::max(thickest_ * Real(kRowMargin), soon);
  if (s.gap > thickest_ + margin) return false;
  const Index p = part_of(pair.particle[0]), q = part_of(pair.particle[2]);
  row.radius = radius_of(pair, p, q);
  if (s.gap > row.radius + margin) return false;
  row.particle = pair.particle;
  if (!weigh(state, s, row)) return false;
  row.friction =
      (friction_[static_cast<std::size_t>(p)] + friction_[static_cast<std::size_t>(q)]) / 2;
  row.key = key_of(pair);
  row.apart = weighted(row, legal_);
  return true;
}

/// Adds a row, which goes on from the one before.
template <class Real>
void ClothGuard<Real>::add_row(GuardRow<Real>& row) {
  remember(row);
  rows_.push_back(row);
  list_row(rows_.size() - 1);
}

#define WEFT_INSTANTIATE(Real)                                                                   \
  template bool ClothGuard<Real>::find_moved();                                                  \
  template void ClothGuard<Real>::renew_rows(const ClothState<Real>&, Profile&);                 \
  template bool ClothGuard<Real>::has_moved(const std::array<Index, 4>&) const;                  \
  template void ClothGuard<Real>::drop_moved_rows();                                             \
  template void ClothGuard<Real>::list_row(std::size_t);                                         \
  template void ClothGuard<Real>::make_near_rows(const ClothState<Real>&, RowPart<Real>&) const; \
  template void ClothGuard<Real>::list_moved_pairs();                                            \
  template bool ClothGuard<Real>::has_row(const GuardedPair<Real>&) const;                       \
  template void ClothGuard<Real>::add_arrived(const ClothState<Real>&, Profile&);                \
  template bool ClothGuard<Real>::is_beyond(const GuardedPair<Real>&) const;                     \
  template bool ClothGuard<Real>::make_row(const ClothState<Real>&, const GuardedPair<Real>&,    \
                                           const PairSeparation<Real>&, GuardRow<Real>&) const;  \
  template void ClothGuard<Real>::add_row(GuardRow<Real>&);                                      \
  template Real ClothGuard<Real>::radius_of(const GuardedPair<Real>&, Index, Index) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
