// Jaws of grippers: what is in front of them, and the friction that their squeeze allows.

#include <cassert>

#include "core/contact/objects/constants.h"
#include "core/contact/objects/row_response.h"

namespace weft {
namespace {

/// Finds the rows that a jaw squeezes, and sets their grip to 1. @return how many there are
/// @param k  number of the jaw's collider
template <class Real>
Real find_squeezed(std::size_t k, const Vec3Array<Real>& x, ObjectRows<Real>& rows,
                   ColliderState& jaw) {
  assert(!jaw.press.isZero(0));
  jaw.facing = 0;
  Real touching = 0;
  for (MovingRow<Real>& moving : rows.moving) {
    if (moving.collider != k) continue;
    const ContactRow<Real>& row = rows.all[moving.row];
    moving.grip = 0;
    if (!row.responds || !(row.normal.dot(jaw.press.template cast<Real>()) > Real(kFacing)))
      continue;
    Vec3<Real> point = Vec3<Real>::Zero();
    for (std::size_t p = 0; p < static_cast<std::size_t>(row.count); ++p)
      point += x[static_cast<std::size_t>(row.particle[p])] * row.weight[p];
    const Real gap = row.normal.dot(point) - row.offset;
    if (gap < row.thickness * Real(kBeforeJaw))
      jaw.facing = std::max(jaw.facing, static_cast<double>(row.thickness));
    if (!(gap < row.thickness * (1 + Real(kSqueezed)))) continue;
    moving.grip = 1;
    touching += 1;
  }
  return touching;
}

}  // namespace

/// Two jaws that squeeze cloth press it from both sides; the impulses of that cancel in the cloth
/// and are not solved for, but reported as forces. What they allow in friction is shared evenly by
/// the rows that touch: of each jaw friction times squeeze in all, and so twice that of both.
template <class Real>
void share_squeeze(ObjectSolve<Real>& solve, Real dt) {
  assert(solve.motion.colliders && dt > 0);
  ObjectRows<Real>& rows = solve.rows;
  for (std::size_t k = 0; k < solve.motion.colliders->size(); ++k) {
    ColliderState& jaw = (*solve.motion.colliders)[k];
    if (jaw.press.isZero(0)) continue;
    const Real touching = find_squeezed(k, solve.state.x, rows, jaw);
    const Real each = static_cast<Real>(jaw.squeeze) * dt / std::max(touching, Real(1));
    for (MovingRow<Real>& moving : rows.moving) {
      if (moving.collider != k || moving.grip == 0) continue;
      const ContactRow<Real>& row = rows.all[moving.row];
      const Vec3d impulse = (row.normal * each).template cast<double>();
      jaw.squeezed += impulse;
      if (solve.log.wanted()) solve.log.add_impulse(rows.all, moving.row, impulse);
      moving.grip =
          each * moving.mobility * static_cast<Real>(settings_of(solve.cloths, row).friction);
    }
  }
}

template decltype(share_squeeze<float>) share_squeeze<float>;
template decltype(share_squeeze<double>) share_squeeze<double>;

}  // namespace weft
