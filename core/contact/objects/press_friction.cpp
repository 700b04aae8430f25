// What jaws of grippers hold, and objects that press cloth on others, and the friction that their
// force allows.

#include <algorithm>
#include <cassert>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/moving_rows.h"
#include "core/contact/objects/row_response.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Lists the moving rows that a jaw grips.
/// @param k  number of the jaw's collider
template <class Real>
void list_gripped(std::size_t k, const Vec3Array<Real>& x, ObjectRows<Real>& rows,
                  ColliderState& jaw, std::vector<GrippedRow>& gripped) {
  assert(jaw.press.acts() && jaw.is_jaw());
  gripped.clear();
  jaw.facing = 0;
  const Vec3<Real> press = jaw.press.direction.template cast<Real>();
  const Real slack = Real(jaw.layered ? kSqueezedLayers : kSqueezed);
  for (std::size_t m = 0; m < rows.moving.size(); ++m) {
    MovingRow<Real>& moving = rows.moving[m];
    if (moving.collider != k) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    if (!row.responds || !(row.normal.dot(press) > Real(kFacing))) continue;
    const Real gap = row.normal.dot(weighted(row, x)) - row.offset;
    if (gap < row.thickness * Real(kBeforeJaw))
      jaw.facing = std::max(jaw.facing, static_cast<double>(row.thickness));
    if (!(gap < row.thickness * (1 + slack))) continue;
    moving.layered = jaw.layered;
    gripped.push_back({m, at_index(jaw.mate)});
  }
}

/// Lists the moving rows of one side of what object `k` pinches. What did not move when they were
/// made has none; what presses itself shares its own force out.
template <class Real>
void list_pinched(std::size_t k, const std::vector<PinchRow>& side, const ObjectRows<Real>& rows,
                  const ColliderStates& colliders, std::vector<GrippedRow>& gripped) {
  gripped.clear();
  for (const PinchRow& pinch : side) {
    if (pinch.object != k) continue;
    const ContactRow<Real>& row = rows.all[pinch.row];
    const auto own = at_index(row.collider);
    if (row.mover == kNone || (own != k && colliders[own].press.hold > 0)) continue;
    gripped.push_back({at_index(row.mover), pinch.other});
  }
}

/// Sets the grip of each listed row to its weight in the shares. Particles alone carry the force,
/// where there are some, by their mass and so by area: rows of edges and triangles are denser at
/// the rims of jaws, and would turn the cloth between them. A few particles would not hold it
/// against turning; there all rows have equal shares.
/// @return the sum of these weights
template <class Real>
Real weigh(const std::vector<GrippedRow>& gripped, ObjectRows<Real>& rows) {
  Real mass = 0;
  int particles = 0;
  for (const GrippedRow& g : gripped) {
    MovingRow<Real>& moving = rows.moving[g.moving];
    assert(moving.mobility > 0 && "a row that responds can be moved");
    moving.grip = 1;
    if (rows.all[moving.row].count > 1) continue;
    ++particles;
    mass += 1 / moving.mobility;
  }
  if (particles < kHoldAlone) return static_cast<Real>(gripped.size());
  for (const GrippedRow& g : gripped) {
    MovingRow<Real>& moving = rows.moving[g.moving];
    moving.grip = rows.all[moving.row].count == 1 ? 1 / moving.mobility : Real(0);
  }
  return mass;
}

/// Two objects that press a layer against each other do so with the force of the weaker one.
/// @param k  number of one of them
Press press_of(std::size_t k, const ColliderStates& colliders) {
  Press press = colliders[k].press;
  assert(colliders[k].pinches());
  const Press& other = colliders[at_index(colliders[k].pinch.other)].press;
  if (other.other != static_cast<Index>(k)) return press;
  press.hold = std::min(press.hold, other.hold);
  press.squeeze = std::min(press.squeeze, other.squeeze);
  return press;
}

/// Shares what an object presses with among the listed rows, all of one object.
/// @return the friction that they allow in this step [N s]
template <class Real>
Real share(const Press& press, Real dt, const std::vector<GrippedRow>& gripped,
           ObjectSolve<Real>& solve) {
  assert(press.squeeze >= 0 && press.squeeze <= press.hold);
  ObjectRows<Real>& rows = solve.rows;
  const Real weights = weigh(gripped, rows);
  const Real share = weights > 0 ? dt / weights : Real(0);
  Real allowed = 0;
  for (const GrippedRow& g : gripped) {
    MovingRow<Real>& moving = rows.moving[g.moving];
    if (moving.grip == 0) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    const Real part = share * moving.grip;  // [s]
    // Rows at the rim lean, and their normals would not cancel those of the other jaw.
    const Vec3d impulse = press.direction * (press.squeeze * static_cast<double>(part));
    (*solve.motion.colliders)[moving.collider].squeezed += impulse;
    if (solve.log.wanted()) solve.log.add_squeeze(rows.all, moving.row, impulse);
    moving.grip = static_cast<Real>(press.hold) * part * moving.mobility * row.friction;
    allowed += moving.grip / moving.mobility;
  }
  return allowed;
}

/// Lets rows of one side rub from the start, in the direction in which their object slips past the
/// one on the other side.
/// @param part  of what each may, 0..1
template <class Real>
void begin_slip(const std::vector<GrippedRow>& gripped, const ObjectShapes<Real>& shapes, Real part,
                ObjectSolve<Real>& solve) {
  assert(part >= 0 && part <= 1);
  for (const GrippedRow& g : gripped) {
    MovingRow<Real>& moving = solve.rows.moving[g.moving];
    const ContactRow<Real>& row = solve.rows.all[moving.row];
    const Vec3<Real> point = weighted(row, solve.state.x);
    Vec3<Real> slip = moving.surface - shapes.frames[g.other].velocity_at(point);
    slip -= row.normal * row.normal.dot(slip);
    const Real speed = slip.norm();
    if (moving.grip == 0 || !(speed > Real(kSlips))) continue;
    moving.rubbed = slip * (part * moving.grip / speed);
    share_out(row, moving.rubbed, solve.state.v);
    solve.response.pushed.push_back(moving.row);
    take_reaction(moving, point, row.normal, moving.rubbed, solve.motion);
    if (solve.log.wanted()) solve.log.add(solve.rows.all, moving.row, moving.rubbed);
  }
}

/// An object that presses a layer on another one is like a jaw, and so is what braces the layer.
/// Where the two slip past each other only one can hold the layer, the one that may rub more; the
/// other one rubs with all that it may. Sweeps would find that in as many steps as each may rub
/// with the slip, so both sides begin with it.
template <class Real>
void share_press(std::size_t k, const ObjectShapes<Real>& shapes, Real dt,
                 ObjectSolve<Real>& solve) {
  ColliderStates& colliders = *solve.motion.colliders;
  if (!colliders[k].pinches()) return;  // it has let go
  std::vector<GrippedRow>&front = solve.response.gripped, &back = solve.response.braced;
  list_pinched(k, solve.pinches.fronts, solve.rows, colliders, front);
  list_pinched(k, solve.pinches.backs, solve.rows, colliders, back);
  Press press = press_of(k, colliders);
  const Real before = share(press, dt, front, solve);
  press.direction = -press.direction;
  const Real behind = share(press, dt, back, solve);
  if (!(before > 0 && behind > 0)) return;
  const Real both = std::min(before, behind);
  begin_slip(front, shapes, std::min(both / before, Real(1)), solve);
  begin_slip(back, shapes, std::min(both / behind, Real(1)), solve);
}

}  // namespace

/// Two jaws that hold cloth press it from both sides; the impulses of that cancel in the cloth and
/// are not solved for, but reported as forces, as far as layers do not resist with them already.
/// What they allow in friction is shared by the rows that touch: of each jaw friction times force
/// in all, and so twice that of both. It acts in each substep alike. What layers push with does
/// not, as they let go of the jaw for some substeps after each push; friction by that would let the
/// cloth fall for as long, and creep.
template <class Real>
void share_hold(ObjectSolve<Real>& solve, const ObjectShapes<Real>& shapes, Real dt) {
  assert(solve.motion.colliders && dt > 0);
  ColliderStates& colliders = *solve.motion.colliders;
  for (MovingRow<Real>& moving : solve.rows.moving) {
    moving.layered = false;
    moving.grip = 0;
    moving.rubbed.setZero();
  }
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    ColliderState& object = colliders[k];
    if (!object.press.acts()) continue;
    if (!object.is_jaw()) {
      share_press(k, shapes, dt, solve);
      continue;
    }
    list_gripped(k, solve.state.x, solve.rows, object, solve.response.gripped);
    if (object.press.hold > 0) share(object.press, dt, solve.response.gripped, solve);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(share_hold)

}  // namespace weft
