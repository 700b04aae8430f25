// Jaws of grippers: what is in front of them, and the friction that their force allows.

#include <algorithm>
#include <cassert>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/contact_row.h"
#include "core/contact/objects/row_response.h"
#include "core/instantiate.h"

namespace weft {
namespace {

/// Finds the rows that a jaw grips, and sets the grip of each to its weight in the shares.
/// Particles alone carry its force, where there are some, by their mass and so by area: rows of
/// edges and triangles are denser at the rims of jaws, and would turn the cloth between them. A few
/// particles would not hold it against turning; there all rows have equal shares.
/// @param k  number of the jaw's collider
/// @return the sum of these weights
template <class Real>
Real find_gripped(std::size_t k, const Vec3Array<Real>& x, ObjectRows<Real>& rows,
                  ColliderState& jaw) {
  assert(!jaw.press.isZero(0));
  jaw.facing = 0;
  const Real slack = Real(jaw.layered ? kSqueezedLayers : kSqueezed);
  Real mass = 0;
  int particles = 0, gripped = 0;
  for (MovingRow<Real>& moving : rows.moving) {
    if (moving.collider != k) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    moving.layered = false;
    moving.grip = 0;
    moving.rubbed.setZero();
    if (!row.responds || !(row.normal.dot(jaw.press.template cast<Real>()) > Real(kFacing)))
      continue;
    const Real gap = row.normal.dot(weighted(row, x)) - row.offset;
    if (gap < row.thickness * Real(kBeforeJaw))
      jaw.facing = std::max(jaw.facing, static_cast<double>(row.thickness));
    if (!(gap < row.thickness * (1 + slack))) continue;
    assert(moving.mobility > 0 && "a row that responds can be moved");
    moving.layered = jaw.layered;
    moving.grip = 1;
    ++gripped;
    if (row.count > 1) continue;
    ++particles;
    mass += 1 / moving.mobility;
  }
  if (particles < kHoldAlone) return static_cast<Real>(gripped);
  for (MovingRow<Real>& moving : rows.moving) {
    if (moving.collider != k || moving.grip == 0) continue;
    moving.grip = rows.all[moving.row].count == 1 ? 1 / moving.mobility : Real(0);
  }
  return mass;
}

}  // namespace

/// Two jaws that hold cloth press it from both sides; the impulses of that cancel in the cloth and
/// are not solved for, but reported as forces, as far as layers do not resist with them already.
/// What they allow in friction is shared by the rows that touch: of each jaw friction times force
/// in all, and so twice that of both. It acts in each substep alike. What layers push with does
/// not, as they let go of the jaw for some substeps after each push; friction by that would let the
/// cloth fall for as long, and creep.
template <class Real>
void share_hold(ObjectSolve<Real>& solve, Real dt) {
  assert(solve.motion.colliders && dt > 0);
  ObjectRows<Real>& rows = solve.rows;
  for (std::size_t k = 0; k < solve.motion.colliders->size(); ++k) {
    ColliderState& jaw = (*solve.motion.colliders)[k];
    if (jaw.press.isZero(0)) continue;
    assert(jaw.squeeze >= 0 && jaw.squeeze <= jaw.hold);
    const Real weights = find_gripped(k, solve.state.x, rows, jaw);
    const Real share = weights > 0 ? dt / weights : Real(0);
    for (MovingRow<Real>& moving : rows.moving) {
      if (moving.collider != k || moving.grip == 0) continue;
      const ContactRow<Real>& row = rows.all[moving.row];
      const Real part = share * moving.grip;  // [s]
      // Rows at the rim lean, and their normals would not cancel those of the other jaw.
      const Vec3d impulse = jaw.press * (jaw.squeeze * static_cast<double>(part));
      jaw.squeezed += impulse;
      if (solve.log.wanted()) solve.log.add_squeeze(rows.all, moving.row, impulse);
      moving.grip = static_cast<Real>(jaw.hold) * part * moving.mobility *
                    static_cast<Real>(settings_of(solve.cloths, row).friction);
    }
  }
}

WEFT_INSTANTIATE_FUNCTIONS(share_hold)

}  // namespace weft
