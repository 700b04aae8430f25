#pragma once

#include <optional>
#include <vector>

#include "core/cloth/cloth_state.h"
#include "core/types.h"

// A start other than flat: where the particles are and how they move when a world begins.

namespace weft {

/// State of all particles of all cloths, in their order, at the start and after each reset. The
/// cloths keep the rest shape of their definition, so that they may start strained.
struct StartDef {
  std::vector<Vec3d> x;  ///< positions, at most kFarthestFromOrigin from the origin [m]
  std::vector<Vec3d> v;  ///< velocities, at most kFastestStart [m/s]; empty: at rest
};

/// Particles may start at most this fast [m/s]. Larger: a start may look like a blow-up to the
/// check after its first substep. Smaller: thrown cloth is refused.
inline constexpr double kFastestStart = 100;

/// Throws DefinitionError on fields "start.x" and "start.v" unless there is one position, and no
/// velocity or one, for each of `particles`, all finite and in range.
void validate(const StartDef& start, std::size_t particles);

/// A state at a start; at the rest positions if none is given.
/// @param start  validated
template <class Real>
ClothState<Real> state_at(const std::optional<StartDef>& start, const ClothModel<Real>& model) {
  ClothState<Real> state = initial_state(model);
  if (!start) return state;
  assert(start->x.size() == state.x.size());
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    state.x[i] = start->x[i].template cast<Real>();
    if (!start->v.empty()) state.v[i] = start->v[i].template cast<Real>();
  }
  return state;
}

}  // namespace weft
