#pragma once

#include <optional>
#include <string>

#include "core/cloth/fabric.h"
#include "core/definition.h"
#include "core/geometry/triangle_mesh.h"

namespace weft {

/// How the mass of the cloth is shared among its particles.
enum class MassLumping {
  area,   ///< a third of each triangle to its corners, averaged over both diagonals: half on
          ///< border lines, a quarter on corners
  equal,  ///< the same for all (the seed's)
};

/// How the cloth resists bending.
enum class BendingModel {
  automatic,  ///< quadratic where it is exact enough, hinges otherwise; see quadratic_bending_fits
  hinges,     ///< dihedral angles with rest angle and damping (Bridson 2003)
  quadratic,  ///< constant Hessian on the grid; needs zero rest angles and no bending damping
  sine_hinges,  ///< hinges that answer to sin(theta/2), as printed in Bridson 2003 (the seed's)
};

/// What is cut out of the rectangle of a grid.
enum class Outline {
  rectangle,  ///< all of it
  ellipse,    ///< the cells whose middle lies in the ellipse that fills the rectangle
};

/// Spring stiffnesses given one by one, as the seed has them, instead of derived from the fabric.
struct DirectSprings {
  double structural = 0;  ///< neighbours in a row or column [N/m]
  double shear = 0;       ///< cell diagonals [N/m]
  double skip = 0;        ///< every second neighbour, the seed's bending springs [N/m]
  double dashpot = 0;     ///< along every spring [N s/m]
};

/// A cloth of any shape, at rest as it lies: every vertex a particle, every edge a spring.
struct ClothMesh {
  TriangleMesh
      mesh;  ///< in world coordinates [m]; every vertex used, at most two triangles an edge
  std::vector<std::array<double, 2>> uv;  ///< of each vertex, u along the warp, any scale; empty:
                                          ///< by projection along the axis that the mesh faces
  MeshPlacement placement = {};           ///< how `mesh` was made; not applied again
};

/// A cloth: rectangular with rows x columns particles, flat at rest, or a triangle mesh.
///
/// Particle (row r, column c) has index r * columns + c and starts at
/// origin + u * width * c/(columns-1) + v * height * r/(rows-1).
struct ClothDef {
  std::string name = "cloth";
  int rows = 20;                         ///< particles along v
  int columns = 30;                      ///< particles along u
  double width = 1;                      ///< extent along u [m]
  double height = 1;                     ///< extent along v [m]
  Vec3d origin = Vec3d::Zero();          ///< where particle 0 starts [m]
  Vec3d u = Vec3d::UnitX();              ///< direction of a row, warp; normalised when built
  Vec3d v = -Vec3d::UnitY();             ///< direction of a column, weft; must be normal to u
  double rest_angle = 0;                 ///< of every hinge [rad]
  Outline outline = Outline::rectangle;  ///< of a cut grid the particles are counted row by row
  double skip_stiffness = 0;             ///< seed's bending springs beside the hinges [N/m]
  BendingModel bending_model = BendingModel::automatic;
  MassLumping mass_lumping = MassLumping::area;
  std::optional<DirectSprings> direct_springs;
  FabricDef fabric;
  std::optional<ClothMesh> mesh;  ///< instead of the rectangle, whose numbers then do not matter
};

/// Describes each field of a grid to `visit(info, value)`.
template <class Def, class Visitor>
void visit_fields_of_grid(Def& c, Visitor&& visit) {
  visit(FieldInfo{"rows", 2, 2048, "", "particles along v"}, c.rows);
  visit(FieldInfo{"columns", 2, 2048, "", "particles along u"}, c.columns);
  visit(FieldInfo{"width", 1e-3, 100, "m", "extent along u"}, c.width);
  visit(FieldInfo{"height", 1e-3, 100, "m", "extent along v"}, c.height);
  visit(FieldInfo{"origin", -100, 100, "m", "where particle 0 starts"}, c.origin);
  visit(FieldInfo{"u", -1e3, 1e3, "", "direction of a row"}, c.u);
  visit(FieldInfo{"v", -1e3, 1e3, "", "direction of a column"}, c.v);
  visit(choice("outline", "rectangle|ellipse", "what is cut out of the rectangle"), c.outline);
  visit(FieldInfo{"skip_stiffness", 0, 1e6, "N/m", "springs to every second neighbour"},
        c.skip_stiffness);
}

/// The same for what every cloth has, grid or mesh.
template <class Def, class Visitor>
void visit_fields_of_any_cloth(Def& c, Visitor&& visit) {
  visit(choice("bending_model", "automatic|hinges|quadratic|sine_hinges",
               "how the cloth resists bending"),
        c.bending_model);
  visit(choice("mass_lumping", "area|equal", "how the particles share the mass"), c.mass_lumping);
  visit(FieldInfo{"rest_angle", -3, 3, "rad", "rest angle of every hinge"}, c.rest_angle);
}

template <class Def, class Visitor>
void visit_fields_of_cloth(Def& c, Visitor&& visit) {
  visit_fields_of_grid(c, visit);
  visit_fields_of_any_cloth(c, visit);
}

/// Describes each field of the direct springs.
template <class Def, class Visitor>
void visit_fields_of_direct_springs(Def& d, Visitor&& visit) {
  visit(FieldInfo{"structural", 0, 1e6, "N/m", "neighbours in a row or column"}, d.structural);
  visit(FieldInfo{"shear", 0, 1e6, "N/m", "cell diagonals"}, d.shear);
  visit(FieldInfo{"skip", 0, 1e6, "N/m", "every second neighbour"}, d.skip);
  visit(FieldInfo{"dashpot", 0, 1e3, "N s/m", "along every spring"}, d.dashpot);
}

/// Whether the quadratic form may stand for the hinges: a cloth that is flat at rest, which a mesh
/// has yet to show, and without bending damping.
inline bool quadratic_bending_fits(const ClothDef& def) {
  return def.rest_angle == 0 && def.fabric.bending_damping == 0;
}

/// Checks every range and the combination (u and v independent, direct springs finite).
/// Throws DefinitionError.
void validate(const ClothDef& def);

/// How a field of one of several cloths is written: "cloth.rows" and "fabric.shear" for the first,
/// "cloths[1].rows" and "cloths[1].fabric.shear" for the second.
/// @param field  as written for the first
std::string cloth_field(std::size_t cloth, const std::string& field);

}  // namespace weft
