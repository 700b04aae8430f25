// The contact solver of ClothGuard: projected Gauss-Seidel on the velocities of its rows.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/guard/cloth_guard.h"

namespace weft {
namespace {

/// Rows that push nobody rest until the next look, so many steps later, unless their room is less
/// than this part of the radius and so many times what it shrinks by until then.
constexpr int kStepsBetweenLooks = 4;
constexpr double kBusyRoom = 0.02, kBusyApproach = 2;

/// Where cloths meet nothing but each other sweeps are repeated, up to so many, while one changes
/// what something moves in the step by more than this part of the thickness. What one sweep leaves
/// under load sinks in, and the push that leads it out again does work that nobody gave.
constexpr int kMostSweeps = 3;
constexpr double kResidual = 0.01;

/// Rows that push turn with their features every so many steps.
constexpr int kStepsBetweenTurns = 4;

/// Space is cut anew into slabs every so many steps, before a look.
constexpr int kStepsBetweenCuts = 64;

/// Time in which a contact that sticks goes back to its anchor [s], but no faster than this, which
/// nobody sees [m/s]; and how far that may be, as a part of the radius: what slides drags its
/// anchor along, and what did so for a moment, as the load went over to other rows, goes back.
constexpr double kStickTime = 0.02, kFastestReturn = 1e-3, kMostSlip = 0.008;

/// Push-out: part of the lack a second, and its largest speed [1/s, m/s].
constexpr double kPushRate = 60, kPushSpeed = 0.1;

/// A lack of this part of the radius is let be: what cannot part, in tight folds, would be pushed
/// for ever, and the push drives the springs that bring it back.
constexpr double kPushSlack = 0.1;

/// Pressure takes thickness from layers, in proportion: as much as laboratories press fabrics with
/// (KES), which takes a third to a half of theirs, would take all of it [Pa], but for a part. What
/// is pressed so is not pushed: the push would stretch it, and lift what presses, with energy that
/// nobody gave.
constexpr double kFlattening = 5e3, kMostFlattening = 0.75;

/// Harder pressed than this, as only between objects, layers let go of so much of what they press
/// each other with in a step, at twice the pressure [Pa].
constexpr double kCrushing = 2e4, kLeak = 0.1;

/// A vector, but no longer than `most`.
template <class Real>
Quad<Real> shortened(const Quad<Real>& v, Real most) {
  const Real length2 = dot(v, v);
  return length2 > most * most ? v * (most / std::sqrt(length2)) : v;
}

}  // namespace

template <class Real>
void ClothGuard<Real>::solve(ClothState<Real>& state, Real dt, Profile& profile) {
  const Real kicked = std::exchange(closed_, false) ? dt / 2 : dt;
  calm_ = active_.empty() && open_pairs() == 0;
  if (calm_) {
    x_before_ = state.x;
    rows_.clear();
    row_slabs_.clear();
    return;
  }
  for (std::size_t i = 0; i < legal_.size(); ++i) legal_[i] = to_quad(state.x[i]);
  tangles_.draw(state, dt);
  rows_time_ += dt;
  ++rows_steps_;
  if (find_moved()) renew_rows(state, profile);
  if (rows_steps_ % kStepsBetweenCuts == 0) {
    row_slabs_.cut(active_, legal_);
    rows_listed_ = false;
  }
  if (!arrived_.empty()) add_arrived(state, profile);
  if (rows_.empty()) {
    row_slabs_.clear();
    return;
  }
  load_rows(state);
  if (rows_steps_ % kStepsBetweenLooks == 0) {
    find_busy_rows(dt);
    measure_pressures();
  }
  if (rows_steps_ % kStepsBetweenTurns == 0) turn_rows(state, profile);
  profile[Stage::contact].work += rows_.size();
  warm_rows(dt, kicked);
  store_rows(state);
}

template <class Real>
void ClothGuard<Real>::load_rows(const ClothState<Real>& state) {
  row_slabs_.visit_particles(executor_, [&](Index k) {
    const auto i = static_cast<std::size_t>(k);
    quad_v_[i] = to_quad(state.v[i]);
  });
}

template <class Real>
void ClothGuard<Real>::store_rows(ClothState<Real>& state) const {
  row_slabs_.visit_particles(executor_, [&](Index k) {
    const auto i = static_cast<std::size_t>(k);
    state.v[i] = to_vector(quad_v_[i]);
  });
}

/// Normal velocity that a row must reach: no nearer than its radius within the step. Adds to the
/// slip how far it really went. Who bounces a little, as particles of a resting cloth do, keeps his
/// anchor: it would creep down every slope.
template <class Real>
void ClothGuard<Real>::aim(GuardRow<Real>& row, Real dt) const {
  const Quad<Real> apart = weighted(row, legal_);
  row.room = dot(row.normal, apart) - row.radius;
  if (row.push == 0 && row.room > row.radius * Real(kBusyRoom)) {
    row.slip = {};
  } else if (row.friction > 0) {
    row.slip += tangential(row, apart - row.apart);
  }
  row.apart = apart;
  row.least_speed = row.room > 0 ? -row.room / dt : Real(0);
}

/// One row of a sweep. Friction brings what sticks back to its anchor, and lets it slide where that
/// takes more than Coulomb's bound.
/// @return change of the normal velocity [m/s]
template <class Real>
Real ClothGuard<Real>::solve_row(GuardRow<Real>& row) {
  const Quad<Real> v = weighted(row, quad_v_);
  const Real speed = dot(row.normal, v);
  if (row.push == 0 && speed >= row.least_speed) return 0;
  const Real push = std::max(Real(0), row.push + (row.least_speed - speed) * row.inertia);
  const Real more = push - row.push;
  Quad<Real> change = row.normal * more;
  row.push = push;
  if (row.friction > 0) {
    const Quad<Real> slide = v - row.normal * speed;
    const Quad<Real> back =
        shortened(row.slip * Real(1 / kStickTime), static_cast<Real>(kFastestReturn));
    const Quad<Real> wanted = row.drag - (slide + back) * row.inertia;
    const Real most = row.friction * push, size2 = dot(wanted, wanted);
    const bool slides = size2 > most * most;
    const Quad<Real> drag = slides ? wanted * (most / std::sqrt(size2)) : wanted;
    if (slides) row.slip = shortened(row.slip, row.radius * static_cast<Real>(kMostSlip));
    change += drag - row.drag;
    row.drag = drag;
  }
  share_out(row, change, quad_v_);
  return std::abs(more) / row.inertia;
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

/// What a row that is pressed very hard keeps of its impulse from one step to the next.
///
/// Between objects that do not give way, layers can press each other and the objects with any force
/// whatever: it is in balance and none of it is seen in a velocity. Each error adds to it and
/// nothing takes from it, until its own errors drive the cloth. So it leaks away; what is needed
/// comes back in the sweeps.
template <class Real>
Real ClothGuard<Real>::kept_part(const GuardRow<Real>& row) const {
  const Real over = pressure_on(row) / static_cast<Real>(kCrushing) - 1;
  return 1 - static_cast<Real>(kLeak) * std::clamp(over, Real(0), Real(1));
}

/// Starts from the impulses of the last step.
/// @param kicked  time of the forces since then that they have to stand against [s]
template <class Real>
void ClothGuard<Real>::warm_rows(Real dt, Real kicked) {
  const Real warm = kicked_ > 0 ? kicked / kicked_ : Real(0);
  kicked_ = kicked;
  row_slabs_.visit(executor_, [&](Index k) {
    GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    aim(row, dt);
    if (row.push == 0) return;
    const Real kept = warm * kept_part(row);
    row.push *= kept;
    row.drag = row.drag * kept;
    share_out(row, row.normal * row.push + row.drag, quad_v_);
  });
}

/// A sweep of projected Gauss-Seidel, from either end in turn.
/// @return largest change of a normal velocity [m/s]
template <class Real>
Real ClothGuard<Real>::sweep_rows() {
  upwards_ = !upwards_;
  return row_slabs_.largest(executor_, upwards_, [this](Index k) {
    return solve_row(rows_[static_cast<std::size_t>(k)]);
  });
}

/// Pressure about each particle of a row, from what pushes it: single rows share a load by chance.
/// Layers are pressed from both sides.
template <class Real>
void ClothGuard<Real>::measure_pressures() {
  row_slabs_.visit_particles(executor_,
                             [this](Index i) { pressure_[static_cast<std::size_t>(i)] = 0; });
  row_slabs_.visit(executor_, [&](Index k) {
    const GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    if (row.push == 0) return;
    const Real force = row.push / (2 * kicked_);
    for (std::size_t n = 0; n < 4; ++n) {
      const auto i = static_cast<std::size_t>(row.particle[n]);
      pressure_[i] += std::abs(row.weight[n]) * force * inverse_area_[i];
    }
  });
}

/// Mean pressure on the features of a row [Pa].
template <class Real>
Real ClothGuard<Real>::pressure_on(const GuardRow<Real>& row) const {
  Real both = 0;
  for (std::size_t n = 0; n < 4; ++n)
    both += std::abs(row.weight[n]) * pressure_[static_cast<std::size_t>(row.particle[n])];
  return both / 2;
}

/// How much a row lacks of its radius, less what the pressure on its features takes [m].
template <class Real>
Real ClothGuard<Real>::lack_of(const GuardRow<Real>& row) const {
  const Real pressed = std::min(pressure_on(row) * Real(1 / kFlattening), Real(kMostFlattening));
  return -row.room - row.radius * pressed;
}

template <class Real>
void ClothGuard<Real>::push_apart(ClothState<Real>& state) {
  const Real most = row_slabs_.largest(executor_, true, [this](Index k) {
    const GuardRow<Real>& row = rows_[static_cast<std::size_t>(k)];
    if (!(-row.room > row.radius * Real(kPushSlack))) return Real(0);
    const Real lack = lack_of(row);
    if (!(lack > row.radius * Real(kPushSlack))) return Real(0);
    const Real wanted = std::min(lack * Real(kPushRate), static_cast<Real>(kPushSpeed));
    const Real more = wanted - dot(row.normal, weighted(row, extra_));
    if (!(more > 0)) return Real(0);
    share_out(row, row.normal * (more * row.inertia), extra_);
    for (const Index i : row.particle) is_pushed_[static_cast<std::size_t>(i)] = 1;
    return more;
  });
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

#define WEFT_INSTANTIATE(Real)                                               \
  template void ClothGuard<Real>::solve(ClothState<Real>&, Real, Profile&);  \
  template void ClothGuard<Real>::load_rows(const ClothState<Real>&);        \
  template void ClothGuard<Real>::store_rows(ClothState<Real>&) const;       \
  template void ClothGuard<Real>::finish(ClothState<Real>&);                 \
  template void ClothGuard<Real>::settle(ClothState<Real>&, Real, Profile&); \
  template void ClothGuard<Real>::aim(GuardRow<Real>&, Real) const;          \
  template Real ClothGuard<Real>::solve_row(GuardRow<Real>&);                \
  template Real ClothGuard<Real>::sweep(ClothState<Real>&);                  \
  template void ClothGuard<Real>::respond_alone(ClothState<Real>&, Real);    \
  template void ClothGuard<Real>::find_busy_rows(Real);                      \
  template bool ClothGuard<Real>::is_busy(GuardRow<Real>&, Real) const;      \
  template void ClothGuard<Real>::warm_rows(Real, Real);                     \
  template Real ClothGuard<Real>::sweep_rows();                              \
  template void ClothGuard<Real>::measure_pressures();                       \
  template Real ClothGuard<Real>::kept_part(const GuardRow<Real>&) const;    \
  template Real ClothGuard<Real>::pressure_on(const GuardRow<Real>&) const;  \
  template Real ClothGuard<Real>::lack_of(const GuardRow<Real>&) const;      \
  template void ClothGuard<Real>::push_apart(ClothState<Real>&);
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
