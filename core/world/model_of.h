#pragma once

#include <cassert>

#include "core/cloth/cloth_model.h"
#include "core/world/world_def.h"

// The cloths of a definition as its solver moves them.

namespace weft {

/// Builds them. `verlet` alone takes off the misfit of cells (forces/cell_misfit.h), unless a grid
/// asks for bare springs by its `membrane_model`: the misfit's second derivatives, which `implicit`
/// would need, are not always positive, and as a force beside the sweeps of XPBD it would be
/// unstable. Throws DefinitionError.
template <class Real>
ClothModel<Real> model_of(const WorldDef& def) {
  ClothModel<Real> model = build_cloths<Real>(cloths_to_build(def));
  assert(model.parts.size() == def.cloths.size());
  const bool verlet = solver_of(def) == SolverKind::verlet;
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const bool bare = def.cloths[p].membrane_model == MembraneModel::springs;
    if (model.parts[p].grid_springs && (bare || !verlet)) model.parts[p].grid_springs->misfit = 0;
  }
  return model;
}

}  // namespace weft
