// Jaws of grippers, in Contact: what is before them, and the friction that their squeeze allows.

#include "core/contact/objects/contact.h"

namespace weft {
namespace {

/// Cosine between a row's normal and the direction of pressing from which on it is before the jaw.
constexpr double kFacing = 0.9;

/// What is nearer than the thickness and this part of it is squeezed.
constexpr double kSqueezed = 0.02;

/// What is nearer to a jaw than this many thicknesses is before it.
constexpr double kBefore = 1.6;

}  // namespace

template <class Real>
bool Contact<Real>::faces(const ContactRow<Real>& row, const ColliderState& jaw) const {
  return row.responds && row.normal.dot(jaw.press.template cast<Real>()) > Real(kFacing);
}

/// Two jaws that squeeze cloth press it from both sides; the impulses of that cancel in the cloth
/// and are not solved for, but told to those who ask for forces. What they allow in friction is
/// shared evenly by the rows that touch: of each jaw friction times squeeze in all, and so twice
/// that of both.
template <class Real>
void Contact<Real>::share_squeeze(const ClothState<Real>& state, Real dt) {
  for (std::size_t k = 0; k < colliders_->size(); ++k) {
    ColliderState& jaw = (*colliders_)[k];
    if (jaw.press.isZero(0)) continue;
    jaw.facing = 0;
    Real touching = 0;
    for (MovingRow<Real>& moving : moving_rows_) {
      if (moving.collider != k) continue;
      const ContactRow<Real>& row = rows_[moving.row];
      moving.grip = 0;
      if (!faces(row, jaw)) continue;
      Vec3<Real> point = Vec3<Real>::Zero();
      for (std::size_t p = 0; p < static_cast<std::size_t>(row.count); ++p)
        point += state.x[static_cast<std::size_t>(row.particle[p])] * row.weight[p];
      const Real gap = row.normal.dot(point) - row.offset;
      if (gap < row.thickness * Real(kBefore))
        jaw.facing = std::max(jaw.facing, static_cast<double>(row.thickness));
      if (!(gap < row.thickness * (1 + Real(kSqueezed)))) continue;
      moving.grip = 1;
      touching += 1;
    }
    const Real each = static_cast<Real>(jaw.squeeze) * dt / std::max(touching, Real(1));
    for (MovingRow<Real>& moving : moving_rows_) {
      if (moving.collider != k || moving.grip == 0) continue;
      const Vec3d impulse = (rows_[moving.row].normal * each).template cast<double>();
      jaw.squeezed += impulse;
      if (log_.wanted()) log_.add_impulse(rows_, moving.row, impulse);
      const auto cloth = static_cast<std::size_t>(rows_[moving.row].cloth);
      moving.grip = each * moving.mobility * static_cast<Real>(cloths_[cloth].friction);
    }
  }
}

#define WEFT_INSTANTIATE(Real)                                               \
  template void Contact<Real>::share_squeeze(const ClothState<Real>&, Real); \
  template bool Contact<Real>::faces(const ContactRow<Real>&, const ColliderState&) const;
WEFT_INSTANTIATE(float)
WEFT_INSTANTIATE(double)
#undef WEFT_INSTANTIATE

}  // namespace weft
