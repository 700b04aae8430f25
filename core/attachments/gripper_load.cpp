// Sums the load of the cloth on both jaws of a gripper.

#include "core/attachments/gripper_load.h"

#include <cassert>

namespace weft {

/// The squeeze is left out of the torque: its impulses cancel within the cloth, which is given none
/// of them, while the rows that share them need not lie opposite each other.
GripperLoad load_of(const Gripper& gripper, const ColliderStates& colliders, double seconds) {
  assert(seconds > 0);
  GripperLoad load;
  for (const std::size_t k : gripper.jaw) {
    assert(k < colliders.size());
    const ColliderState& jaw = colliders[k];
    const Vec3d lever = jaw.pose.position - gripper.pose.position;
    load.force += jaw.force;
    load.torque -= (jaw.told.angular + lever.cross(jaw.told.impulse)) / seconds;
  }
  return load;
}

}  // namespace weft
