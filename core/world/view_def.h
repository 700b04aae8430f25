#pragma once

#include "core/definition.h"

// Where a scene is best looked at from. Only viewers use it, not the physics.

namespace weft {

/// The first view of a scene: a sphere that fills the picture, and the side that it is seen from.
struct ViewDef {
  Vec3d target = Vec3d::Zero();        ///< middle of the sphere [m]
  Vec3d direction = Vec3d(0, 0.3, 1);  ///< from the target towards the eye; any length but 0
  double radius = 1;                   ///< of the sphere [m]
};

/// Passes each field to `visit(info, value)`; see definition.h.
template <class Def, class Visitor>
void visit_fields_of_view(Def& d, Visitor&& visit) {
  visit(FieldInfo{"target", -1000, 1000, "m", "point that is looked at"}, d.target);
  visit(FieldInfo{"direction", -1000, 1000, "", "from the target towards the eye"}, d.direction);
  visit(FieldInfo{"radius", 1e-3, 1000, "m", "of the sphere that fills the picture"}, d.radius);
}

}  // namespace weft
