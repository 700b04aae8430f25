// The contact solver of ClothGuard: rows of near pairs, frozen for some steps.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/cloth_guard.h"

namespace weft {
namespace {

/// Sweeps of projected Gauss-Seidel a step.
constexpr int kSweeps = 1;

/// Rows are made for pairs that lack no more of touching than this part of the thickness, or than
/// they come nearer in twice the time that rows last.
constexpr double kRowMargin = 0.1;

/// Rows are made anew after this time [s], or when a particle moved by this part of the thickness,
/// which is looked at every so many steps.
constexpr double kLongestRows = 1.0 / 120, kRowMotion = 0.2;
constexpr int kStepsBetweenLooks = 4;

/// Rows that push nobody rest until the next look, unless their room is less than this part of the
/// radius and so many times what it shrinks by until then.
constexpr double kBusyRoom = 0.02, kBusyApproach = 2;

/// No row is made for a gap beyond this part of the thickness.
constexpr double kRowReach = 1 + kRowMotion + kRowMargin;

/// Edges keep less than the thickness, so that particles and triangles respond first.
constexpr double kEdgeRadius = 0.85;

/// What lies so near in the fabric keeps no more than this part of its distance there.
constexpr double kFabricPart = 0.8;

/// Time in which a contact that sticks goes back to its anchor [s].
constexpr double kStickTime = 0.02;

/// Push-out: part of the lack a second, and its largest speed [1/s, m/s].
constexpr double kPushRate = 60, kPushSpeed = 0.1;

/// A lack of this part of the radius is let be.
constexpr double kPushSlack = 0.01;

template <class Real>
Vec3<Real> weighted(const GuardRow<Real>& row, const Vec3Array<Real>& values) {
  Vec3<Real> sum = values[static_cast<std::size_t>(row.particle[0])] * row.weight[0];
  for (std::size_t k = 1; k < 4; ++k)
    sum += values[static_cast<std::size_t>(row.particle[k])] * row.weight[k];
  return sum;
}

template <class Real>
void share_out(const GuardRow<Real>& row, const Vec3<Real>& impulse, Vec3Array<Real>& v) {
  for (std::size_t k = 0; k < 4; ++k)
    v[static_cast<std::size_t>(row.particle[k])] += impulse * row.share[k];
}

}  // namespace

template <class Real>
void ClothGuard<Real>::solve(ClothState<Real>& state, Real dt, Profile& profile) {
  legal_ = state.x;
  if (pairs_.empty()) {
    rows_.clear();
    busy_rows_.clear();
    return;
  }
  rows_time_ += dt;
  ++rows_steps_;
  if (!rows_built_ || !rows_hold(state)) build_rows(state, profile);
  if (!arrived_.empty()) add_arrived(state, profile);
  if (rows_.empty()) return;
  const StageTimer timer(profile, Stage::contact, rows_.size());
  sweep_rows(state, dt);
  push_apart(state);
}

template <class Real>
bool ClothGuard<Real>::rows_hold(const ClothState<Real>& state) const {
  if (rows_time_ > static_cast<Real>(kLongestRows)) return false;
  if (rows_steps_ % kStepsBetweenLooks != 0) return true;
  const Real most = thickest_ * Real(kRowMotion);
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    if (!((state.x[i] - x_rows_[i]).squaredNorm() <= most * most)) return false;
  }
  return true;
}

template <class Real>
void ClothGuard<Real>::build_rows(const ClothState<Real>& state, Profile& profile) {
  const StageTimer timer(profile, Stage::narrow_phase, 0);
  rows_.swap(old_rows_);
  rows_.clear();
  old_keys_.clear();
  for (std::size_t k = 0; k < old_rows_.size(); ++k) {
    if (old_rows_[k].push > 0) old_keys_.push_back({old_rows_[k].key, static_cast<Index>(k)});
  }
  std::sort(old_keys_.begin(), old_keys_.end());
  for (const Index k : active_) {
    const auto i = static_cast<std::size_t>(k);
    x_rows_[i] = state.x[i];
    moved_[i] = (state.x[i] - anchor_[i]).norm();
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const GuardedPair<Real>& pair = pairs_[k];
    if (!pair.open && !is_beyond(pair))
      columns_of(pair.kind).add(static_cast<Index>(k), 0, pair.particle);
  }
  for (PairColumns<Real>& columns : columns_) {
    separate_pairs(state.x, state.x, columns);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const GuardedPair<Real>& pair = pairs_[static_cast<std::size_t>(columns.a[k])];
      if (!(columns.gap[k] > thickest_ * Real(kRowReach)))
        add_row(state, pair, columns.separation(k, state.x));
    }
    columns.clear();
  }
  arrived_.clear();
  profile[Stage::narrow_phase].work += pairs_.size();
  rows_built_ = true;
  rows_time_ = 0;
  rows_steps_ = 0;
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
    for (const Index k : pair.particle) {
      const auto i = static_cast<std::size_t>(k);
      if (!was_active_[i]) x_rows_[i] = state.x[i];
    }
    const std::size_t before = rows_.size();
    add_row(state, pair, separate_pair(pair.kind, points(pair, state.x)));
    if (rows_.size() > before) busy_rows_.push_back(static_cast<Index>(before));
  }
  arrived_.clear();
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
  if (pair.kind == PairKind::edge_edge && !s.inside) return;
  const Index p = part_of(pair.particle[0]), q = part_of(pair.particle[2]);
  GuardRow<Real> row;
  row.radius = radius_of(pair, p, q);
  Real approach = 0;
  for (std::size_t k = 0; k < 4; ++k)
    approach -= s.weight[k] * s.normal.dot(state.v[static_cast<std::size_t>(pair.particle[k])]);
  const Real soon = std::max(Real(0), approach) * Real(2 * kLongestRows);
  if (s.gap > row.radius + std::max(thickest_ * Real(kRowMargin), soon)) return;
  Real mobility = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    row.particle[k] = pair.particle[k];
    row.weight[k] = s.weight[k];
    row.share[k] = s.weight[k] * state.inverse_mass[static_cast<std::size_t>(pair.particle[k])];
    mobility += row.share[k] * row.weight[k];
  }
  if (!(mobility > 0)) return;
  row.inertia = 1 / mobility;
  row.normal = s.normal;
  row.friction =
      (friction_[static_cast<std::size_t>(p)] + friction_[static_cast<std::size_t>(q)]) / 2;
  row.key = key_of(pair);
  remember(row);
  rows_.push_back(row);
}

/// Goes on with the impulses and the anchor that the pair had.
template <class Real>
void ClothGuard<Real>::remember(GuardRow<Real>& row) const {
  const auto found = std::lower_bound(old_keys_.begin(), old_keys_.end(),
                                      std::pair<std::uint64_t, Index>{row.key, 0});
  if (found == old_keys_.end() || found->first != row.key) return;
  const GuardRow<Real>& old = old_rows_[static_cast<std::size_t>(found->second)];
  const auto along = [&](const Vec3<Real>& v) -> Vec3<Real> {
    return v - row.normal * row.normal.dot(v);
  };
  row.push = old.push;
  row.drag = along(old.drag);
  row.slip = along(old.slip);
}

/// Normal velocity that a row must reach: no nearer than its radius within the step.
template <class Real>
void ClothGuard<Real>::aim(GuardRow<Real>& row, const ClothState<Real>& state, Real dt) const {
  row.room = row.normal.dot(weighted(row, state.x)) - row.radius;
  row.least_speed = row.room > 0 ? -row.room / dt : Real(0);
}

/// One row of a sweep. Friction brings what sticks back to its anchor, and lets it slide where that
/// takes more than Coulomb's bound.
/// @return change of the normal velocity [m/s]
template <class Real>
Real ClothGuard<Real>::solve_row(GuardRow<Real>& row, Vec3Array<Real>& velocities) const {
  const Vec3<Real> v = weighted(row, velocities);
  const Real speed = row.normal.dot(v);
  if (row.push == 0 && speed >= row.least_speed) return 0;
  const Real push = std::max(Real(0), row.push + (row.least_speed - speed) * row.inertia);
  const Real more = push - row.push;
  Vec3<Real> change = row.normal * more;
  row.push = push;
  if (row.friction > 0) {
    const Vec3<Real> slide = v - row.normal * speed;
    const Vec3<Real> wanted = row.drag - (slide + row.slip / Real(kStickTime)) * row.inertia;
    const Real most = row.friction * push, size2 = wanted.squaredNorm();
    const bool slides = size2 > most * most;
    const Vec3<Real> drag = slides ? Vec3<Real>(wanted * (most / std::sqrt(size2))) : wanted;
    if (slides) row.slip.setZero();
    change += drag - row.drag;
    row.drag = drag;
  }
  share_out(row, change, velocities);
  return std::abs(more) / row.inertia;
}

template <class Real>
Real ClothGuard<Real>::sweep_again(ClothState<Real>& state) {
  Real largest = 0;
  for (const Index k : busy_rows_)
    largest = std::max(largest, solve_row(rows_[static_cast<std::size_t>(k)], state.v));
  return largest;
}

/// Lists the rows that push somebody or may have to before the next look.
template <class Real>
void ClothGuard<Real>::find_busy_rows(const ClothState<Real>& state, Real dt) {
  const Real time = dt * Real(kStepsBetweenLooks * kBusyApproach);
  busy_rows_.clear();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    GuardRow<Real>& row = rows_[k];
    if (row.push == 0) {
      const Real room = row.normal.dot(weighted(row, state.x)) - row.radius;
      const Real approach = -row.normal.dot(weighted(row, state.v));
      if (room > row.radius * Real(kBusyRoom) + std::max(Real(0), approach) * time) continue;
    }
    busy_rows_.push_back(static_cast<Index>(k));
  }
}

/// Projected Gauss-Seidel that starts from the impulses of the last step, and goes over the rows
/// from either end in turn.
template <class Real>
void ClothGuard<Real>::sweep_rows(ClothState<Real>& state, Real dt) {
  const Real warm = warm_dt_ > 0 ? dt / warm_dt_ : Real(0);
  warm_dt_ = dt;
  if (rows_steps_ % kStepsBetweenLooks == 0) find_busy_rows(state, dt);
  for (const Index k : busy_rows_) {
    GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    aim(row, state, dt);
    if (row.push == 0) continue;
    row.push *= warm;
    row.drag *= warm;
    share_out<Real>(row, row.normal * row.push + row.drag, state.v);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    if ((rows_steps_ + sweep) % 2 == 0) {
      for (std::size_t k = 0; k < busy_rows_.size(); ++k)
        solve_row(rows_[static_cast<std::size_t>(busy_rows_[k])], state.v);
    } else {
      for (std::size_t k = busy_rows_.size(); k-- > 0;)
        solve_row(rows_[static_cast<std::size_t>(busy_rows_[k])], state.v);
    }
  }
  for (const Index k : busy_rows_) {
    GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    if (row.push == 0) {
      row.slip.setZero();
    } else if (row.friction > 0) {
      const Vec3<Real> v = weighted(row, state.v);
      row.slip += (v - row.normal * row.normal.dot(v)) * dt;
    }
  }
}

/// Velocities of the coming drift alone that push apart what is nearer than its radius.
template <class Real>
void ClothGuard<Real>::push_apart(ClothState<Real>& state) {
  for (const Index k : busy_rows_) {
    const GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    const Real lack = -row.room;
    if (!(lack > row.radius * Real(kPushSlack))) continue;
    const Real wanted = std::min(lack * Real(kPushRate), static_cast<Real>(kPushSpeed));
    const Real more = wanted - row.normal.dot(weighted(row, extra_));
    if (!(more > 0)) continue;
    share_out<Real>(row, row.normal * (more * row.inertia), extra_);
    for (const Index i : row.particle) {
      if (!std::exchange(is_pushed_[static_cast<std::size_t>(i)], 1)) pushed_.push_back(i);
    }
  }
  for (const Index k : pushed_) {
    const auto i = static_cast<std::size_t>(k);
    state.v[i] += extra_[i];
    pushed_v_.push_back(state.v[i]);
  }
}

template <class Real>
void ClothGuard<Real>::finish(ClothState<Real>& state) {
  for (std::size_t n = 0; n < pushed_.size(); ++n) {
    const auto i = static_cast<std::size_t>(pushed_[n]);
    Vec3<Real>& v = state.v[i];
    const Vec3<Real>& extra = extra_[i];
    // What was stopped keeps no more of the push than it had, and gets no velocity against it.
    Real part = 1;
    if (v != pushed_v_[n]) {
      const Real size = extra.squaredNorm();
      part = size > 0 ? std::clamp(v.dot(extra) / size, Real(0), Real(1)) : Real(0);
    }
    v -= extra * part;
    extra_[i].setZero();
    is_pushed_[i] = 0;
  }
  pushed_.clear();
  pushed_v_.clear();
}

template <class Real>
void ClothGuard<Real>::settle(ClothState<Real>& state, Real dt, Profile& profile) {
  if (rows_.empty()) return;
  const StageTimer timer(profile, Stage::contact, rows_.size());
  for (GuardRow<Real>& row : rows_) {
    aim(row, state, dt);
    const Vec3<Real> v = weighted(row, state.v);
    const Real speed = row.normal.dot(v);
    const Real push = (row.least_speed - speed) * row.inertia;
    if (!(push > 0)) continue;
    const Vec3<Real> drag = (v - row.normal * speed) * -row.inertia;
    const Real most = row.friction * push, size = drag.norm();
    share_out<Real>(
        row, row.normal * push + (size > most ? Vec3<Real>(drag * (most / size)) : drag), state.v);
  }
  warm_dt_ *= 2;  // the next step's first kick is half of one
}

#define WEFT_INSTANTIATE(Real)                                                               \
  template void ClothGuard<Real>::solve(ClothState<Real>&, Real, Profile&);                  \
  template void ClothGuard<Real>::finish(ClothState<Real>&);                                 \
  template void ClothGuard<Real>::settle(ClothState<Real>&, Real, Profile&);                 \
  template bool ClothGuard<Real>::rows_hold(const ClothState<Real>&) const;                  \
  template void ClothGuard<Real>::build_rows(const ClothState<Real>&, Profile&);             \
  template void ClothGuard<Real>::add_arrived(const ClothState<Real>&, Profile&);            \
  template bool ClothGuard<Real>::is_beyond(const GuardedPair<Real>&) const;                 \
  template void ClothGuard<Real>::add_row(const ClothState<Real>&, const GuardedPair<Real>&, \
                                          const PairSeparation<Real>&);                      \
  template Real ClothGuard<Real>::radius_of(const GuardedPair<Real>&, Index, Index) const;   \
  template void ClothGuard<Real>::remember(GuardRow<Real>&) const;                           \
  template void ClothGuard<Real>::aim(GuardRow<Real>&, const ClothState<Real>&, Real) const; \
  template Real ClothGuard<Real>::solve_row(GuardRow<Real>&, Vec3Array<Real>&) const;        \
  template Real ClothGuard<Real>::sweep_again(ClothState<Real>&);                            \
  template void ClothGuard<Real>::find_busy_rows(const ClothState<Real>&, Real);             \
  template void ClothGuard<Real>::sweep_rows(ClothState<Real>&, Real);                       \
  template void ClothGuard<Real>::push_apart(ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
