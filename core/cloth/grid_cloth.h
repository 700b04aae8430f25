#pragma once

#include <cassert>

#include "core/cloth/cloth_model.h"

// Rectangular cloths as grids.

namespace weft {

/// Builds a rectangular cloth of rows x columns particles as a model with one part; see
/// build_cloth. The definition must be valid. Throws DefinitionError on "fabric.shear" if a spring
/// would have negative stiffness.
template <class Real>
ClothModel<Real> build_grid_cloth(const ClothDef& def);

/// Bending rigidity times weight of a grid's hinge over an edge (du, dv) in the material [N m].
double grid_hinge_rigidity(const FabricDef& fabric, double du, double dv);

/// Sets name, fabric and ranges of the only part of a model whose lists are filled.
template <class Real>
void complete_part(const ClothDef& def, ClothModel<Real>& model) {
  assert(model.parts.size() == 1);
  assert(model.rest_positions.size() == model.mass.size());
  assert(model.material.size() == model.mass.size());
  assert(model.triangle_area.size() == model.triangles.size());
  assert(model.spring_kinds.size() == model.springs.size());
  const auto all = [](const auto& list) { return IndexRange{0, static_cast<Index>(list.size())}; };
  ClothPart<Real>& part = model.parts.front();
  part.name = def.name;
  part.fabric = def.fabric;
  part.particles = all(model.mass);
  part.triangles = all(model.triangles);
  part.edges = all(model.edges);
  part.springs = all(model.springs);
  part.hinges = all(model.hinges);
  part.membrane = all(model.membrane);
}

}  // namespace weft
