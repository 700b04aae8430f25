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

/// Lists the moving rows that a jaw grips, or would.
/// @param k      number of the jaw's collider
/// @param press  direction in which it closes, unit
template <class Real>
void list_gripped(std::size_t k, const Vec3d& press, const Vec3Array<Real>& x,
                  ObjectRows<Real>& rows, ColliderState& jaw, std::vector<GrippedRow>& gripped) {
  assert(jaw.press.acts() && jaw.is_jaw());
  gripped.clear();
  jaw.facing = 0;
  const Vec3<Real> way = press.template cast<Real>();
  const Real slack = Real(jaw.layered ? kSqueezedLayers : kSqueezed);
  for (std::size_t m = 0; m < rows.moving.size(); ++m) {
    MovingRow<Real>& moving = rows.moving[m];
    if (moving.collider != k) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    if (!row.responds || !(row.normal.dot(way) > Real(kFacing))) continue;
    const Real gap = row.normal.dot(weighted(row, x)) - row.offset;
    if (gap < row.thickness * Real(kBeforeJaw))
      jaw.facing = std::max(jaw.facing, static_cast<double>(row.thickness));
    if (!(gap < row.thickness * (1 + slack))) continue;
    moving.counted = jaw.layered;
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

/// What an object presses a layer with besides what this resists already. Two that press it against
/// each other do so with the force of the weaker one.
/// @param k  number of one of them
double squeeze_of(std::size_t k, const ColliderStates& colliders) {
  const Press& press = colliders[k].press;
  assert(colliders[k].pinches());
  const Press& other = colliders[at_index(colliders[k].pinch.other)].press;
  const bool opposed = other.other == static_cast<Index>(k) || other.other == colliders[k].mate;
  if (other.other == kNone || !opposed) return press.squeeze;
  const double parts = other.parts / static_cast<double>(press.parts);
  return std::min(press.squeeze, other.squeeze * parts);
}

/// Shares what an object presses with among the listed rows, all of one object.
/// @param tells  whether these rows are told as those that press
/// @return the friction that they allow in this step [N s]
template <class Real>
Real share(const Press& press, Real dt, const std::vector<GrippedRow>& gripped, bool tells,
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
    (*solve.motion.colliders)[moving.collider].besides += impulse;
    if (tells && solve.log.wanted()) solve.log.add_squeeze(rows.all, moving.row, impulse);
    moving.grip = static_cast<Real>(press.hold) * part * moving.mobility * row.friction;
    allowed += moving.grip / moving.mobility;
  }
  return allowed;
}

/// Tells the squeeze of a jaw as that of the particles that both jaws hold, by their mass: so both
/// press at the same places, as their squeezes cancel in the cloth, wherever rows lie at the rim of
/// one of them. A few particles are not where the jaws press.
/// @param gripped   rows of the jaw
/// @param opposite  those of the other one
/// @return whether there are enough of such particles
template <class Real>
bool tell_squeeze(const Press& press, Real dt, const std::vector<GrippedRow>& gripped,
                  const std::vector<GrippedRow>& opposite, ObjectSolve<Real>& solve) {
  const ObjectRows<Real>& rows = solve.rows;
  constexpr int kOpposite = 0, kBoth = 1;
  std::vector<int>& held = solve.response.changed;  // each particle; free until the rows are swept
  held.assign(solve.state.v.size(), kNone);
  const auto for_particles = [&rows](const std::vector<GrippedRow>& list, auto&& visit) {
    for (const GrippedRow& g : list) {
      const ContactRow<Real>& row = rows.all[rows.moving[g.moving].row];
      if (row.count == 1) visit(at_index(row.particle[0]), rows.moving[g.moving]);
    }
  };
  for_particles(opposite, [&](std::size_t i, const MovingRow<Real>&) { held[i] = kOpposite; });
  double mass = 0;
  int particles = 0;
  for_particles(gripped, [&](std::size_t i, const MovingRow<Real>& moving) {
    if (held[i] != kOpposite) return;
    held[i] = kBoth;
    mass += 1 / static_cast<double>(moving.mobility);
    ++particles;
  });
  if (particles < kHoldAlone) return false;
  const Vec3d impulse = press.direction * (press.squeeze * static_cast<double>(dt) / mass);
  for_particles(gripped, [&](std::size_t i, const MovingRow<Real>& moving) {
    if (held[i] != kBoth) return;
    held[i] = kNone;  // of a particle with two rows one is enough
    solve.log.add_squeeze(rows.all, moving.row, impulse / static_cast<double>(moving.mobility));
  });
  return true;
}

/// Shares what object `k` presses a layer with among the rows on one side of that. Each side has
/// the friction of its own normal force: what else pulls or presses the layer, as hands that lift
/// it and its weight, is borne by one of both. What rows push with for that comes in strokes, and
/// what they allow is shared as the squeeze is, with their mean of the last tick.
/// @param side  0: next to the object, 1: behind the layer
/// @return the friction that the rows allow in this step [N s]
template <class Real>
Real share_side(std::size_t k, std::size_t side, Real dt, const std::vector<GrippedRow>& gripped,
                ObjectSolve<Real>& solve) {
  const ColliderStates& colliders = *solve.motion.colliders;
  Press press = colliders[k].press;
  press.squeeze = squeeze_of(k, colliders);
  press.hold = press.squeeze + press.pushes[side];
  if (side == 1) press.direction = -press.direction;
  for (const GrippedRow& g : gripped) {
    MovingRow<Real>& moving = solve.rows.moving[g.moving];
    moving.counted = true;
    moving.presser = static_cast<Index>(k);
    moving.side = side;
  }
  return share(press, dt, gripped, true, solve);
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
    moving.given += moving.rubbed.template cast<double>();
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
  const Real before = share_side(k, 0, dt, front, solve);
  const Real behind = share_side(k, 1, dt, back, solve);
  if (!(before > 0 && behind > 0)) return;
  const Real both = std::min(before, behind);
  begin_slip(front, shapes, std::min(both / before, Real(1)), solve);
  begin_slip(back, shapes, std::min(both / behind, Real(1)), solve);
}

}  // namespace

/// Jaw `k` presses what it holds on the other jaw.
template <class Real>
void share_grip(std::size_t k, Real dt, ObjectSolve<Real>& solve) {
  ColliderStates& colliders = *solve.motion.colliders;
  ColliderState& jaw = colliders[k];
  std::vector<GrippedRow>&gripped = solve.response.gripped, &opposite = solve.response.braced;
  list_gripped(k, jaw.press.direction, solve.state.x, solve.rows, jaw, gripped);
  if (jaw.press.hold == 0) return;
  bool told = false;
  if (solve.log.wanted()) {
    const std::size_t mate = at_index(jaw.mate);
    list_gripped(mate, -jaw.press.direction, solve.state.x, solve.rows, colliders[mate], opposite);
    told = tell_squeeze(jaw.press, dt, gripped, opposite, solve);
  }
  share(jaw.press, dt, gripped, !told, solve);
}

/// Finds what a jaw has in front of it that presses on another object, where it may close.
template <class Real>
void note_facing(std::size_t k, ObjectSolve<Real>& solve) {
  ColliderStates& colliders = *solve.motion.colliders;
  ColliderState& jaw = colliders[k];
  const Vec3d closing = colliders[at_index(jaw.mate)].pose.position - jaw.pose.position;
  list_gripped(k, closing.normalized(), solve.state.x, solve.rows, jaw, solve.response.gripped);
}

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
    moving.counted = false;
    moving.presser = kNone;
    moving.grip = 0;
    moving.rubbed.setZero();
  }
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    ColliderState& object = colliders[k];
    if (!object.press.acts()) continue;
    if (object.is_jaw() && object.press.other == kNone) {
      share_grip(k, dt, solve);
      continue;
    }
    if (object.is_jaw()) note_facing(k, solve);
    share_press(k, shapes, dt, solve);
  }
}

WEFT_INSTANTIATE_FUNCTIONS(share_hold)

}  // namespace weft
