#pragma once

#include <cstdint>
#include <optional>

#include "core/cloth/cloth_model.h"
#include "core/cloth/cloth_state.h"
#include "core/executor.h"
#include "core/solver/constants.h"

// Checks the motion of all particles before contact reads them, so that no tree, grid or index
// computation meets a number that is absurd or not finite.

namespace weft {

/// Implausible motion of a particle: the substep that produced it is unstable.
struct BlowUp {
  enum class Kind : std::uint8_t {
    not_finite,  ///< a position or velocity is NaN or infinite
    too_fast,    ///< the coming drift is longer than the cloth's rest diagonal
    too_far,     ///< more than kFarthestFromOrigin from the origin
  };
  Kind kind = Kind::not_finite;
  Index particle = kNone;
  double value = 0;  ///< its speed [m/s], or its distance from the origin [m]
};

/// Checks all cloths that are awake.
/// @param dt        the coming drift, or the last one [s]; positive
/// @param executor  looks at many particles on its threads; may be null
/// @returns         the first particle with implausible motion, if there is one
template <class Real>
std::optional<BlowUp> find_blow_up(const ClothModel<Real>& model, const ClothState<Real>& state,
                                   Real dt, Executor* executor = nullptr);

/// Shortens the displacements of each cloth alike, so that none of its particles exceeds
/// kPlausibleSpeed. Springs give a free cloth no momentum, nor does a common factor.
/// @param dt  in which they are gone [s]
template <class Real>
void hold_back(const ClothModel<Real>& model, Real dt, Vec3Array<Real>& displacements);

}  // namespace weft
