#pragma once

#include <string>
#include <vector>

#include "core/cloth/cloth_model.h"
#include "core/world/world_def.h"

// Tells what of its fabric makes a cloth need many substeps.

namespace weft {

/// Why a cloth needs many substeps.
struct SubstepCauses {
  bool damping = false;             ///< without damping it would need less than half as many
  std::vector<std::string> fields;  ///< of its fabric, from the one that bears most
};

/// In vacuum, and without hands. No fields if the solver's substeps do not depend on the fabric.
template <class Real>
SubstepCauses substep_causes(const ClothPart<Real>& part, SolverKind kind, double tick_seconds);

}  // namespace weft
