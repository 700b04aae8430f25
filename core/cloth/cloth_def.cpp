// Validates the definition of a cloth.

#include "core/cloth/cloth_def.h"

#include <cmath>

#include "core/cloth/constants.h"
#include "core/cloth/membrane.h"
#include "core/error.h"
#include "core/geometry/constants.h"

namespace weft {

std::string cloth_field(std::size_t cloth, const std::string& field) {
  if (cloth == 0) return field;
  const std::string place = "cloths[" + std::to_string(cloth) + "].";
  if (field.starts_with("cloth.")) return place + field.substr(6);
  return field == "fabric" || field.starts_with("fabric.") ? place + field : field;
}

void validate(const ClothDef& def) {
  visit_fields_of_cloth(
      def, [](const FieldInfo& info, const auto& value) { check_field("cloth.", info, value); });
  visit_fields_of_fabric(def.fabric, [](const FieldInfo& info, const auto& value) {
    check_field("fabric.", info, value);
  });
  if (def.u.norm() < kShortestDirection)
    throw DefinitionError("cloth.u", "0,0,0", "a direction", "give a vector that is not zero");
  if (def.v.norm() < kShortestDirection ||
      std::abs(def.u.normalized().dot(def.v.normalized())) > kMostAxisCosine)
    throw DefinitionError(
        "cloth.v",
        number_text(def.v[0]) + "," + number_text(def.v[1]) + "," + number_text(def.v[2]),
        "a direction at right angles to cloth.u", "the cells are rectangles");
  if (def.bending_model == BendingModel::quadratic && !quadratic_bending_fits(def))
    throw DefinitionError("cloth.bending_model", "quadratic", "hinges or automatic",
                          "a rest angle needs hinges");
  const bool cut = !def.mesh && def.outline != Outline::rectangle;
  if (cut && (def.skip_stiffness != 0 || def.direct_springs))
    throw DefinitionError("cloth.outline", "ellipse", "rectangle with these springs",
                          "a cut grid has only the springs of its fabric");
  if (def.mesh && def.skip_stiffness != 0)
    throw DefinitionError("cloth.skip_stiffness", number_text(def.skip_stiffness), "0 on a mesh",
                          "only a grid has second neighbours");
  if (!def.mesh && def.membrane_model == MembraneModel::triangles)
    throw DefinitionError("cloth.membrane_model", "triangles", "automatic or springs on a grid",
                          "the springs of a grid have the fabric's tensor");
  if (!has_membrane_triangles(def) && def.fabric.poisson != kPoissonOfGrid)
    throw DefinitionError("fabric.poisson", number_text(def.fabric.poisson),
                          "none, which is -1, without triangles",
                          "only triangles of a mesh have a Poisson's ratio of their own; springs "
                          "couple the threads as they resist shear")
        .with(Range{kPoissonOfGrid, kPoissonOfGrid});
  if (def.rest_shape == RestShape::uv && (!def.mesh || def.mesh->uv.empty()))
    throw DefinitionError("cloth.rest_shape", "uv", "placed without uv of a mesh",
                          "give the mesh uv in metres");
  if (has_membrane_triangles(def)) refuse_indefinite_membrane(def.fabric);
  if (def.mesh && def.direct_springs)
    throw DefinitionError("cloth.direct_springs", "given", "none on a mesh",
                          "only a grid has rows and columns");
  const bool threads = !def.direct_springs && (!def.mesh || has_membrane_triangles(def));
  if (def.fabric.locking_strain > 0 && !threads)
    throw DefinitionError("fabric.locking_strain", number_text(def.fabric.locking_strain),
                          "0 with springs that are not the fabric's threads",
                          "take membrane_model triangles, or no direct_springs")
        .with(Range{0, 0});
  if (!def.direct_springs) return;
  visit_fields_of_direct_springs(*def.direct_springs, [](const FieldInfo& info, double value) {
    check_field("cloth.direct_springs.", info, value);
  });
}

}  // namespace weft
