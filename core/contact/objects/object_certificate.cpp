// Certifies a drift where no object moves.

#include "core/contact/objects/object_certificate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/moving_rows.h"
#include "core/contact/travel.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Measures the displacements of those particles alone that the rows have moved or pushed since all
/// were measured; those of lone rows have been as they responded.
/// @return whether these stay within their reach
template <class Real>
bool measure_pushed_travel(ObjectCertificate<Real>& c) {
  RowReach<Real>& reach = c.reach;
  bool within = c.response.lone.within;
  for (const std::size_t r : c.response.pushed) {
    const ContactRow<Real>& row = c.rows.all[r];
    for (std::size_t k = 0; k < row.count; ++k) {
      const auto i = at_index(row.particle[k]);
      const Vec3<Real> moved = c.state.x[i] - reach.x[i];
      const Real end2 = (moved + c.state.v[i] * c.dt).squaredNorm();
      reach.travel2[i] = std::max(moved.squaredNorm(), end2);
      within &= end2 <= reach.reach[i] * reach.reach[i];
    }
  }
  return within;
}

/// Notes that a particle was held, as an impulse of the object whose plane is nearest to it.
/// @param before  its velocity until then [m/s]
template <class Real>
void log_hold(ObjectCertificate<Real>& c, std::size_t i, const Vec3<Real>& before) {
  const ContactRow<Real>* nearest = nullptr;
  std::size_t place = 0;
  Real least = std::numeric_limits<Real>::infinity();
  for (const ContactRow<Real>& row : c.rows.all) {
    const Real room = row.normal.dot(c.state.x[i]) - row.offset;
    if (!(room < least)) continue;
    for (std::size_t k = 0; k < row.count; ++k) {
      if (at_index(row.particle[k]) != i) continue;
      nearest = &row;
      place = k;
      least = room;
    }
  }
  if (nearest) tell_stop(c, *nearest, place, before);
}

/// Holds particles that would go beyond the reach within which the planes are all that matters. Not
/// moving is always allowed. Rows are made anew then: what another cloth pushes would else stand at
/// its reach for ever, as it is pushed after its travel was looked at.
template <class Real>
void hold_within_reach(ObjectCertificate<Real>& c) {
  for (std::size_t i = 0; i < c.state.x.size(); ++i) {
    const Vec3<Real> end = c.state.x[i] + c.state.v[i] * c.dt;
    const Real reach = c.reach.reach[i] - c.motion.since_rows;
    if ((end - c.reach.x[i]).squaredNorm() <= reach * std::abs(reach)) continue;
    const Vec3<Real> before = c.state.v[i];
    c.state.v[i].setZero();
    c.reach.made = false;
    if (c.log.wanted()) log_hold(c, i, before);
  }
}

}  // namespace

template <class Real>
bool measure_travel(const ClothState<Real>& state, Real dt, Real less, Executor* executor,
                    RowReach<Real>& reach) {
  assert(less >= 0 && reach.x.size() == state.x.size() && reach.travel2.size() == state.x.size());
  const TravelPass<Real> pass{state.x.size(),
                              state.x.data()->data(),
                              state.v.data()->data(),
                              dt,
                              reach.x.data()->data(),
                              reach.reach.data(),
                              less,
                              reach.travel2.data()};
  return run_travel(pass, executor);
}

template <class Real>
void tell_stop(ObjectCertificate<Real>& c, const ContactRow<Real>& row, std::size_t k,
               const Vec3<Real>& before) {
  assert(k < row.count);
  const auto i = at_index(row.particle[k]);
  const Vec3<Real> change = c.state.v[i] - before;
  if (row.mover != kNone) {
    assert(c.state.inverse_mass[i] > 0 && "what is held is not stopped");
    const Vec3<Real> impulse = change / c.state.inverse_mass[i];
    (*c.motion.colliders)[at_index(row.collider)].besides +=
        impulse.template cast<double>() * c.motion.force_ratio;
  }
  if (!c.log.wanted()) return;
  ContactRow<Real> single = row;
  single.particle = {row.particle[k], 0, 0};
  single.weight = {Real(1), 0, 0};
  single.count = 1;
  c.log.add_apart(single, change, c.state);
}

template <class Real>
bool keep_off(ObjectCertificate<Real>& c, const ContactRow<Real>& row, bool hold) {
  ClothState<Real>& state = c.state;
  bool kept = false;
  for (std::size_t k = 0; k < row.count; ++k) {
    const auto i = at_index(row.particle[k]);
    const Real now = row.normal.dot(state.x[i]) - row.offset;
    const Real end = row.normal.dot(state.x[i] + state.v[i] * c.dt) - row.offset;
    const Real least = least_end(row, now, c.smallest_gap);
    if (end >= least || state.inverse_mass[i] == 0 || state.v[i].isZero(0)) continue;
    kept = true;
    const Vec3<Real> before = state.v[i];
    if (hold)
      state.v[i].setZero();
    else
      state.v[i] += row.normal * ((least - end) / c.dt * Real(kLiftSlack));
    tell_stop(c, row, k, before);
  }
  return kept;
}

template <class Real>
void certify(ObjectCertificate<Real>& c, bool others) {
  assert(c.dt > 0 && c.rows.rooms.size() == c.rows.all.size());
  if (!c.rows.moving.empty()) return certify_with_movers(c);
  const Real less = c.motion.since_rows;
  const bool within = others || less > 0 ? measure_travel(c.state, c.dt, less, c.executor, c.reach)
                                         : measure_pushed_travel(c);
  if (!within) {
    hold_within_reach(c);
    measure_travel(c.state, c.dt, less, c.executor, c.reach);
  }
  bool kept = false;
  for_near_rows(c, [&](const ContactRow<Real>& row) { kept |= keep_off(c, row, false); });
  if (!kept) return;
  for (int round = 1; round < kCertifyRounds && kept; ++round) {
    kept = false;
    for (const ContactRow<Real>& row : c.rows.all) kept |= keep_off(c, row, false);
  }
  if (kept) {
    for (const ContactRow<Real>& row : c.rows.all) keep_off(c, row, true);
  }
  hold_within_reach(c);
}

WEFT_INSTANTIATE_FUNCTIONS(measure_travel, tell_stop, keep_off, certify)

}  // namespace weft
