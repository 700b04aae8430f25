#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/attachments/clamp_line.h"

namespace weft {

// Places of a cloth that do not depend on its resolution. They are given in the fabric: `left` is
// the least u, `right` the largest, `top` the least v (row 0 of a grid), `bottom` the largest,
// wherever these lie in space. On a mesh whose uv run upwards in v, `top` is the lower edge, and so
// it is of a GLB, whose v is turned over on reading; a mesh without uv gets v downwards.

enum class Corner : std::uint8_t { top_left, top_right, bottom_left, bottom_right };

/// All particles within `width` of one side of the fabric; of a grid the lines of held_lines().
struct EdgeStrip {
  Side side = Side::top;
  double width = 0;  ///< [m], 0 to 100; 0: only the outermost line
};

/// The particle nearest to a point of the fabric; the first of several at equal distance.
struct MaterialPoint {
  double u = 0, v = 0;  ///< each 0 to 1 of the fabric's extent
};

/// A particle by its index, or a place.
using PinPlace = std::variant<Index, Corner, EdgeStrip, MaterialPoint>;

/// Fixes a piece of the fabric where it is. The strain at a single particle, a point singularity,
/// grows with resolution; that at a disc of fixed physical radius does not.
struct PinDef {
  PinPlace place = Index(0);
  double radius = 0;       ///< of the disc in the fabric [m], 0 to 100; 0: one particle; unused by
                           ///< a strip
  std::string cloth = {};  ///< name; empty: the first cloth, or, for a particle, all cloths
};

/// The particles of a pin.
struct PinnedParticles {
  Index centre = 0;
  std::vector<Index> particles;    ///< ascending; at least the centre
  std::optional<ClampLine> clamp;  ///< of a strip with a width that clamps
  std::optional<ClampDisc> disc;   ///< that clamps
};

/// Finds the particles of a pin. Throws DefinitionError on "pin.cloth", "pin.particle",
/// "pin.radius", "pin.width", "pin.u" or "pin.v".
template <class Real>
PinnedParticles find_pinned(const ClothModel<Real>& model, const PinDef& def);

/// Passes each field of a place or pin to `visit(info, value)`.
template <class Value, class Visitor>
void visit_field_of_particle(Value& particle, Visitor&& visit) {
  visit(
      FieldInfo{"particle", 0, 1e7, "",
                "index in its cloth, row by row in a grid; a mesh is renumbered, so not as in its "
                "file: find it by its place in the first state"},
      particle);
}
template <class Value, class Visitor>
void visit_field_of_corner(Value& corner, Visitor&& visit) {
  visit(choice("corner", "top_left|top_right|bottom_left|bottom_right",
               "corner of the fabric: top is the least v, as of a side"),
        corner);
}
template <class Def, class Visitor>
void visit_fields_of_strip(Def& strip, Visitor&& visit) {
  visit(choice("side", "top|bottom|left|right",
               "side of the fabric: top is the least v, left the least u; on a mesh whose v runs "
               "upwards, as in most OBJ, top is the lower edge, and so it is of a GLB, whose v is "
               "turned over on reading; without uv it is the upper one"),
        strip.side);
  visit(FieldInfo{"width", 0, 100, "m",
                  "width of the pinned strip; on a grid it clamps at its border, and with 0 it "
                  "holds a line that turns"},
        strip.width);
}
template <class Def, class Visitor>
void visit_fields_of_point(Def& point, Visitor&& visit) {
  visit(FieldInfo{"u", 0, 1, "", "place along u, as a fraction of the fabric's extent"}, point.u);
  visit(FieldInfo{"v", 0, 1, "", "place along v, as a fraction of the fabric's extent"}, point.v);
}
template <class Def, class Visitor>
void visit_fields_of_pin(Def& pin, Visitor&& visit) {
  visit(FieldInfo{"radius", 0, 100, "m", "radius of the pinned disc"}, pin.radius);
}

}  // namespace weft
