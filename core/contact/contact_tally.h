#pragma once

#include <array>
#include <vector>

#include "core/types.h"

// Contacts, and what they get in a tick.

namespace weft {

/// A contact as it is told to others: one of the cloth with an object, or of cloths with each
/// other.
struct ContactPoint {
  Index collider = kNone;  ///< the object; kNone: the other side is cloth too
  int count = 0;           ///< particles in it: 1 to 3 with an object, 4 of cloths
  int first_side = 0;      ///< how many belong to the side that the normal points to
  std::array<Index, 4> particle = {0, 0, 0, 0};
  std::array<double, 4> weight = {0, 0, 0, 0};  ///< negative on the other side of cloths
  Vec3d point = Vec3d::Zero();                  ///< of the first side's mid-surface [m]
  Vec3d normal = Vec3d::Zero();                 ///< unit, towards the first side
  double gap = 0;                               ///< between the mid-surface and the other side [m]
  double normal_force = 0;                      ///< on the first side along the normal [N]
  Vec3d friction = Vec3d::Zero();               ///< on the first side, across the normal [N]

  Vec3d force() const { return normal * normal_force + friction; }
};

/// A contact with all that it got in a tick. Several rows may push the same particles: the geometry
/// is that of the last, friction what goes across the common direction.
struct TalliedContact {
  ContactPoint contact;
  double offset = 0;              ///< of the object's plane [m]
  Vec3d impulse = Vec3d::Zero();  ///< on the first side [N s]
  Vec3d along = Vec3d::Zero();    ///< its parts along the normals, and squeezes, of objects [N s]
  Index next = kNone;             ///< another with the same first particle
};

/// Impulses of a tick by contacts, in the order in which these got their first.
class ContactTally {
 public:
  void clear();
  bool has(const ContactPoint& contact) const { return find(contact) != kNone; }
  /// The same contact, new or old, with this geometry from now on.
  /// @param offset  of the object's plane [m]
  TalliedContact& of(const ContactPoint& contact, double offset = 0);
  const std::vector<TalliedContact>& list() const { return list_; }

 private:
  Index find(const ContactPoint& contact) const;

  std::vector<TalliedContact> list_;
  std::vector<Index> last_;  ///< of each particle the last contact whose first one it is
};

/// Determines where a contact is now, and its gap.
/// @param offset  of the object's plane [m]
/// @param x       positions of all particles [m]
template <class Real>
void place_contact(double offset, const Vec3Array<Real>& x, ContactPoint& contact);

}  // namespace weft
