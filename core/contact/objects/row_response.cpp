// Velocities that respect the rows.

#include "core/contact/objects/row_response.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "core/contact/constants.h"
#include "core/contact/guard/cloth_guard.h"
#include "core/contact/objects/constants.h"
#include "core/contact/objects/moving_rows.h"
#include "core/stop_signal.h"

namespace weft {
namespace {

/// Velocity of a row's point over the object there [m/s].
template <class Real>
Vec3<Real> velocity_over(const ObjectRows<Real>& rows, const ContactRow<Real>& row,
                         const Vec3Array<Real>& v) {
  Vec3<Real> over = weighted(row, v);
  if (const MovingRow<Real>* moving = rows.moving_of(row)) over -= moving->surface;
  return over;
}

/// Where a row's point is pushed out, by a length of 1 along its normal. Between jaws that hold
/// cloth it is pushed as they press: rows at their rims lean, and push after push would lead the
/// cloth along the jaws, where friction holds velocities alone.
template <class Real>
Vec3<Real> push_way(const ObjectSolve<Real>& solve, const ContactRow<Real>& row) {
  const MovingRow<Real>* const moving = solve.rows.moving_of(row);
  if (!moving) return row.normal;
  const ColliderState& object = (*solve.motion.colliders)[moving->collider];
  if (!object.grips()) return row.normal;
  const Vec3<Real> press = object.press.direction.template cast<Real>();
  const Real facing = row.normal.dot(press);
  return facing > Real(kFacing) ? Vec3<Real>(press / facing) : row.normal;
}

/// Height to which a row's point is pushed out [m]. Cloth that is thicker than there is room for
/// between jaws that hold it is led out as they open, and no faster: pushed beyond their rims,
/// while they hold it, it would tear.
template <class Real>
Real height_wanted(const ObjectSolve<Real>& solve, const ContactRow<Real>& row) {
  const MovingRow<Real>* const moving = solve.rows.moving_of(row);
  if (!moving) return row.thickness;
  const ColliderState& object = (*solve.motion.colliders)[moving->collider];
  return object.grips() ? std::min(row.thickness, static_cast<Real>(object.press.room))
                        : row.thickness;
}

/// How far a row's point may be pushed on [m], others having moved it already. That does not count
/// while objects press: what holds on both sides of a layer must push alike, and as fast.
template <class Real>
Real most_push(const ObjectSolve<Real>& solve, const ContactRow<Real>& row, Real lack, Real dt) {
  const Real led = Real(kLeadOutSpeed) * dt;
  if (solve.motion.any_press) return led;
  const Vec3<Real> done = weighted(row, solve.state.x) - weighted(row, solve.response.x_unpushed);
  return (lack > row.thickness ? led : Real(kPushOutSpeed) * dt) - row.normal.dot(done);
}

/// Returns particles that a push brought too near to any plane to where they were: between objects
/// that close, or where cloth is drawn between two, one pushes it out into the other. What started
/// inside is led out however its edges lie.
template <class Real>
void take_back_pushes(const ObjectRows<Real>& rows, const Vec3Array<Real>& x_unpushed,
                      Real smallest_gap, Vec3Array<Real>& x) {
  for (const ContactRow<Real>& row : rows.all) {
    if (rows.leads_out(row)) continue;
    const Real wanted = least_height(row, row.mover != kNone, smallest_gap);
    for (std::size_t k = 0; k < row.count; ++k) {
      const auto i = at_index(row.particle[k]);
      if (x[i] == x_unpushed[i]) continue;
      const Real before = row.normal.dot(x_unpushed[i]) - row.offset;
      if (row.normal.dot(x[i]) - row.offset < std::min(before, wanted)) x[i] = x_unpushed[i];
    }
  }
}

/// Notes whether a row's point hits in this step, which would bring it there, and how fast it then
/// leaves. Of the motion before the kick and after it the slower counts: forces of one step, as
/// where cloth is pressed on an object, are no impact.
template <class Real>
void note_impact(ObjectSolve<Real>& solve, std::size_t r) {
  Bounces<Real>& bounces = solve.bounces;
  ContactRow<Real>& row = solve.rows.all[r];
  row.impact = kNone;
  const Real restitution = static_cast<Real>(settings_of(solve.cloths, row).restitution);
  if (restitution == 0) return;
  const auto speed_in = [&](const Vec3Array<Real>& v) {
    return row.normal.dot(velocity_over(solve.rows, row, v));
  };
  Real speed = speed_in(bounces.v_kicked.empty() ? solve.state.v : bounces.v_kicked);
  if (!bounces.v_came.empty()) speed = std::max(speed, speed_in(bounces.v_came));
  if (!(speed < std::min(row.least_speed, -static_cast<Real>(kBounceSpeed)))) return;
  row.impact = static_cast<Index>(bounces.impacts.size());
  bounces.impacts.push_back({r, -restitution * speed, 0});
}

/// Friction on a row that a jaw grips: what of the step's friction acts may change with each sweep,
/// up and down, and is at most what is allowed in all. So no sweep uses up what a later one needs.
/// @param slip     velocity along the plane [m/s]
/// @param allowed  what is allowed besides from now on [m/s]
/// @return the change of the velocity [m/s]
template <class Real>
Vec3<Real> rub_in_jaw(const Vec3<Real>& slip, Real allowed, MovingRow<Real>& moving) {
  assert(moving.grip > 0 && allowed >= 0);
  if (!moving.counted) moving.grip += allowed;
  Vec3<Real> rubbed = moving.rubbed - slip;
  if (const Real size = rubbed.norm(); size > moving.grip) rubbed *= moving.grip / size;
  const Vec3<Real> change = rubbed - moving.rubbed;
  moving.rubbed = rubbed;
  return change;
}

/// Pushes a row's point. Friction: the tangential velocity is stopped if that takes at most
/// friction times the normal impulse, else slowed by as much (Coulomb; eq. (10) of the seed). What
/// jaws hold has besides the normal impulses that cancel there, and their friction does not.
/// @param v,vn  velocity of the point over the object, and along the normal [m/s]
/// @param push     change of the latter [m/s]
/// @param pressed  how much of that is pressure that rubs [m/s]
/// @return the change of its velocity [m/s]
template <class Real>
Vec3<Real> respond(ObjectSolve<Real>& solve, std::size_t r, const Vec3<Real>& v, Real vn, Real push,
                   Real pressed) {
  const ContactRow<Real>& row = solve.rows.all[r];
  assert(row.responds && push >= pressed && pressed >= 0);
  MovingRow<Real>* const moving = solve.rows.moving_of(row);
  Vec3<Real> change = row.normal * push;
  if (row.friction > 0) {
    ++solve.friction_evaluations;
    const Vec3<Real> slip = v - row.normal * vn;
    const Real allowed = row.friction * pressed;
    if (moving && moving->grip > 0) {
      change += rub_in_jaw(slip, allowed, *moving);
    } else if (!moving || !moving->counted) {
      const Real speed = slip.norm();
      change -= speed > allowed ? (slip * (allowed / speed)).eval() : slip;
    }
  }
  const Vec3<Real> before = solve.state.v[at_index(row.particle[0])];
  share_out(row, change, solve.state.v);
  solve.response.pushed.push_back(r);
  if (moving) {
    moving->given += change.template cast<double>();
  } else if (solve.log.wanted()) {
    // What the velocity has got, rounded as it is, is what lone rows processed apart tell.
    const Vec3<Real> got = solve.state.v[at_index(row.particle[0])] - before;
    solve.log.add(solve.rows.all, r, row.count == 1 ? got : change);
  }
  return change;
}

/// What one look at a row has changed.
template <class Real>
struct RowChange {
  Real push = 0;                           ///< of the normal velocity [m/s]
  Vec3<Real> change = Vec3<Real>::Zero();  ///< of the velocity of its point [m/s]
};

/// Lets a row respond if it lacks normal velocity, or is gripped and may rub.
/// @param rubs  whether what pushes it adds to its friction
template <class Real>
RowChange<Real> solve_row(ObjectSolve<Real>& solve, std::size_t r, bool rubs = true) {
  const ContactRow<Real>& row = solve.rows.all[r];
  const Vec3<Real> v = velocity_over(solve.rows, row, solve.state.v);
  const Real vn = row.normal.dot(v);
  Real push = row.least_speed - vn;
  if (!(push > 0)) {
    const MovingRow<Real>* moving = solve.rows.moving_of(row);
    if (!moving || moving->grip == 0) return {};
    push = 0;
  } else if (row.impact != kNone) {
    solve.bounces.impacts[at_index(row.impact)].taken +=
        vn * vn - row.least_speed * row.least_speed;
  }
  return {push, respond(solve, r, v, vn, push, rubs ? push : Real(0))};
}

std::span<const Index> particles_of(const auto& row) {
  return std::span(row.particle).first(row.count);
}

/// Sweeps on where jaws hold cloth, over the rows whose particles the last sweep has changed. The
/// cloth between two jaws and round their rims is stopped from both sides; what the usual sweeps
/// leave of that would shake it all the time, and shaken cloth creeps out. What they push from both
/// sides is part of the jaws' force, whose friction is shared, and adds none.
template <class Real>
void settle_between_jaws(ObjectSolve<Real>& solve) {
  const auto is_of_jaw = [&solve](std::size_t collider) {
    return (*solve.motion.colliders)[collider].press.acts();
  };
  const auto is_jaws_row = [&](const MovingRow<Real>& row) { return is_of_jaw(row.collider); };
  const std::vector<MovingRow<Real>>& moving = solve.rows.moving;
  if (std::none_of(moving.begin(), moving.end(), is_jaws_row)) return;
  const bool jaws = std::any_of(moving.begin(), moving.end(), [&solve](const MovingRow<Real>& row) {
    const ColliderState& collider = (*solve.motion.colliders)[row.collider];
    return collider.is_jaw() && collider.press.hold > 0;
  });
  const int sweeps = jaws ? kJawSweeps : kPressSweeps;
  const Real residual = Real(jaws ? kJawResidual : kPressResidual);
  std::vector<int>& changed = solve.response.changed;
  changed.assign(solve.state.v.size(), kNone);
  const auto note = [&changed](const ContactRow<Real>& row, int sweep) {
    for (const Index i : particles_of(row)) changed[at_index(i)] = sweep;
  };
  for (const MovingRow<Real>& row : moving)
    if (is_jaws_row(row)) note(solve.rows.all[row.row], 0);
  bool any = true;
  for (int sweep = 1; any && sweep <= sweeps; ++sweep) {
    stop_point();
    any = false;
    const auto is_new = [&](Index i) { return changed[at_index(i)] + 1 >= sweep; };
    for (const std::size_t r : solve.response.busy) {
      const ContactRow<Real>& row = solve.rows.all[r];
      const auto particles = particles_of(row);
      if (std::none_of(particles.begin(), particles.end(), is_new)) continue;
      const MovingRow<Real>* const held = solve.rows.moving_of(row);
      const bool rubs = !is_of_jaw(at_index(row.collider)) && !(held && held->grip > 0);
      if (!(solve_row(solve, r, rubs).change.squaredNorm() > residual * residual)) continue;
      note(row, sweep);
      any = true;
    }
  }
}

/// What lone rows work on.
/// @param pushes  whether they push particles out
template <class Real>
LonePass<Real> lone_pass(ObjectSolve<Real>& solve, Real dt, bool pushes) {
  Vec3Array<Real>& given = solve.response.lone_given;
  return {solve.state.x.data()->data(),
          solve.state.v.data()->data(),
          dt,
          Real(kTouchSlack),
          pushes ? Real(kPushOutPart) : Real(0),
          Real(solve.motion.any_press ? kLeadOutSpeed : kPushOutSpeed) * dt,
          Real(kLeadOutSpeed) * dt,
          solve.reach.x.data()->data(),
          solve.reach.reach.data(),
          solve.reach.travel2.data(),
          given.empty() ? nullptr : given.data()->data()};
}

}  // namespace

template <class Real>
void begin_notes(ObjectSolve<Real>& solve) {
  if (!solve.log.wanted()) return;
  solve.log.see(solve.rows.all, solve.state);
  solve.response.lone_given.resize(solve.state.v.size(), Vec3<Real>::Zero());
}

template <class Real>
void note_lone(const ObjectRows<Real>& rows, RowResponse<Real>& response, ContactLog& log) {
  if (response.lone_given.empty()) return;
  rows.lone.for_each([&](std::size_t r) {
    Vec3<Real>& given = response.lone_given[at_index(rows.all[r].particle[0])];
    if (given.isZero(0)) return;
    log.add(rows.all, r, given);
    given.setZero();
  });
}

template <class Real>
void find_busy_rows(const ObjectRows<Real>& rows, const std::vector<Real>& travel2,
                    const ContactLog& log, RowResponse<Real>& response) {
  assert(rows.rooms.size() == rows.all.size());
  response.busy.clear();
  response.pushed.clear();
  response.lone_apart = !log.wants_each();
  response.lone = {};
  for_joint_rows(rows, response, [&](std::size_t r) {
    const ContactRow<Real>& row = rows.all[r];
    const RowRoom<Real>& room = rows.rooms[r];
    if (row.mover != kNone ? row.responds : !(farthest2(room, travel2) < room.touch2))
      response.busy.push_back(r);
  });
}

template <class Real>
void respond_alone(ObjectSolve<Real>& solve, Real dt, bool pushes) {
  if (!solve.response.lone_apart) return;
  solve.response.lone = solve.rows.lone.respond(lone_pass(solve, dt, pushes), solve.executor);
}

template <class Real>
void push_out(ObjectSolve<Real>& solve, Real smallest_gap, Real dt) {
  ObjectRows<Real>& rows = solve.rows;
  RowResponse<Real>& response = solve.response;
  ClothState<Real>& state = solve.state;
  assert(response.pushed.empty() && dt > 0);
  // Where nothing moves, only pushes are taken back.
  const bool moves = !rows.moving.empty();
  if (moves) response.x_unpushed = state.x;
  for (const std::size_t r : response.busy) {
    const ContactRow<Real>& row = rows.all[r];
    const Real gap = row.normal.dot(weighted(row, state.x)) - row.offset;
    const Real lack = height_wanted(solve, row) - gap;
    if (!(lack > Real(kTouchSlack))) continue;
    if (!moves && response.pushed.empty()) response.x_unpushed = state.x;
    const Real step = std::min(lack * Real(kPushOutPart), most_push(solve, row, lack, dt));
    if (!(step > 0)) continue;
    share_out<Real>(row, push_way(solve, row) * step, state.x);
    response.pushed.push_back(r);
  }
  if (!response.pushed.empty()) take_back_pushes(rows, response.x_unpushed, smallest_gap, state.x);
  // A lone particle leaves the only plane that it could come too near to.
  respond_alone(solve, dt, true);
}

template <class Real>
void aim_rows(ObjectSolve<Real>& solve, const ObjectShapes<Real>& shapes, Real dt) {
  assert(dt > 0);
  solve.bounces.impacts.clear();
  for (const std::size_t r : solve.response.busy) {
    ContactRow<Real>& row = solve.rows.all[r];
    const Vec3<Real> point = weighted(row, solve.state.x);
    const Real gap = row.normal.dot(point) - row.offset;
    row.least_speed = -std::max(Real(0), gap - row.thickness - Real(kTouchSlack)) / dt;
    if (MovingRow<Real>* moving = solve.rows.moving_of(row))
      moving->surface = shapes.frames[moving->collider].velocity_at(point);
    if (solve.cloths.bounces) note_impact(solve, r);
  }
}

template <class Real>
Real sweep_rows(ObjectSolve<Real>& solve, bool again) {
  ObjectRows<Real>& rows = solve.rows;
  Real largest = 0;
  if (solve.response.lone_apart && !again) {
    const LoneResponse<Real> lone =
        rows.lone.sweep(lone_pass(solve, Real(0), false), solve.executor);
    largest = lone.largest;
    solve.friction_evaluations += lone.friction_evaluations;
  }
  for (const std::size_t r : solve.response.busy) {
    if (again && rows.lone.has(r)) continue;
    largest = std::max(largest, solve_row(solve, r).push);
  }
  return largest;
}

template <class Real>
void solve_rows(ObjectSolve<Real>& solve, Real dt, ClothGuard<Real>* guard) {
  const LoneResponse<Real>& lone = solve.response.lone;
  solve.friction_evaluations += lone.friction_evaluations;
  Real left = lone.largest, among_cloths = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    stop_point();
    const bool again = sweep == 0 ? solve.response.lone_apart : !(among_cloths > 0);
    left = std::max(left, sweep_rows(solve, again));
    if (guard && sweep == 0) among_cloths = guard->sweep(solve.state);
  }
  if (solve.motion.any_press) settle_between_jaws(solve);
  if (!(among_cloths > static_cast<Real>(kStill))) guard = nullptr;
  const Real enough = solve.cloths.thickness * Real(kResidual) / dt;
  for (int sweep = 0; guard && sweep < kMoreSweeps && (sweep == 0 || left > enough); ++sweep) {
    if (!(guard->sweep(solve.state) > (sweep == 0 ? Real(0) : enough))) break;
    left = sweep_rows(solve);
  }
}

template <class Real>
void bounce(ObjectSolve<Real>& solve, ClothGuard<Real>* guard) {
  solve.bounces.v_came.clear();
  solve.bounces.v_kicked.clear();
  if (solve.bounces.impacts.empty()) return;
  for (const Impact<Real>& impact : solve.bounces.impacts) {
    const ContactRow<Real>& row = solve.rows.all[impact.row];
    const Real restitution = static_cast<Real>(settings_of(solve.cloths, row).restitution);
    const Vec3<Real> v = velocity_over(solve.rows, row, solve.state.v);
    const Real vn = row.normal.dot(v);
    const Real fastest = std::sqrt(vn * vn + restitution * restitution * impact.taken);
    const Real push = std::min(impact.speed, fastest) - vn;
    if (push > 0) respond(solve, impact.row, v, vn, push, push);
  }
  if (guard) guard->sweep(solve.state);
  sweep_rows(solve);
}

#define WEFT_INSTANTIATE(Real)                                                    \
  template void find_busy_rows(const ObjectRows<Real>&, const std::vector<Real>&, \
                               const ContactLog&, RowResponse<Real>&);            \
  template decltype(begin_notes<Real>) begin_notes<Real>;                         \
  template decltype(note_lone<Real>) note_lone<Real>;                             \
  template decltype(respond_alone<Real>) respond_alone<Real>;                     \
  template void push_out(ObjectSolve<Real>&, Real, Real);                         \
  template decltype(aim_rows<Real>) aim_rows<Real>;                               \
  template Real sweep_rows(ObjectSolve<Real>&, bool);                             \
  template decltype(solve_rows<Real>) solve_rows<Real>;                           \
  template decltype(bounce<Real>) bounce<Real>;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
