#pragma once

#include <string>

#include "core/definition.h"

// How a cloth is meant to look. Only viewers use it, not the physics.

namespace weft {

/// The woven or grown surface that a viewer draws.
enum class LookOf {
  automatic,  ///< that of the preset that the fabric began as, else plain
  plain,
  cotton,
  silk,
  denim,
  wool,
  leather,
  nylon,
};

/// The look of one cloth. Its front is the side from which its triangles are clockwise, as
/// those of a grid are from where u runs to the right and v down.
struct LookDef {
  LookOf fabric = LookOf::automatic;
  std::string color;  ///< of the front, "#rrggbb"; empty: the viewer's
  std::string back;   ///< of the other side, "#rrggbb"; empty: follows from `color`
};

/// Passes each field that is no text to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_look(Def& d, Visitor&& visit) {
  visit(choice("fabric", "automatic|plain|cotton|silk|denim|wool|leather|nylon",
               "surface that is drawn; automatic: that of the fabric's preset"),
        d.fabric);
}

}  // namespace weft
