// The contact solver of ClothGuard: projected Gauss-Seidel on the velocities of its rows.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/guard/cloth_guard.h"
#include "core/contact/guard/row_blocks.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Rows that push nobody rest until the next look, unless their room is less than a part of the
/// radius and so many times what it shrinks by until then.
constexpr double kBusyApproach = 2;

/// Where cloths meet nothing but each other sweeps are repeated, up to so many, while one changes
/// what something moves in the step by more than this part of the thickness. What one sweep leaves
/// under load sinks in, and the push that leads it out again does work that nobody gave.
constexpr int kMostSweeps = 3;
constexpr double kResidual = 0.01;

/// Space is cut anew into slabs every so many steps, before a look.
constexpr int kStepsBetweenCuts = 64;

/// Push-out: part of the lack a second, and its largest speed [1/s, m/s].
constexpr double kPushRate = 60, kPushSpeed = 0.1;

/// A particle that is copied alone costs as much as so many of all.
constexpr std::size_t kCostOfOne = 2;

/// All are copied on threads in parts with at least so many.
constexpr std::size_t kCopiesAtLeast = 2048;

/// Calls copy(elements, first) for each part of an array.
template <class Array, class Copy>
void copy_all(Executor* executor, const Array& array, Copy&& copy) {
  const std::span all(array);
  run_parts(executor, all.size(), parts_of(all.size(), kCopiesAtLeast),
            [&](std::size_t, std::size_t from, std::size_t to) {
              copy(all.subspan(from, to - from), from);
            });
}

}  // namespace

template <class Real>
void ClothGuard<Real>::solve(ClothState<Real>& state, Real dt, Profile& profile) {
  const Real kicked = std::exchange(closed_, false) ? dt / 2 : dt;
  calm_ = active_.empty() && open_pairs() == 0;
  if (calm_) {
    x_before_ = state.x;
    forget_rows();
    return;
  }
  copy_all(executor_, state.x, [this](auto from, std::size_t at) { to_quads(from, &legal_[at]); });
  tangles_.draw(state, dt);
  rows_time_ += dt;
  ++rows_steps_;
  if (!rows_built_ || rows_steps_ % kStepsBetweenLooks == 0) row_deals_.give_back(rows_, executor_);
  if (find_moved()) renew_rows(state, profile);
  if (rows_steps_ % kStepsBetweenCuts == 0) {
    row_slabs_.cut(active_, legal_);
    rows_listed_ = false;
  }
  if (!arrived_.empty()) add_arrived(state, profile);
  if (rows_.empty()) {
    forget_rows();
    return;
  }
  load_rows(state);
  if (rows_steps_ % kStepsBetweenLooks == 0) look_at_rows(state, dt, profile);
  profile[Stage::contact].work += rows_.size();
  warm_rows(dt, kicked);
  store_rows(state);
}

template <class Real>
void ClothGuard<Real>::forget_rows() {
  rows_.clear();
  row_slabs_.clear();
  row_deals_.clear();
}

template <class Real>
void ClothGuard<Real>::look_at_rows(const ClothState<Real>& state, Real dt, Profile& profile) {
  find_busy_rows(dt);
  measure_pressures();
  turn_rows(state, profile);
  row_deals_.take(row_slabs_, rows_, legal_.size(), executor_);
}

/// Copies the velocities of the particles that rows have, or of all.
template <class Real>
void ClothGuard<Real>::load_rows(const ClothState<Real>& state) {
  if (row_slabs_.particles() * kCostOfOne > state.v.size()) {
    copy_all(executor_, state.v,
             [this](auto from, std::size_t at) { to_quads(from, &quad_v_[at]); });
    return;
  }
  row_slabs_.visit_particles(executor_, [&](Index k) {
    const auto i = static_cast<std::size_t>(k);
    quad_v_[i] = to_quad(state.v[i]);
  });
}

template <class Real>
void ClothGuard<Real>::store_rows(ClothState<Real>& state) const {
  if (row_slabs_.particles() * kCostOfOne > state.v.size()) {
    copy_all(executor_, quad_v_,
             [&](auto from, std::size_t at) { to_vectors(from, &state.v[at]); });
    return;
  }
  row_slabs_.visit_particles(executor_, [&](Index k) {
    const auto i = static_cast<std::size_t>(k);
    state.v[i] = to_vector(quad_v_[i]);
  });
}

template <class Real>
Real ClothGuard<Real>::sweep(ClothState<Real>& state) {
  if (row_slabs_.empty()) return 0;
  load_rows(state);
  const Real largest = sweep_rows();
  store_rows(state);
  return largest;
}

template <class Real>
void ClothGuard<Real>::respond_alone(ClothState<Real>& state, Real dt) {
  if (rows_.empty()) return;
  const Real enough = thickest_ * Real(kResidual) / dt;
  for (int k = 0; k < kMostSweeps; ++k) {
    if (!(sweep(state) > enough)) break;
  }
  push_apart(state);
}

/// Lists the rows that push somebody or may have to before the next look.
template <class Real>
void ClothGuard<Real>::find_busy_rows(Real dt) {
  if (!std::exchange(rows_listed_, true)) {
    row_slabs_.clear();
    for (std::size_t k = 0; k < rows_.size(); ++k)
      row_slabs_.add(static_cast<Index>(k), rows_[k].particle);
  }
  const Real time = dt * Real(kStepsBetweenLooks * kBusyApproach);
  row_slabs_.choose(executor_, [this, time](Index k) {
    return is_busy(rows_[static_cast<std::size_t>(k)], time);
  });
}

/// Whether a row pushes or may within a time [s]. Forgets the slip of one that does not.
template <class Real>
bool ClothGuard<Real>::is_busy(GuardRow<Real>& row, Real time) const {
  if (row.push != 0) return true;
  const Real room = dot(row.normal, weighted(row, legal_)) - row.radius;
  const Real approach = -dot(row.normal, weighted(row, quad_v_));
  if (!(room > row.radius * Real(kBusyRoom) + std::max(Real(0), approach) * time)) return true;
  row.slip = {};
  return false;
}

/// Starts from the impulses of the last step.
/// @param kicked  time of the forces since then that they have to stand against [s]
template <class Real>
void ClothGuard<Real>::warm_rows(Real dt, Real kicked) {
  const Real warm = kicked_ > 0 ? kicked / kicked_ : Real(0);
  kicked_ = kicked;
  const RowPass<Real> pass{legal_.data(), quad_v_.data(), pressure_.data(), most_pressure_, dt,
                           warm};
  const Real lacks = row_deals_.largest(executor_, true, [&](auto blocks) {
    return weft::warm_rows(blocks, pass) ? Real(1) : Real(0);
  });
  rows_lack_ = lacks > 0;
}

/// A sweep of projected Gauss-Seidel, from either end in turn.
/// @return largest change of a normal velocity [m/s]
template <class Real>
Real ClothGuard<Real>::sweep_rows() {
  stop_point();
  upwards_ = !upwards_;
  const RowPass<Real> pass{legal_.data(), quad_v_.data(), nullptr, 0, 0, 0};
  return row_deals_.largest(executor_, upwards_,
                            [&](auto blocks) { return weft::sweep_rows(blocks, upwards_, pass); });
}

/// Pressure about each particle of a row, from what pushes it: single rows share a load by chance.
/// Layers are pressed from both sides.
template <class Real>
void ClothGuard<Real>::measure_pressures() {
  row_slabs_.visit_particles(executor_,
                             [this](Index i) { pressure_[static_cast<std::size_t>(i)] = 0; });
  most_pressure_ = row_slabs_.largest(executor_, [&](Index k) {
    const GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    Real most = 0;
    if (row.push == 0) return most;
    const Real force = row.push / (2 * kicked_);
    for (std::size_t n = 0; n < 4; ++n) {
      const auto i = static_cast<std::size_t>(row.particle[n]);
      pressure_[i] += std::abs(row.weight[n]) * force * inverse_area_[i];
      most = std::max(most, pressure_[i]);
    }
    return most;
  });
}

/// Pushes what lacks. @return largest velocity of a push that was given [m/s]
template <class Real>
Real ClothGuard<Real>::push_rows(std::span<const RowBlock<Real>> blocks) {
  Real most = 0;
  for (const RowBlock<Real>& block : blocks) {
    for (std::size_t k = 0; block.lacks >> k != 0; ++k) {
      if ((block.lacks >> k & 1) == 0) continue;
      const Quad<Real> normal = block.quad(block.normal, k);
      const Real wanted = std::min(block.lack[k] * Real(kPushRate), static_cast<Real>(kPushSpeed));
      const Real more = wanted - dot(normal, block.weighted(k, extra_.data()));
      if (!(more > 0)) continue;
      block.share_out(k, normal * (more * block.inertia[k]), extra_.data());
      for (std::size_t n = 0; n < 4; ++n) is_pushed_[block.particle(n, k)] = 1;
      most = std::max(most, more);
    }
  }
  return most;
}

template <class Real>
void ClothGuard<Real>::push_apart(ClothState<Real>& state) {
  if (!rows_lack_) return;
  const Real most =
      row_deals_.largest(executor_, true, [this](auto blocks) { return push_rows(blocks); });
  if (!(most > 0)) return;
  row_slabs_.visit_particles(nullptr, [this](Index i) {
    if (is_pushed_[static_cast<std::size_t>(i)]) pushed_.push_back(i);
  });
  for (const Index k : pushed_) {
    const auto i = static_cast<std::size_t>(k);
    state.v[i] += to_vector(extra_[i]);
    pushed_v_.push_back(state.v[i]);
  }
}

template <class Real>
void ClothGuard<Real>::finish(ClothState<Real>& state) {
  for (std::size_t n = 0; n < pushed_.size(); ++n) {
    const auto i = static_cast<std::size_t>(pushed_[n]);
    Vec3<Real>& v = state.v[i];
    const Vec3<Real> extra = to_vector(extra_[i]);
    // What was stopped keeps no more of the push than it had, and gets no velocity against it.
    Real part = 1;
    if (v != pushed_v_[n]) {
      const Real size = extra.squaredNorm();
      part = size > 0 ? std::clamp(v.dot(extra) / size, Real(0), Real(1)) : Real(0);
    }
    v -= extra * part;
    extra_[i] = {};
    is_pushed_[i] = 0;
  }
  pushed_.clear();
  pushed_v_.clear();
}

template <class Real>
void ClothGuard<Real>::settle(ClothState<Real>& state, Real dt, Profile& profile) {
  if (rows_.empty()) return;
  profile[Stage::contact].work += rows_.size();
  row_slabs_.visit_particles(nullptr, [&](Index k) {
    legal_[static_cast<std::size_t>(k)] = to_quad(state.x[static_cast<std::size_t>(k)]);
  });
  load_rows(state);
  warm_rows(dt, dt / 2);
  store_rows(state);
  closed_ = true;
}

#define WEFT_INSTANTIATE(Real)                                                           \
  template void ClothGuard<Real>::solve(ClothState<Real>&, Real, Profile&);              \
  template void ClothGuard<Real>::forget_rows();                                         \
  template void ClothGuard<Real>::look_at_rows(const ClothState<Real>&, Real, Profile&); \
  template void ClothGuard<Real>::load_rows(const ClothState<Real>&);                    \
  template void ClothGuard<Real>::store_rows(ClothState<Real>&) const;                   \
  template void ClothGuard<Real>::finish(ClothState<Real>&);                             \
  template void ClothGuard<Real>::settle(ClothState<Real>&, Real, Profile&);             \
  template Real ClothGuard<Real>::sweep(ClothState<Real>&);                              \
  template void ClothGuard<Real>::respond_alone(ClothState<Real>&, Real);                \
  template void ClothGuard<Real>::find_busy_rows(Real);                                  \
  template bool ClothGuard<Real>::is_busy(GuardRow<Real>&, Real) const;                  \
  template void ClothGuard<Real>::warm_rows(Real, Real);                                 \
  template Real ClothGuard<Real>::sweep_rows();                                          \
  template void ClothGuard<Real>::measure_pressures();                                   \
  template Real ClothGuard<Real>::push_rows(std::span<const RowBlock<Real>>);            \
  template void ClothGuard<Real>::push_apart(ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
