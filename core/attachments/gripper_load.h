#pragma once

#include "core/attachments/gripper.h"

// What cloth does to a gripper.

namespace weft {

/// Of the cloth on both jaws of a gripper, means of a tick.
struct GripperLoad {
  Vec3d force = Vec3d::Zero();   ///< [N]
  Vec3d torque = Vec3d::Zero();  ///< about the gripper's middle [N m]
};

/// The load of the last tick.
/// @param seconds  length of the tick
GripperLoad load_of(const Gripper& gripper, const ColliderStates& colliders, double seconds);

}  // namespace weft
