// Books the reactions of moving objects, and turns the planes that go with them.

#include "core/contact/objects/moving_rows.h"

#include <cassert>

#include "core/instantiate.h"

namespace weft {
namespace {

/// Adds what a row has given to the sums of its object.
/// @param point   of the row [m]
/// @param normal  of the row
template <class Real>
void take_reaction(const MovingRow<Real>& row, const Vec3<Real>& point, const Vec3<Real>& normal,
                   ObjectMotion<Real>& motion) {
  assert(motion.colliders && row.mobility > 0);
  ColliderState& state = (*motion.colliders)[row.collider];
  const Vec3d impulse = row.given / static_cast<double>(row.mobility);
  const Vec3d along = normal.template cast<double>();
  state.impulse += impulse;
  state.pushed += along * along.dot(impulse);
  const Vec3d turn = (point.template cast<double>() - state.pose.position).cross(impulse);
  state.angular_impulse += turn;
  state.told.impulse += impulse * motion.force_ratio;
  state.told.angular += turn * motion.force_ratio;
  motion.work += impulse.dot(row.surface.template cast<double>()) * motion.force_ratio;
  if (row.presser != kNone)
    (*motion.colliders)[at_index(row.presser)].pinch.pushes[row.side] += along.dot(impulse);
}

}  // namespace

template <class Real>
void book_reactions(const Vec3Array<Real>& x, ObjectRows<Real>& rows, ObjectMotion<Real>& motion,
                    ContactLog& log) {
  for (MovingRow<Real>& moving : rows.moving) {
    if (moving.given.isZero(0)) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    take_reaction(moving, weighted(row, x), row.normal, motion);
    if (log.wanted()) log.add(rows.all, moving.row, moving.given);
    moving.given.setZero();
  }
}

template <class Real>
void turn_with_objects(const ObjectShapes<Real>& shapes, ContactLog& log, ObjectRows<Real>& rows) {
  for (const MovingRow<Real>& moving : rows.moving) {
    const ColliderFrame<Real>& frame = shapes.frames[moving.collider];
    if (!frame.moves) continue;
    const Vec3d normal = frame.pose.rotation * moving.own_normal;
    const Vec3d shift = frame.pose.position - frame.pose.rotation * frame.pivot;
    ContactRow<Real>& row = rows.all[moving.row];
    const Vec3<Real> turned = normal.template cast<Real>();
    if (log.wanted() && turned != row.normal) log.before_turn(rows.all, moving.row);
    row.normal = turned;
    row.offset = static_cast<Real>(moving.own_offset + normal.dot(shift));
  }
}

WEFT_INSTANTIATE_FUNCTIONS(book_reactions, turn_with_objects)

}  // namespace weft
